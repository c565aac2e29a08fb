// Pieces of what a front end is told.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

inline Json vectorJson(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

inline Json textOrNull(std::string_view text) {
  return text.empty() ? Json(nullptr) : Json(std::string(text));
}

}  // namespace limber
