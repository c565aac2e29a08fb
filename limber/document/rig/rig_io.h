// The rig inside an Asset: look at it, take it out, put one in.
#pragma once

#include "limber/document/scene/geometry.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Does any node of the document have a skin?
bool hasRig(const Asset& asset);

// The skeleton that the skins of the scene use together, one joint for each joint node (and for each node between
// joints, so that the tree is whole), in bind pose: globals are the inverses of the inverse bind matrices where the
// skin gives them, else the nodes' transforms. Names are made unique, and joints keep the bones that the file declares
// them to be (humanoid_nodes.h). jointNode[j] is the node of joint j.
struct AssetSkeleton {
  Skeleton skeleton;
  std::vector<Index> jointNode;
};
AssetSkeleton readSkeleton(const Asset& asset);

// Weights of all vertices of `geometry` over that skeleton, as the file has them (strongest first, up to 8 slots, not
// normalised; a part without a skin that hangs on a joint node belongs to that joint outright; 0 in all slots where the
// file gives nothing).
SkinWeights readWeights(const Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton);

// Removes every skin, its joints and weights attributes, and the animation channels of its joint nodes. Joint nodes
// that contain nothing else go too; nodes that have a mesh, a camera, a light or children with such keep their world
// transform, in the bind pose. A mesh that attachRig moved to another node returns to its own. Accessors that only the
// rig used leave the list; buffers keep their bytes. Warning "node-references" where extensions may refer to nodes by
// number.
void removeRig(Asset& asset);

// Puts a rig in: joint nodes below a new root node (named "limber_rig"), a skin for each differing node transform,
// JOINTS_n / WEIGHTS_n for each primitive (unsigned bytes or shorts for joints, floats for weights), a mesh copy for
// each further instance of a mesh that is shown several times. Nothing else changes: vertex data, materials, extras,
// order. A mesh node that has a parent or a transform of its own keeps them, and hands its mesh to a new node at the
// scene's root, named after it ("..._skinned"). Warnings are added to the asset's: "node-animation" where a mesh no
// longer follows the animation of its node, "expanded-instances" where GPU instances become nodes. Throws Error
// kBadArgument where arguments do not fit; the asset is then half changed (autoRig puts it back).
//
// skeleton  in world space, any bone shape; radius is written to the node's extras ("limber_radius")
// weights   for the vertices of `geometry`, which must be collectGeometry(asset) of the asset as it is
// Returns #J nodes of the joints.
std::vector<Index> attachRig(Asset& asset, const Geometry& geometry, const Skeleton& skeleton,
                             const SkinWeights& weights);

// New weights for the skeleton that the asset has (skeleton = readSkeleton(asset)): joints, skins, clips stay as they
// are, but that a skin is given the joints that its meshes now use and it lacks. Meshes that hung on a joint without a
// skin get one; those of a node without any weights stay as they are.
void replaceWeights(Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton, const SkinWeights& weights);

}  // namespace limber
