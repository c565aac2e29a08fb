// Where the vertices of a primitive lie in a picture.
#pragma once

#include <vector>

#include "limber/document/scene/geometry.h"

namespace limber {

// TEXCOORD_0 of an instance's vertices as stored: glTF's, v down from the picture's top. Empty where it has none.
std::vector<Vec2f> readUvs(const Asset& asset, const PrimitiveInstance& instance);

}  // namespace limber
