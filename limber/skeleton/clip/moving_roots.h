// The joints that carry the movement of a whole body.
#pragma once

#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

// A joint that moves, while none above it does. What moves a whole body moves its locals.
struct MovingRoot {
  Index joint = 0;
  Affine above = Affine::Identity();  // the globals of its parent, which does not move
};

// Parents first; none where nothing moves. Tracks that hold one value, whatever the number of their keys, are no
// movement. The clip has passed checkClip for the skeleton.
std::vector<MovingRoot> movingRoots(const Skeleton& skeleton, const Clip& clip);

}  // namespace limber
