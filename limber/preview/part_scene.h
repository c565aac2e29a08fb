// A scene in the colours of its parts.
#pragma once

#include <span>

#include "limber/preview/scene.h"

namespace limber {

// The same surface with jointColor(part) as the colour of each triangle: a vertex of several parts is duplicated for
// each of them, so that colours do not run into each other. Materials and weights are left out; joints and bones stay.
// Throws Error kBadArgument where partOf is not one for each triangle.
Scene coloredByParts(const Scene& scene, std::span<const Index> partOf);

}  // namespace limber
