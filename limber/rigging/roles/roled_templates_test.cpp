#include "limber/rigging/roles/roled_templates.h"

#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"

namespace limber {

TEST(RoledTemplates, JointsWithRolesArePlaced) {
  Skeleton person = testing::vrmPerson();
  testing::addJoint(person, "Sword", "rightHand", {-0.1, 0, 0.1});
  testing::addJoint(person, "SwordTip", "Sword", {0, 0, 0.6});
  const FixedLabel label = {*person.find("Sword"), PartKind::kProp};
  AnatomyOptions options;
  options.fixed = {&label, 1};
  const RoledSkeleton made = withRoles(templateFrom(person, "mine"), jointRoles(person, readAnatomy(person, options)));
  ASSERT_EQ(made.roles.size(), made.skeleton.joints.size());
  for (std::size_t j = 0; j < made.roles.size(); ++j) {
    const TemplateJoint& joint = made.skeleton.joints[j];
    SCOPED_TRACE(joint.name);
    if (joint.role == TemplateRole::kTip) {
      ASSERT_TRUE(joint.parent);
      EXPECT_EQ(made.roles[j].has_value(), made.roles[*joint.parent].has_value());
    } else {
      EXPECT_EQ(joint.role == TemplateRole::kPlaced, made.roles[j].has_value());
    }
  }
  const std::optional<RolePosition>& hand = made.roles[*made.skeleton.find("rightHand")];
  ASSERT_TRUE(hand && hand->isRole());
  EXPECT_EQ(hand->from, "fore_end.R");
  EXPECT_FALSE(made.roles[*made.skeleton.find("Sword")]);
}

}  // namespace limber
