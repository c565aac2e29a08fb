#include "limber/retarget/online.h"

#include <gtest/gtest.h>

#include "limber/matching/testing/test_motion.h"
#include "limber/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::slidWay;
using limber::testing::walk;

class Online : public ::testing::Test {
 protected:
  PoseSequence by(const char* method) const {
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {}, &motion);
    return retargetFrames(findRetargetMethod(method), setup, motion);
  }

  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const PoseSequence motion = walk(person);
};

TEST_F(Online, FeetComeFirst) {
  EXPECT_LT(slidWay(person, motion, odd, by("online")), 0.35 * slidWay(person, motion, odd, by("aligned")));
}

TEST_F(Online, FeetKeepHowTheyAreTurned) {
  const PoseSequence angles = by("aligned"), result = by("online");
  for (const char* name : {"leftFoot", "rightFoot", "leftHand"}) {
    const Index joint = odd.find(name).value();
    for (std::size_t f = 0; f < result.poses.size(); f += 5) {
      const Mat3 expected = poseGlobals(odd, angles.poses[f])[joint].linear();
      EXPECT_LT((poseGlobals(odd, result.poses[f])[joint].linear() - expected).norm(), 0.02) << name << " " << f;
    }
  }
}

TEST_F(Online, KneesThatOverstretchALittleDoNotSnap) {
  PoseSequence squat{{}, 1.0 / 60};
  for (int f = 0; f < 60; ++f) {
    Pose& pose = squat.poses.emplace_back(restPose(person));
    for (const std::string side : {"left", "right"}) {
      const double bend = 4 - 0.15 * f;  // degrees: straight on the way, then backward
      pose.locals[person.find(side + "UpperLeg").value()].rotation = limber::testing::turn(-Vec3::UnitX(), bend / 2);
      pose.locals[person.find(side + "LowerLeg").value()].rotation = limber::testing::turn(Vec3::UnitX(), bend);
      pose.locals[person.find(side + "Foot").value()].rotation = limber::testing::turn(-Vec3::UnitX(), bend / 2);
    }
    pose.locals[0].translation.y() -= 0.02;
  }
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {}, &squat);
  const PoseSequence result = retargetFrames(findRetargetMethod("online"), setup, squat);
  const Index knee = odd.find("leftLowerLeg").value();
  for (std::size_t f = 1; f < result.poses.size(); ++f) {
    const Vec3 step = poseGlobals(odd, result.poses[f])[knee].translation() -
                      poseGlobals(odd, result.poses[f - 1])[knee].translation();
    EXPECT_LT(step.norm(), 0.01) << f;
  }
}

// The null space is for the joint angles: what no end needs stays as in "aligned".
TEST_F(Online, OtherJointsTurnAsTheSources) {
  const PoseSequence angles = by("aligned"), result = by("online");
  for (std::size_t f = 0; f < result.poses.size(); f += 5) {
    const std::vector<Affine> expected = poseGlobals(odd, angles.poses[f]), given = poseGlobals(odd, result.poses[f]);
    for (const char* name : {"spine", "chest", "head"}) {
      const Index joint = odd.find(name).value();
      EXPECT_LT((given[joint].linear() - expected[joint].linear()).norm(), 1e-6) << name;
    }
    const Index toes = odd.find("leftToes").value();
    EXPECT_LT(angleBetween(angles.poses[f].locals[toes].rotation, result.poses[f].locals[toes].rotation), 1e-6);
  }
}

}  // namespace
}  // namespace limber
