// A skeleton for bones that were found in a moving mesh, and their motion as a clip of it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/rigging/decomposition/skin_decomposition.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

struct BoneSkeleton {
  Skeleton skeleton;          // a joint for each bone, "bone_01" and on, without rotation at rest
  std::vector<Index> boneOf;  // #J
  SkinWeights weights;        // those of the decomposition over the joints
};

// Joints between bones that move about a common point (Le, Deng 2014, section 5): for each pair of bones the point
// whose images under both motions stay nearest, with a slight pull to where both have vertices in common (or come
// nearest), which decides along a hinge's axis. The tree is the spanning tree of least cost, a pair's being how far the
// images are apart plus the gap between the bones' vertices, up to doubled where they have fewer vertices in common
// than others do. The root is the bone whose vertices' middle is nearest to that of all, and its joint is at that
// middle.
//
// rest  #points, as given to decomposeSkin
// Cost: O(#points + #bones^2 * (#frames + 65,000)).
BoneSkeleton skeletonOfBones(std::span<const Vec3f> rest, const Decomposition& decomposition);

struct FrameSpan {
  std::string name;
  Index first = 0, count = 0;
  double framesPerSecond = 30;
};

// Frames of the decomposition as a clip that begins at 0 s, linear between frames. The motion is that of the bones to
// rounding: where two bones do not quite keep to a common point the joint's translation is animated too.
Clip clipOfBones(const BoneSkeleton& bones, const BoneMotions& motions, const FrameSpan& span);

}  // namespace limber
