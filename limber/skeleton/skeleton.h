// Joints in a tree, their rest pose, and what a bone is.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/transform.h"

namespace limber {

struct Joint {
  std::string name;             // unique in its skeleton, UTF-8
  std::optional<Index> parent;  // always less than the joint's own index; none for a root
  Transform rest;               // local to the parent's frame
  double radius = 0;            // of the sphere fitted there; 0 where the skeleton has none
  // The bone of a person that its file says it is, whatever it is called (one of humanoidBones(), which live forever);
  // empty where the file says nothing.
  std::string_view declaredBone = {};
};

// What a joint's bone is: the sphere round it, or the segments from it to its children (a leaf: a short one of its
// own).
enum class BoneShape { kSphere, kSegment };

// Parents come before children. Several roots are allowed.
struct Skeleton {
  std::vector<Joint> joints;
  BoneShape boneShape = BoneShape::kSegment;

  Index jointCount() const { return static_cast<Index>(joints.size()); }
  std::optional<Index> find(std::string_view name) const;
};

// Throws Error kBadData naming the joint: parent not before child, name missing or twice, transform not finite.
void checkSkeleton(const Skeleton& skeleton);

// #J global transforms from #J local ones, parents first, one pass. `locals` and `globals` hold #J elements each.
void globalTransforms(const Skeleton& skeleton, std::span<const Transform> locals, std::span<Affine> globals);
std::vector<Affine> restGlobals(const Skeleton& skeleton);
std::vector<Transform> restLocals(const Skeleton& skeleton);

// A bone as skinning sees it: points of `joint` closer to the segment a-b than radius belong to it outright.
// a == b for a sphere. In the space of the skeleton's globals.
struct Bone {
  Index joint = 0;
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius = 0;
  std::optional<Index> parent = std::nullopt;  // the joint above that has a bone, too; none at a root
};

// The bones of a skeleton in rest pose, ordered by joint.
//
// Segments: from a joint to its child. Skeletons are mostly drawn bone by bone with one axis of the joint along the
// bone
// (+Y in Blender, X in Maya); where the joints with a single child agree on such an axis, it tells the rest: of several
// children the one that lies along it is the bone's end (clavicles and thighs are then none of the spine's); where none
// does, and at a leaf, the bone follows the axis. It is then as long as the children, or the parent, are far, at
// most 2.5 times the median bone. Without a common axis a joint has a bone to each child, and a leaf goes on in its
// parent's direction. A joint that lies on its only child has no bone; a leaf may be a point.
//
// moves  #J: joints that are to have bones at all; empty for all joints
std::vector<Bone> bonesOf(const Skeleton& skeleton, const std::vector<bool>& moves = {});

}  // namespace limber
