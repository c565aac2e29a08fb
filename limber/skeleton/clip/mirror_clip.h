// Left for right: which joints are each other's mirror image, and clips turned round accordingly.
#pragma once

#include "limber/skeleton/clip/clip.h"

namespace limber {

// How a skeleton's two sides lie. A joint's partner hangs on its parent's partner.
struct SkeletonMirror {
  std::vector<Index> partner;   // #J: the joint of the other side; a joint of the middle is its own
  Vec3 normal = Vec3::UnitX();  // of the plane between the sides, in the skeleton's space
};

// The clip as it looks in a mirror in that plane through the roots' rest positions: the right hand does what the left
// one did. Keys and interpolation stay. Exact where the rest pose is symmetric; else each joint turns from its own rest
// pose as its partner did, mirrored. Scales go to the partner as they are. The clip has passed checkClip.
Clip mirrorClip(const Clip& clip, const Skeleton& skeleton, const SkeletonMirror& mirror);

}  // namespace limber
