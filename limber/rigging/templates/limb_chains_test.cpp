#include "limber/rigging/templates/limb_chains.h"

#include <gtest/gtest.h>

namespace limber {

TEST(LimbChains, HoldEachJointOnce) {
  for (const TemplateSkeleton& skeleton : templateSkeletons()) {
    SCOPED_TRACE(skeleton.name);
    std::vector<int> times(skeleton.joints.size());
    for (const TemplateLimb& limb : limbChains(skeleton)) {
      ASSERT_FALSE(limb.joints.empty());
      EXPECT_TRUE(limb.isThere);
      for (std::size_t i = 0; i < limb.joints.size(); ++i) {
        ++times[limb.joints[i]];
        EXPECT_NE(skeleton.joints[limb.joints[i]].role, TemplateRole::kTip);
        if (i > 0) {
          EXPECT_EQ(skeleton.joints[limb.joints[i]].parent, limb.joints[i - 1]);
        }
      }
    }
    for (std::size_t j = 0; j < times.size(); ++j) EXPECT_LE(times[j], 1) << skeleton.joints[j].name;
  }
}

TEST(LimbChains, MissingOnesAreNamedByTheirEnds) {
  const TemplateSkeleton& person = *findTemplate("humanoid");
  std::vector<TemplateLimb> limbs = limbChains(person);
  EXPECT_EQ(missingLimbs(person, limbs), "");
  for (TemplateLimb& limb : limbs) limb.isThere = person.joints[limb.joints.front()].name != "leftUpperLeg";
  EXPECT_EQ(missingLimbs(person, limbs), "leftUpperLeg to leftToes");
  for (TemplateLimb& limb : limbs) {
    limb.isThere = limb.isThere && person.joints[limb.joints.front()].name != "rightUpperLeg";
  }
  EXPECT_EQ(missingLimbs(person, limbs), "leftUpperLeg to leftToes, rightUpperLeg to rightToes");
}

}  // namespace limber
