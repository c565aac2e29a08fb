#include "limber/retarget/spacetime.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::walk;

class Spacetime : public ::testing::Test {
 protected:
  PoseSequence by(const char* method, bool contacts = true) const {
    RetargetOptions options;
    options.contacts = contacts;
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options, &motion);
    return retargetFrames(findRetargetMethod(method), setup, motion);
  }
  // Metres that the feet are carried along while the source's stand, the tenths of a second after they come down and
  // before they go left out: the sum over all plants.
  double drift(const PoseSequence& result) const {
    double sum = 0;
    for (const char* foot : {"leftFoot", "rightFoot"}) {
      const Index from = person.find(foot).value(), to = odd.find(foot).value();
      std::vector<Vec3> source, target;
      for (std::size_t f = 0; f < motion.poses.size(); ++f) {
        source.push_back(poseGlobals(person, motion.poses[f])[from].translation());
        target.push_back(poseGlobals(odd, result.poses[f])[to].translation());
      }
      for (std::size_t begin = 0, end = 1; end <= source.size(); ++end) {
        if (end < source.size() && (source[end] - source[end - 1]).norm() < 1e-4) continue;
        if (end - begin > 18) {
          const Vec3 way = target[end - 7] - target[begin + 6];
          sum += std::hypot(way.x(), way.z());
        }
        begin = end;
      }
    }
    return sum;
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

TEST_F(Spacetime, PlantedFeetAreNotCarriedAlong) {
  ASSERT_GT(drift(by("aligned")), 0.004);
  EXPECT_LT(drift(by("spacetime")), 0.5 * drift(by("aligned")));
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
