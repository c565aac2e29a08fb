// Which objects an FBX file of a document has, one below the other.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "limber/core/transform.h"
#include "limber/document/asset.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

enum class FbxModelKind { kNull, kLimb, kMesh };

struct FbxModelPlan {
  FbxModelKind kind = FbxModelKind::kNull;
  std::string name;                           // unique
  std::optional<std::size_t> parent;          // of the models; none: at the top of the scene
  std::optional<Index> node;                  // of the document, whose transform and movements it has
  Transform local;                            // as the document has it
  Affine bindWorld = Affine::Identity();      // in bind pose
  std::optional<Index> meshNode, mesh, skin;  // kMesh: the node that shows it, what it shows, what moves it
};

struct FbxScenePlan {
  SceneGraph graph;
  BindPose bindPose;
  std::vector<FbxModelPlan> models;  // parents first, in the order of the document's tree
  std::vector<std::optional<std::size_t>> modelOfNode;
  Warnings warnings;
};

// The nodes of the default scene, by their names and hierarchy. Joints (of skins, and the nodes between them; in a
// document without meshes, whatever moves) are limbs. A node that shows a mesh becomes that mesh, but a joint, a node
// of GPU instances or a skinned node with children passes it to models below it. glTF ignores the transform of a
// skinned mesh's node: the model is where the mesh was bound, at the top of the scene where what is above the node
// moves.
FbxScenePlan readFbxScene(const Asset& asset);

}  // namespace limber
