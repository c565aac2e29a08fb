// The names of a mesh's blend shapes, which glTF leaves to the extras ("targetNames").
#pragma once

#include <string>

#include "limber/document/gltf/gltf.h"

namespace limber {

// "shape_3" where the extras say none.
std::string shapeName(const gltf::Mesh& mesh, std::size_t shape);

}  // namespace limber
