#include "limber/motion/retarget/spacetime.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::slideDistance;
using limber::testing::walk;

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
