// Merges several documents into one, each with a transform of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

struct AssetPart {
  // A node of another part, by its number there.
  struct Carrier {
    std::size_t part = 0;
    Index node = 0;
  };

  Asset asset;                     // must have passed checkAsset
  std::string name;                // of the node that is made for it
  Affine transform;                // of that node, in the space of the scene or of what carries it
  std::optional<Carrier> carrier;  // none: the scene
};

// A document with one scene that shows the default scene of each part below a node of its own; other scenes are
// removed. Skinned meshes without children stay at the scene's root, as glTF recommends: their joints position them.
// Names of nodes and of animations are made unique (walk, walk_2). Lists and buffers are concatenated, so that all
// numbers of the first part stay as they are. What an extension says of a whole document, except lights and variants,
// is left out with warning "scene-extensions": how to merge two of them is unknown.
//
// Carriers must not go in a circle. Cost: linear in the documents' size.
Asset mergeAssets(std::vector<AssetPart> parts);

}  // namespace limber
