// The method "copy": what one gets without aligning anything, to compare with.
#pragma once

#include <memory>

#include "limber/motion/retarget/retarget_method.h"

namespace limber {

// Each matched joint's local rotation against rest is taken over as it is (of several source joints the first, on the
// first target joint). Right between skeletons with the same rest pose and local axes; the root moves as with the other
// methods.
std::unique_ptr<FrameRetargeter> makeCopy(const RetargetSetup& setup);

}  // namespace limber
