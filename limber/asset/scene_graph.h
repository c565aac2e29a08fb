// The nodes of a document: their tree, their transforms, and which of them the default scene shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/core/types.h"

namespace limber {

struct SceneGraph {
  std::vector<std::optional<Index>> parent;  // #nodes
  std::vector<Affine> local, world;          // #nodes, as the file stores them
  std::vector<Index> allNodes;               // every node, depth first, parents before children
  std::vector<Index> order;                  // those of the default scene, likewise
  std::vector<bool> shown;                   // #nodes: is it in `order`?

  Index nodeCount() const { return static_cast<Index>(parent.size()); }
};

// The default scene is json["scene"], else the first one; all root nodes where the document has no scene. The asset
// must have passed checkAsset (a tree, indices in range).
SceneGraph readSceneGraph(const Asset& asset);

// The transform of a node as its JSON has it: "matrix", or translation, rotation and scale.
Affine nodeTransform(const Json& node);

// The nodes below the roots of one scene, depth first.
std::vector<Index> sceneNodes(const Asset& asset, Index scene);

// Elements of the document, each empty where the document has none: "nodes", "meshes", "skins", "scenes", ...
const Json& elements(const Asset& asset, const char* kind);
Index elementCount(const Asset& asset, const char* kind);

std::optional<Index> indexMember(const Json& object, const char* key);
const Json* member(const Json& object, const char* key);
// "name", empty where there is none.
std::string nameOf(const Json& object);

}  // namespace limber
