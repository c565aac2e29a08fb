// Motions whose rest pose has no form (limber/character/matching/rest_form.h): what comes out is what the same motion
// gives from a T-pose.
#include <gtest/gtest.h>

#include "limber/character/matching/rest_form.h"
#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::MovedSkeleton;
using limber::testing::turn;
using limber::testing::turnedMotion;
using limber::testing::walk;
using limber::testing::withZeroedAxes;

class FlatRest : public ::testing::Test {
 protected:
  PoseSequence retargeted(const MovedSkeleton& source) const {
    const std::optional<Pose> pose = poseWithForm(source.skeleton, source.motion.poses);
    const SkeletonMap map = matchSkeletons(source.skeleton, other, false, pose ? &*pose : nullptr);
    const RetargetSetup setup(source.skeleton, other, map, {}, &source.motion);
    return retargetFrames(findRetargetMethod("aligned"), setup, source.motion);
  }

  // The largest angle in degrees between bones of arms and legs, and the largest distance between the hips, in metres.
  void expectAlike(const PoseSequence& a, const PoseSequence& b, double degrees) const {
    double worst = 0, apart = 0;
    for (std::size_t f = 0; f < a.poses.size(); ++f) {
      const std::vector<Vec3> one = posePositions(other, a.poses[f]), two = posePositions(other, b.poses[f]);
      apart = std::max(apart, (one[0] - two[0]).norm());
      for (const char* name : {"leftLowerArm", "rightLowerArm", "leftHand", "rightHand", "leftLowerLeg",
                               "rightLowerLeg", "leftFoot", "rightFoot"}) {
        const Index joint = other.find(name).value(), above = other.joints[joint].parent.value();
        const Vec3 from = one[joint] - one[above], to = two[joint] - two[above];
        worst = std::max(worst, std::atan2(from.cross(to).norm(), from.dot(to)) * 180 / kPi);
      }
    }
    EXPECT_LT(worst, degrees);
    // Of a path of 3 m: the ankles' height over the toes is that of the frame that replaces the rest pose.
    EXPECT_LT(apart, 0.25);
  }

  const Skeleton person = practiceHumanoid(), other = testing::scaled(testing::oddlyBuilt(), 0.9);
};

TEST_F(FlatRest, TheBodyKeepsItsHeading) {
  for (const double degrees : {0, 37, 90, 180, -120}) {
    const PoseSequence motion = turnedMotion(walk(person), turn(Vec3::UnitY(), degrees));
    const PoseSequence right = retargeted({person, motion});
    for (const bool mirrored : {false, true}) {
      SCOPED_TRACE(degrees);
      expectAlike(retargeted(withZeroedAxes(person, motion, mirrored, turn(Vec3(1, 1, 1), 120))), right, 15);
    }
  }
}

TEST_F(FlatRest, WhoLiesOrCrawlsDoesNotStandUp) {
  for (const double degrees : {80, 90, -90}) {
    PoseSequence motion = turnedMotion(walk(person), turn(Vec3::UnitX(), degrees));
    for (Pose& pose : motion.poses) pose.locals[0].translation.y() += 0.4;
    SCOPED_TRACE(degrees);
    expectAlike(retargeted(withZeroedAxes(person, motion, false, turn(Vec3(1, 1, 1), 120))),
                retargeted({person, motion}), 15);
  }
}

}  // namespace
}  // namespace limber
