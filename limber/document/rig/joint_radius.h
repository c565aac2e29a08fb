// How thick the model is at a joint, in the extras of its node ("limber_radius").
#pragma once

#include <optional>

#include "limber/document/gltf/gltf.h"

namespace limber {

// Metres, at least 0; none where the node does not say it.
std::optional<double> storedRadius(const gltf::Node& node);

// Throws Error kBadData beyond what single precision can hold.
void storeRadius(gltf::Node& node, double radius);

}  // namespace limber
