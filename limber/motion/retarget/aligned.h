// The method "aligned": each matched joint has the world rotation of the source's, against the neutral pose.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "limber/motion/limbs/body/root_motion.h"
#include "limber/motion/retarget/retarget_method.h"

namespace limber {

// Joint angle imitation in world space (Feng et al. 2012, Tang et al. 2012): a target joint's global rotation is the
// source joint's rotation against the neutral pose that both skeletons have in common, applied to the target's. Where
// joint counts differ along a part, each target joint takes the mean rotation of the source joints beside it; a shin
// without a hock points from knee to foot as one with a hock does. Joints without a match keep their rest rotation
// against their parent. No allocation; about 30 ns for each joint.
class AlignedRetargeter : public FrameRetargeter {
 public:
  explicit AlignedRetargeter(const RetargetSetup& setup);
  void next(const Pose& source, double seconds, Pose& target) override;

  // Globals of the last frame, of the source and of the answer, in each person's space.
  const BodyFrame& sourceFrame() const { return sourceFrame_; }
  const BodyFrame& targetFrame() const { return targetFrame_; }
  BodyFrame& targetFrame() { return targetFrame_; }
  const RootPositioner& root() const { return root_; }

 private:
  // The turns of several source joints, by how much of the part each has beside the target joint.
  struct WeightedSource {
    Index source;
    double weight;
    Quat fromNeutral;  // inverse of the source joint's neutral rotation
  };
  // From a part's first joint of the source to the next part's, and where it points in the neutral pose.
  struct Line {
    Index begin, end;
    Vec3 neutral;
  };
  struct Follow {
    bool moved = false;
    Index source = 0;
    Quat after = Quat::Identity();        // from the source joint's rotation to the target's
    std::vector<WeightedSource> sources;  // where several, or a line; `after` is then the target's neutral rotation
    std::optional<Line> line;             // that it points along, as the source's does
  };
  void follow(const JointMatch& match);
  void followLine(const BodyPart& part, const BodyPart& nextPart);
  Quat rotationOf(const Follow& follow) const;

  const RetargetSetup& setup_;
  RootPositioner root_;
  std::vector<Follow> follows_;  // #J of the target
  BodyFrame sourceFrame_, targetFrame_;
};

std::unique_ptr<FrameRetargeter> makeAligned(const RetargetSetup& setup);

}  // namespace limber
