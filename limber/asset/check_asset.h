// The parts of checkAsset.
#pragma once

#include "limber/asset/asset.h"
#include "limber/asset/json_access.h"

namespace limber {

// The document's arrays of elements, absent ones empty.
struct Sections {
  explicit Sections(const Asset& asset);

  JsonView accessors, animations, bufferViews, buffers, cameras, images, materials, meshes, nodes, samplers, scenes,
      skins, textures;
};

// Every buffer view, every accessor, and the accessors that meshes and skins use: types, counts, values.
void checkData(const Asset& asset, const Sections& sections);

}  // namespace limber
