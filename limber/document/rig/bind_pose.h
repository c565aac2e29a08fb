// Where the skins of a document were bound: the pose in which vertices, joints and what hangs on joints agree.
#pragma once

#include <vector>

#include "limber/document/asset.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

struct SkinBinding {
  std::vector<Index> joints;         // #J nodes
  std::vector<Affine> inverseBinds;  // #J, mesh space -> joint space; identity where the file gives none, as glTF says
  bool given = false;                // does the file give them? If not, joints are bound where their nodes are
};
SkinBinding readSkinBinding(const Asset& asset, Index skin);

// Inverse bind matrices fix the joints only within each skin's own mesh space. Here all of those spaces are mapped to
// one world: skins that share joints, or whose joints are descendants of each other, are positioned so that these
// coincide; the first of such a group is positioned by the file's nodes. Where the nodes are in another pose than the
// bind pose, the joints that the pose moved together decide, unless the mesh's own node gives the transform (exporters
// leave the object's transform there although glTF ignores it).
struct BindPose {
  std::vector<Index> skins;         // that the scene uses, in the order met; all of the document's where it uses none
  std::vector<Affine> skinToWorld;  // #skins of the document, identity where not in `skins`
  std::vector<bool> isJoint;        // #nodes, joint of one of `skins`
  std::vector<Affine> nodeWorld;    // #nodes: joints by their inverse binds, others riding on the joint above, or as
                                    // stored where there is none
};
BindPose readBindPose(const Asset& asset, const SceneGraph& graph);

// Whether two placements differ by no more than that fraction of their size and distance from the origin.
bool samePlacement(const Affine& a, const Affine& b, double tolerance);

// The skins in use that were bound in another pose than that one: joints with weights are elsewhere by their inverse
// binds than where nodeWorld has them, since another skin that has them was bound otherwise, or since the skin has no
// inverse binds, which glTF reads as the identity. Their surface in the bind pose is what skinning makes of it there.
std::vector<Index> skinsBoundElsewhere(const Asset& asset, const BindPose& pose);

}  // namespace limber
