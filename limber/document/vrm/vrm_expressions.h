// A VRM's expressions: what a face shows, by the weights of blend shapes.
#pragma once

#include <span>
#include <string_view>

#include "limber/document/asset.h"

namespace limber {

// The 18 that VRM 1.0 knows: "happy", "aa", "blink", ...
std::span<const std::string_view> vrmExpressionNames();

// "expressions" of VRMC_vrm for a model that has none: blend shapes that are called as VRM's expressions, letter by
// letter, of all meshes that nodes of the scene show. Null where there are none.
Json expressionsByName(const gltf::Document& document);

}  // namespace limber
