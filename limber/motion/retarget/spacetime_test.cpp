#include "limber/motion/retarget/spacetime.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::slideDistance;
using limber::testing::turn;
using limber::testing::walk;
using limber::testing::withoutToes;

// Crouches, jumps and crouches again, in a second and a half.
PoseSequence jump(const Skeleton& person) {
  PoseSequence sequence;
  sequence.frameSeconds = 1 / 120.0;
  const auto joint = [&](const std::string& name) { return person.find(name).value(); };
  const Index foot = joint("leftFoot"), hips = joint("hips");
  const double standing = restGlobals(person)[foot].translation().y(), leaves = 0.6, lands = 1.1, gravity = 9.8;
  for (double t = 0; t < 1.7; t += sequence.frameSeconds) {
    Pose pose = restPose(person);
    // The knees are most bent a moment before and after the flight, and the heels come up as they straighten.
    const auto near = [&](double time, double width) { return std::exp(-std::pow((t - time) / width, 2)); };
    const double knee = 10 + 80 * (near(leaves - 0.15, 0.12) + near(lands + 0.12, 0.12));
    const double heel = 0.05 * near(leaves - 0.02, 0.05) + 0.02 * near(lands + 0.05, 0.04);
    for (const std::string side : {"left", "right"}) {
      pose.locals[joint(side + "UpperLeg")].rotation = turn(-Vec3::UnitX(), knee / 2);
      pose.locals[joint(side + "LowerLeg")].rotation = turn(Vec3::UnitX(), knee);
      pose.locals[joint(side + "Foot")].rotation = turn(-Vec3::UnitX(), knee / 2);
    }
    const double flight = t > leaves && t < lands ? gravity / 2 * (t - leaves) * (lands - t) : 0;
    const double height = standing + heel + flight;
    const Vec3 ankle = poseGlobals(person, pose)[foot].translation();
    pose.locals[hips].translation +=
        Vec3(0, height - ankle.y(), -ankle.z() + 0.5 * std::clamp(t - leaves, 0.0, lands - leaves));
    sequence.poses.push_back(std::move(pose));
  }
  return sequence;
}

class Spacetime : public ::testing::Test {
 protected:
  PoseSequence by(const char* method, const PoseSequence& moves, bool contacts = true) const {
    RetargetOptions options;
    options.contacts = contacts;
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options, &moves);
    return retargetFrames(findRetargetMethod(method), setup, moves);
  }
  PoseSequence by(const char* method) const { return by(method, motion); }
  // The largest third difference of the hips' path, metres.
  double roughness(const PoseSequence& result) const {
    const Index hips = odd.find("hips").value();
    double worst = 0;
    for (std::size_t f = 3; f < result.poses.size(); ++f) {
      const auto at = [&](std::size_t back) { return result.poses[f - back].locals[hips].translation; };
      worst = std::max(worst, (at(0) - 3 * at(1) + 3 * at(2) - at(3)).norm());
    }
    return worst;
  }

  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const PoseSequence motion = walk(person);
};

TEST_F(Spacetime, PlantedFeetStand) {
  const double angles = slideDistance(person, motion, odd, by("aligned"));
  ASSERT_GT(angles, 0.01);
  EXPECT_LT(slideDistance(person, motion, odd, by("spacetime")), 0.02 * angles);
}

TEST_F(Spacetime, FeetStayAboveTheGround) {
  const PoseSequence angles = by("aligned"), result = by("spacetime");
  double deepest = 0;
  for (const char* name : {"leftFoot", "rightFoot", "leftToes", "rightToes"}) {
    const Index joint = odd.find(name).value();
    const double standing = restGlobals(odd)[joint].translation().y();
    for (std::size_t f = 0; f < result.poses.size(); ++f) {
      deepest = std::max(deepest, standing - poseGlobals(odd, angles.poses[f])[joint].translation().y());
      ASSERT_GT(poseGlobals(odd, result.poses[f])[joint].translation().y(), standing - 0.002) << name << ' ' << f;
    }
  }
  EXPECT_GT(deepest, 0.005) << "joint angles alone would do";
}

// Feet without toes let go while the body still rises on them, and come down bent.
TEST_F(Spacetime, AJumpIsAsHighAsItsJointAnglesHaveIt) {
  const Skeleton toeless = withoutToes(person);
  const PoseSequence moves = jump(toeless);
  const RetargetSetup setup(toeless, odd, matchSkeletons(toeless, odd), {}, &moves);
  const auto heights = [&](const char* method) {
    std::vector<double> lower;
    for (const Pose& pose : retargetFrames(findRetargetMethod(method), setup, moves).poses) {
      const std::vector<Affine> globals = poseGlobals(odd, pose);
      const auto height = [&](const char* name) { return globals[odd.find(name).value()].translation().y(); };
      lower.push_back(std::min(height("leftFoot"), height("rightFoot")));
    }
    return lower;
  };
  const std::vector<double> angles = heights("aligned"), result = heights("spacetime");
  const double standing = result.front(), highest = *std::max_element(angles.begin(), angles.end()) - standing;
  ASSERT_GT(highest, 0.2);
  for (std::size_t f = 0; f < angles.size(); ++f) EXPECT_NEAR(result[f], angles[f], 0.1 * highest) << f;
}

TEST_F(Spacetime, NothingChangesWithoutConstraints) {
  const PoseSequence angles = by("aligned", motion, false), result = by("spacetime", motion, false);
  for (std::size_t f = 0; f < result.poses.size(); ++f) {
    for (Index j = 0; j < odd.jointCount(); ++j) {
      ASSERT_LT(angleBetween(angles.poses[f].locals[j].rotation, result.poses[f].locals[j].rotation), 1e-6);
    }
  }
}

TEST_F(Spacetime, TheChangeIsSmooth) {
  EXPECT_LT(roughness(by("spacetime")), 1.1 * roughness(by("aligned")));
}

// Of two takes in one file neither changes for the other.
TEST_F(Spacetime, ACutPartsWhatIsBeforeFromWhatIsBehind) {
  PoseSequence takes = motion;
  for (Pose pose : motion.poses) {
    pose.locals[person.find("hips").value()].translation += Vec3(7, 0, -3);
    takes.poses.push_back(std::move(pose));
  }
  const PoseSequence alone = by("spacetime"), both = by("spacetime", takes);
  for (std::size_t f = 0; f < alone.poses.size(); ++f) {
    for (Index j = 0; j < odd.jointCount(); ++j) {
      ASSERT_LT(angleBetween(alone.poses[f].locals[j].rotation, both.poses[f].locals[j].rotation), 1e-6) << f;
    }
  }
}

}  // namespace
}  // namespace limber
