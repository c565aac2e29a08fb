// A motion of the character, ready to be mixed with others.
#pragma once

#include <string>
#include <vector>

#include "limber/motion/mix/gait/footfalls.h"
#include "limber/motion/mix/ground_frame.h"
#include "limber/motion/mix/planted_feet.h"

namespace limber {

class MixMotion {
 public:
  // The clip at its own rate (denseFrameRateOf), and when its feet are planted (plantedFeet), by the joints of the
  // body's legs; without any, they are read off the clip. A first frame from which it jumps, as the T-pose that some
  // recordings begin with, is left out unless all frames are to be kept, and scales that change are not kept. The
  // body must outlive this. Throws as checkClip and sampleFrames do.
  MixMotion(const MixBody& body, const ClipWithContacts& motion, bool keepAll = false);

  const std::string& name() const { return name_; }
  double duration() const { return static_cast<double>(frames_.poses.size() - 1) * frames_.frameSeconds; }
  double frameSeconds() const { return frames_.frameSeconds; }
  const std::vector<FootSpans>& feet() const { return feet_; }
  const std::vector<Footfall>& footfalls() const { return footfalls_; }
  // While that foot of the body's legs is planted.
  std::vector<TimeSpan> planted(Index foot) const;

  // The pose at a moment (PoseCurve).
  void sample(double seconds, Pose& pose) const;
  // Where the body is then; it heads as its pelvis does but for how that sways in a stride (the mean over one), so that
  // gaits that sway otherwise head alike.
  GroundFrame groundAt(double seconds) const;
  // The same where the globals of sample() are known.
  GroundFrame groundAt(double seconds, const BodyFrame& frame) const;

  // Whether it ends as it begins, but for its position on the ground and its heading: then it can be repeated.
  bool loops() const;
  // One behind the other, so many times in all, each where the one before ended.
  MixMotion repeated(int times) const;

 private:
  void leaveOutFirstPose();
  void readSteps();
  GroundFrame poseFrameAt(double seconds) const;  // heading as the pelvis does

  const MixBody* body_;
  std::string name_;
  PoseSequence frames_;
  std::vector<FootSpans> feet_;
  std::vector<Footfall> footfalls_;
  std::vector<double> sways_;  // of each frame, by how much it heads otherwise than its pelvis: radians
};

}  // namespace limber
