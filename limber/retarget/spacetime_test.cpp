#include "limber/retarget/spacetime.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::slidWay;
using limber::testing::walk;

class Spacetime : public ::testing::Test {
 protected:
  PoseSequence by(const char* method, bool contacts = true) const {
    RetargetOptions options;
    options.contacts = contacts;
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options, &motion);
    return retargetFrames(findRetargetMethod(method), setup, motion);
  }
  // The largest third difference of a hip's way, metres.
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

TEST_F(Spacetime, PlantedFeetStandFromTheirFirstFrame) {
  EXPECT_LT(slidWay(person, motion, odd, by("spacetime")), 0.35 * slidWay(person, motion, odd, by("aligned")));
}

TEST_F(Spacetime, NothingChangesWithoutConstraints) {
  const PoseSequence angles = by("aligned", false), result = by("spacetime", false);
  for (std::size_t f = 0; f < result.poses.size(); ++f) {
    for (Index j = 0; j < odd.jointCount(); ++j) {
      ASSERT_LT(angleBetween(angles.poses[f].locals[j].rotation, result.poses[f].locals[j].rotation), 1e-6);
    }
  }
}

TEST_F(Spacetime, TheChangeIsSmooth) {
  EXPECT_LT(roughness(by("spacetime")), 1.1 * roughness(by("aligned")));
}

}  // namespace
}  // namespace limber
