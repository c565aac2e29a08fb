// How meshes of a scene become skinned ones without touching what else their nodes hold.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limber/document/scene/geometry.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

// Ends the name of a node that took the mesh over from the node named before it; removeRig gives it back by that.
inline constexpr const char* kSkinnedSuffix = "_skinned";

// What one node shows of one mesh: the primitives [firstInstance, endInstance) of Geometry::instances.
struct MeshGroup {
  Index node = 0, mesh = 0, copy = 0;
  Index firstInstance = 0, endInstance = 0;
  Affine toWorld = Affine::Identity();
};

struct SkinJoints {
  std::string name;
  std::vector<Index> nodes;       // #J
  std::vector<Affine> toJoint;    // #J, world -> joint in bind pose
  std::optional<Index> skeleton;  // their common root
};

// Edits one document. glTF ignores the transform of a skinned mesh's node and validators warn of one, and of a parent;
// so a mesh whose node has either is handed to a new node at the root of the scene, and its transform is folded into
// the inverse bind matrices of its skin.
class SkinnedNodes {
 public:
  // `carries`: #nodes, nodes whose movement the skin follows (joints); may be empty. Animations of others, at or above
  // a mesh that is not skinned yet, no longer reach it, and finish() says so.
  SkinnedNodes(Asset& asset, const Geometry& geometry, std::vector<bool> carries = {});

  const std::vector<MeshGroup>& groups() const { return groups_; }

  // The mesh that a group may write its weights to: its own, or a copy where another node shows that one too. Ask once
  // for each group.
  Index meshFor(const MeshGroup& group);

  // A skin for meshes that `toWorld` brings to the world. Equal calls give one skin.
  Index addSkin(const SkinJoints& joints, const Affine& toWorld);

  // Lets the group's node, or a new one, show `mesh` with `skin`.
  void attach(const MeshGroup& group, Index mesh, Index skin);

  // The same without a skin, for a mesh whose vertices are in world space; the node keeps no morph weights.
  void attachStatic(const MeshGroup& group, Index mesh);

  // Makes a root node part of every scene that shows one of the meshes.
  void showInScenes(Index root);

  // Adds the warnings to the asset's; takes extensions that no node uses any more off the document's lists.
  void finish();

 private:
  bool isAtOrigin(const MeshGroup& group) const;
  bool loosesAnimation(Index node) const;
  Index moveToRoot(const MeshGroup& group, const char* suffix);
  void takeMeshOff(const MeshGroup& group);

  Asset& asset_;
  SceneGraph graph_;
  std::vector<bool> carries_, animated_;  // #nodes
  std::vector<MeshGroup> groups_;
  std::vector<std::vector<Index>> scenesOf_;  // #nodes
  std::vector<bool> ownMeshFree_;             // #meshes: may still be written to in place
  std::map<std::pair<std::vector<Index>, std::array<double, 12>>, Index> skins_;
  UniqueNames names_;
  std::size_t lostAnimations_ = 0, expandedInstances_ = 0;
};

}  // namespace limber
