// Left for right: which joints of a skeleton are each other's mirror image.
#pragma once

#include "limber/skeleton/clip/mirror_clip.h"

namespace limber {

// Partners by their names and by where they lie in rest pose, as the body folds (foldBody): a joint's partner hangs on
// its parent's partner. Of a skeleton without sides each joint is its own. Cost: linear in the joints, but for many
// children of one joint.
SkeletonMirror mirrorOf(const Skeleton& skeleton);

}  // namespace limber
