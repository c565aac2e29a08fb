#include "limber/motion/limbs/body/tail_lift.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/limb_reach.h"
#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

// Set by hand on a cat, whose tail is longer than its legs.
struct TailValues {
  double clearance = 0.03;  // hip heights; 0 to 0.1; between the tail's joints and the ground
  double soft = 0.05;       // radians; 0.02 to 0.2; over which the lift begins without a kink
  double back = 0.1;        // fraction of its length; 0.02 to 0.3; of its direction at rest in its heading
  double fine = 0.1;        // radians; 0.03 to 0.3; width of the soft maximum over the tail's joints
};
constexpr TailValues kTailValues;

}  // namespace

TailLift::TailLift(const RetargetSetup& setup, const RootPositioner& root)
    : setup_(setup), root_(root), tail_(setup.targetTail) {
  if (tail_.size() < 2 || !setup.target->joints[tail_.front()].parent) tail_.clear();
}

double TailLift::needed(const BodyFrame& frame) const {
  const Vec3 base = frame.positions[tail_.front()];
  const double floor = setup_.targetGround + kTailValues.clearance * setup_.targetHipHeight;
  double sum = 0, weights = 0;
  for (auto joint = tail_.begin() + 1; joint != tail_.end(); ++joint) {
    const Vec3 displacement = frame.positions[*joint] - base;
    const double length = displacement.norm();
    if (!(length > 0)) continue;
    const double least = std::asin(std::clamp((floor - base.y()) / length, -1.0, 1.0));
    const double up =
        softPositive(least - std::asin(std::clamp(displacement.y() / length, -1.0, 1.0)), kTailValues.soft);
    const double weight = std::exp(up / kTailValues.fine);
    sum += weight * up;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

// Where it points, level; what hangs straight down goes back.
Vec3 TailLift::heading(const BodyFrame& frame) const {
  const NeutralPose& neutral = setup_.targetNeutral;
  const Index hips = *setup_.target->joints[tail_.front()].parent;
  const Vec3 atRest = neutral.positions[tail_.back()] - neutral.positions[tail_.front()];
  const Vec3 back = frame.rotations[hips] * neutral.rotations[hips].conjugate() * atRest;
  return alongGround(frame.positions[tail_.back()] - frame.positions[tail_.front()] + kTailValues.back * back);
}

void TailLift::apply(Pose& target, BodyFrame& frame) const {
  if (tail_.empty()) return;
  const Vec3 ahead = heading(frame);
  if (!(ahead.norm() > 1e-6 * setup_.targetHipHeight)) return;
  const Quat up(Eigen::AngleAxisd(needed(frame), ahead.normalized().cross(Vec3::UnitY())));
  const Index base = tail_.front();
  LimbReach(setup_, root_).turnEnd(base, up * frame.rotations[base], frame, target);
}

}  // namespace limber
