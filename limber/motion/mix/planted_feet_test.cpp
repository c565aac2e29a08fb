#include "limber/motion/mix/planted_feet.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

TEST(PlantedFeet, AreThoseOfTheTarget) {
  const Skeleton person = practiceHumanoid(), other = limber::testing::renamed(person);
  const Clip clip = clipOf(person, limber::testing::walk(person), "walk");
  const std::vector<FootSpans> feet = plantedFeet(person, clip, other, matchSkeletons(person, other), {}, 60);
  ASSERT_EQ(feet.size(), 2u);
  EXPECT_EQ(other.joints[feet[0].foot].name, "foot_l");
  // The walk's feet take turns, half a second each.
  for (const FootSpans& foot : feet) {
    double planted = 0;
    for (const TimeSpan& span : foot.planted) planted += span.to - span.from;
    EXPECT_NEAR(planted, 1, 0.25);
  }
}

TEST(PlantedFeet, FlickerIsLeftOut) {
  const std::vector<FootSpans> feet = steadied({{0, {{0, 0.5}, {0.52, 0.9}, {1.3, 1.32}}}});
  ASSERT_EQ(feet[0].planted.size(), 1u);
  EXPECT_EQ(feet[0].planted[0].to, 0.9);
}

}  // namespace
}  // namespace limber
