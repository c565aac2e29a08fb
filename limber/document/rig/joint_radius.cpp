#include "limber/document/rig/joint_radius.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

constexpr const char* kRadiusKey = "limber_radius";

}  // namespace

std::optional<double> storedRadius(const gltf::Node& node) {
  const Json* radius = node.extras.exists() ? member(*node.extras, kRadiusKey) : nullptr;
  if (!radius || !radius->is_number()) return std::nullopt;
  const double value = radius->get<double>();
  return std::isfinite(value) && value >= 0 ? std::optional(value) : std::nullopt;
}

void storeRadius(gltf::Node& node, double radius) {
  node.extras.change()[kRadiusKey] = shortDouble(radius);
}

}  // namespace limber
