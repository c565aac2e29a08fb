// The motion that a program gave back, as frames of the character's skeleton.
#pragma once

#include "limber/adapters/adapter.h"
#include "limber/adapters/program_run.h"
#include "limber/core/error.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {

// Of the motion that was handed over.
struct HandedFrames {
  Index count = 0;
  double framesPerSecond = 0;
  bool isStill = false;  // all are equal: then one frame is as good
};

struct ReturnedMotion {
  PoseSequence frames;
  Warnings warnings;
};

// Joints are the character's by their names, in any order. Each turns against its rest pose as it does in the file,
// whose rest pose has no rotations; roots go where the file has them; any other joint keeps its distance from its
// parent, but for what the file moves it by. Joints that the file leaves out stay at rest (warning "missing-joints"),
// those that the character has not are passed over ("unknown-joints"); end sites are neither.
//
// skeleton  the character's, plainly named, as it was handed over: without negative scales
// Throws Error kBadData that says what is wrong: no BVH or a damaged one, numbers that are not finite, another number
// of frames or another frame time (by more than 1 %), nothing that moves where something did, none of the character's
// joints or not its root, a joint that hangs on another one, or as checkSameOffsets.
// Cost: linear in frames and joints, and the square of the joints once.
ReturnedMotion readReturnedMotion(const ProgramOutput& output, const Adapter& adapter, const Skeleton& skeleton,
                                  const HandedFrames& handed);

}  // namespace limber
