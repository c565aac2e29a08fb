// Smooths, over a whole motion, what the methods that solve limb by limb made rougher than its source.
#pragma once

#include "limber/character/matching/retarget_setup.h"

namespace limber {

// Limbs that are solved for the positions of feet turn faster than the source's where proportions differ: a leg that is
// nearly straight folds at once, a hip swings over a planted foot. Where a motion's jerk (roughness.h) is more than
// 1.08 times the source's, the pelvis and the feet move by the least that takes it there, as far as that can be with
// changes of 0.15 hip heights at most: least squares over all frames of changes and jerk, by Gauss-Newton, jerk
// counting ever more. Feet that are planted in the source take no other steps than they did, none goes deeper below the
// ground than it was, knees keep their sides, and loops close as they did. Motions that are smooth are left as they
// are, bit for bit.
//
// `target` has the frames of `source`. Nothing without legs, or for fewer than 5 frames. Cost: linear in the frames,
// motions of more than a thousand in parts of about that many; up to twenty times a frame of "limb-ik" where a person's
// motion is rough, else a forward pass over both.
void smoothMotion(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target);

}  // namespace limber
