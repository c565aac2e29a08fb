#include "limber/motion/mix/gait/footfalls.h"

#include <gtest/gtest.h>

#include "limber/motion/mix/testing/sample_clip.h"

namespace limber {
namespace {

// The gaits' own tables: how long a stride takes, and a footfall of one foot every half of it.
TEST(Footfalls, ComeOnceAStrideOfEitherFoot) {
  const struct {
    const char* name;
    double stride;  // seconds
  } gaits[] = {{"walk", 1.1}, {"run", 0.7}, {"sneak", 1.8}};
  for (const auto& gait : gaits) {
    SCOPED_TRACE(gait.name);
    const Skeleton skeleton = limber::testing::sampleSkeleton();
    const MixBody body(skeleton);
    const std::vector<Footfall> falls = MixMotion(body, limber::testing::sampleClip(gait.name)).footfalls();
    ASSERT_GE(falls.size(), 5u);
    for (std::size_t k = 1; k < falls.size(); ++k) {
      EXPECT_NE(falls[k].foot, falls[k - 1].foot);
      EXPECT_NEAR(falls[k].seconds - falls[k - 1].seconds, gait.stride / 2, 0.01);
    }
  }
}

TEST(Footfalls, NobodyStepsWhoStands) {
  const Skeleton skeleton = limber::testing::sampleSkeleton();
  const PoseSequence still{std::vector<Pose>(60, restPose(skeleton)), 1.0 / 60};
  EXPECT_TRUE(footfallsOf(MixBody(skeleton), still).empty());
}

}  // namespace
}  // namespace limber
