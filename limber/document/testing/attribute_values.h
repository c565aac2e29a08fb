// What the first primitive of a document has of an attribute.
#pragma once

#include <vector>

#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"

namespace limber {

inline std::vector<float> attributeOf(const Asset& asset, const char* name) {
  return readFloats(asset, asset.document.meshes.at(0).primitives.at(0).attributes.find(name).value());
}

}  // namespace limber
