// How pelvis and feet are moved by changes (LeastChanges): where the legs go then, and the pose that does it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limber/motion/limbs/body/trunk_tilt.h"
#include "limber/motion/limbs/limb_reach.h"
#include "limber/motion/retarget/least_changes.h"

namespace limber {

class MovedLegs {
 public:
  // All but the legs must outlive this.
  MovedLegs(const RetargetSetup& setup, const RootPositioner& root, const TrunkTilt& trunk, std::vector<LegSpec> legs);

  // Of so many frames.
  ChangeLayout layoutOf(std::size_t frames) const;
  // The motion before any changes, frame by frame: the globals of the target.
  void clear() { frames_.clear(); }
  void add(const BodyFrame& frame);
  // Whether legs are solved that are at their goals already.
  void solveAll(bool all) { solvesAll_ = all; }

  // The paths of a ChangedMotion with these changes, without posing a body. False where planted feet do not reach their
  // positions; `feet` of each frame, of each leg. About 0.1 us for a leg in a frame.
  bool follow(const ChangeLayout& layout, const Changes& changes, std::span<const FootFrame> feet,
              std::vector<Path>& paths) const;
  // About the motion with its changes, seen over `probe` hip heights to each side.
  void findSlopes(const ChangeLayout& layout, double probe, ChangedMotion& motion) const;
  // Changes a frame of the target, which is as it was before any changes; feet turned so about the vertical (radians,
  // of each leg).
  void pose(const ChangeLayout& layout, const Changes& changes, std::size_t frame, Pose& target,
            std::span<const double> twists = {});

 private:
  struct LegFrame {
    LimbShape shape;
    Vec3 hip;
  };
  struct Frame {
    Vec3 pelvis = Vec3::Zero();
    Vec3 middle = Vec3::Zero(), trunk = Vec3::UnitY();  // of the hips, about which the trunk tilts
    std::vector<LegFrame> legs;
  };
  // How the pelvis takes along what hangs on it: metres, and about the hips' middle.
  struct Move {
    Vec3 shift;
    Quat tilt = Quat::Identity();
  };
  struct Reached {
    std::array<Vec3, 2> bones;  // over their lengths at rest
    double missed = 0;          // distance left to the goal, metres
  };

  void findWeights();
  Move moveAt(const ChangeLayout& layout, const Changes& changes, std::size_t frame, double furtherUp = 0) const;
  Vec3 displacementOf(const Vec3& point, double weight, const Frame& frame, const Move& move) const;
  Reached reached(std::size_t frame, std::size_t leg, const Move& move, const Vec3& footDisplacement) const;

  const RetargetSetup& setup_;
  const RootPositioner& root_;
  const TrunkTilt& trunk_;
  LimbReach reach_;
  std::vector<LegSpec> legs_;
  // The fractions of the pelvis' displacement that its point and each leg's hip take.
  double pelvisWeight_ = 0;
  std::vector<double> hipWeights_;
  std::vector<std::array<double, 2>> lengths_;  // of each leg's bones at rest
  std::vector<Frame> frames_;
  bool solvesAll_ = false;
  BodyFrame posed_;
};

}  // namespace limber
