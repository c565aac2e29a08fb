#include "limber/document/gltf/json_keys.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_text.h"

namespace limber {

void allowKeys(const JsonView& object, std::initializer_list<std::string_view> keys) {
  object.forEachMember([&](std::string_view key, const JsonView&) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) return;
    object.fail(fmt::format("has a key that is not known: '{}'; there are: {}", key, fmt::join(keys, ", ")));
  });
}

std::string requiredText(const JsonView& value) {
  if (!value.exists() || !value.json().is_string() || value.json().get_ref<const std::string&>().empty()) {
    value.fail("is not a text");
  }
  return value.json().get<std::string>();
}

Json parseStrictly(std::string_view text) {
  Warnings warnings;
  Json json = parseJson(text, warnings);
  if (warnings.empty()) return json;
  const Warning& first = warnings.items().front();
  throw Error(ErrorCode::kBadData, first.message, first.where);
}

}  // namespace limber
