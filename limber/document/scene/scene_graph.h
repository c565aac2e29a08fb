// The nodes of a document: their tree, their transforms, and which of them the default scene shows.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/gltf/gltf.h"

namespace limber {

struct SceneGraph {
  std::vector<std::optional<Index>> parent;  // #nodes
  std::vector<Affine> local, world;          // #nodes, as the file stores them
  std::vector<Index> allNodes;               // every node, depth first, parents before children
  std::vector<Index> order;                  // those of the default scene, likewise
  std::vector<bool> shown;                   // #nodes: is it in `order`?

  Index nodeCount() const { return static_cast<Index>(parent.size()); }
};

// The default scene is document.scene, else the first one; all root nodes where the document has no scene. The document
// must have passed checkAsset (a tree, indices in range).
SceneGraph readSceneGraph(const gltf::Document& document);

// The nodes without a parent, in index order.
std::vector<Index> rootsOf(const SceneGraph& graph);

// A skinned mesh, which its joints move and no transform of a node: glTF ignores its own and those above it.
bool isPlacedByJoints(const gltf::Node& node);

// The transform of a node: its matrix, or its translation, rotation and scale.
Affine nodeTransform(const gltf::Node& node);

// #nodes: does a channel of an animation move the node? Weights of blend shapes move none.
std::vector<bool> animatedNodes(const gltf::Document& document);

// The nodes below the roots of one scene, depth first.
std::vector<Index> sceneNodes(const gltf::Document& document, Index scene);

}  // namespace limber
