// Members of JSON that a file may have in any shape: what is of another type counts as not there.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"

namespace limber {

inline double numberIn(const Json& object, const char* key, double byDefault) {
  const Json* value = member(object, key);
  const double number = value != nullptr && value->is_number() ? value->get<double>() : byDefault;
  return std::isfinite(number) ? number : byDefault;
}

inline std::string textIn(const Json& object, const char* key) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

inline bool flagIn(const Json& object, const char* key) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

// A whole number below `limit`; none for -1, by which VRM 0.x says that nothing is meant.
inline std::optional<Index> indexOf(const Json& value, std::size_t limit) {
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number < static_cast<double>(limit))) return std::nullopt;
  return static_cast<Index>(number);
}
inline std::optional<Index> indexIn(const Json& object, const char* key, std::size_t limit) {
  const Json* value = member(object, key);
  return value != nullptr ? indexOf(*value, limit) : std::nullopt;
}

// The list of that name, an empty one where there is none.
inline const Json& listIn(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const Json* value = member(object, key);
  return value != nullptr && value->is_array() ? *value : kNone;
}

// Numbers of a list, at most `count`; those that are missing are `byDefault`'s.
inline std::vector<double> numbersIn(const Json& object, const char* key, std::vector<double> byDefault) {
  const Json& list = listIn(object, key);
  for (std::size_t i = 0; i < byDefault.size() && i < list.size(); ++i) {
    if (list[i].is_number() && std::isfinite(list[i].get<double>())) byDefault[i] = list[i].get<double>();
  }
  return byDefault;
}

}  // namespace limber
