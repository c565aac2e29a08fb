// Where the skins of a document were bound: the pose in which vertices, joints and what hangs on joints agree.
#pragma once

#include <vector>

#include "limber/asset/asset.h"
#include "limber/asset/scene_graph.h"

namespace limber {

struct SkinBinding {
  std::vector<Index> joints;         // #J nodes
  std::vector<Affine> inverseBinds;  // #J, mesh space -> joint space; identity where the file gives none
  bool given = false;                // does the file give them?
};
SkinBinding readSkinBinding(const Asset& asset, Index skin);

// Inverse bind matrices fix the joints only within each skin's own mesh space. Here all of those spaces are mapped to
// one world: skins that share joints, or whose joints hang on each other, are placed so that these coincide; the first
// of such a group is placed where the file's nodes have it. Where the nodes hold another pose than the bind pose, the
// joints that the pose moved together decide, unless the mesh's own node tells (exporters leave the object's placement
// there although glTF ignores it).
struct BindPose {
  std::vector<Index> skins;         // that the scene uses, in the order met; all of the document's where it uses none
  std::vector<Affine> skinToWorld;  // #skins of the document, identity where not in `skins`
  std::vector<bool> isJoint;        // #nodes, joint of one of `skins`
  std::vector<Affine> nodeWorld;    // #nodes: joints by their inverse binds, others riding on the joint above, or as
                                    // stored where there is none
};
BindPose readBindPose(const Asset& asset, const SceneGraph& graph);

}  // namespace limber
