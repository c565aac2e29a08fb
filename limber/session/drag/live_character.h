// A character that follows a motion as it comes, frame by frame.
#pragma once

#include <memory>
#include <optional>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/session/rigged_model.h"
#include "limber/skeleton/motion.h"

namespace limber {

class LiveCharacter {
 public:
  // Throws Error as matchSkeletons does.
  LiveCharacter(std::shared_ptr<const RiggedModel> rig, Skeleton source);

  // The character's pose (#J locals) for this pose of the source (locals of all its joints), at that time in seconds,
  // which increases from call to call. The source's ground is measured in the first frame. Throws Error kBadArgument
  // for another number of joints. Cost after the first frame: that of one frame of limb-ik.
  const Pose& next(const Pose& source, double seconds);

  // The source's frames of the last minutes, at most 36,000, as one clip "live".
  Motion recorded() const;

 private:
  void begin(const Pose& source);

  std::shared_ptr<const RiggedModel> rig_;
  Skeleton source_;
  SkeletonMap map_;
  PlainSkeleton plainSource_, plainTarget_;
  std::optional<RetargetSetup> setup_;
  std::unique_ptr<FrameRetargeter> retargeter_;
  Quat turn_;
  PoseSequence frame_;
  Pose target_, shown_;
  double last_ = 0;              // the moment of the last frame, as it was told
  std::vector<double> moments_;  // of the frames below, from 0
  std::vector<Pose> poses_;
};

}  // namespace limber
