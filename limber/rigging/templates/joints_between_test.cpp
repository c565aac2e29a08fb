#include "limber/rigging/templates/joints_between.h"

#include <gtest/gtest.h>

namespace limber {

// Joints between go along with their placed neighbours: turned and scaled as these are.
TEST(JointsBetween, GoAlongWithTheirNeighbours) {
  TemplateSkeleton skeleton;
  skeleton.joints = {{"a", {}, {0, 0, 0}, TemplateRole::kPlaced, {}},
                     {"b", 0, {0, 0.25, 0}, TemplateRole::kBetween, {}},
                     {"c", 1, {0, 1, 0}, TemplateRole::kPlaced, {}},
                     {"d", 2, {0, 2, 0}, TemplateRole::kTip, {}},
                     {"e", 2, {0.5, 1.5, 0}, TemplateRole::kBetween, {}}};
  std::vector<Vec3> positions = {{0, 0, 0}, {9, 9, 9}, {2, 0, 0}, {4, 0, 0}, {9, 9, 9}};
  placeBetween(skeleton, positions);
  EXPECT_LT((positions[1] - Vec3(0.5, 0, 0)).norm(), 1e-9);
  EXPECT_LT((positions[4] - Vec3(3, -1, 0)).norm(), 1e-9);
}

// What hangs on the last joint of a limb goes along with the bone to there, and so does the tip of what hangs there.
TEST(JointsBetween, GoAlongWithTheLimbThatTheyEnd) {
  TemplateSkeleton skeleton;
  skeleton.joints = {{"elbow", {}, {0, 1, 0}, TemplateRole::kPlaced, {}},
                     {"hand", 0, {0, 0.5, 0}, TemplateRole::kPlaced, {}},
                     {"sword", 1, {0, 0.4, 0.1}, TemplateRole::kBetween, {}},
                     {"sword tip", 2, {0, 0.4, 0.3}, TemplateRole::kTip, {}}};
  std::vector<Vec3> positions = {{0, 1, 0}, {1, 1, 0}, {9, 9, 9}, {0, 0, 0}};
  placeBetween(skeleton, positions);
  EXPECT_LT((positions[2] - Vec3(1.1, 1, 0.1)).norm(), 1e-9);
  EXPECT_LT((positions[3] - Vec3(1.1, 1, 0.3)).norm(), 1e-9);
}

// As at rest, in the size of what is known; all of it where nothing is.
TEST(JointsBetween, WithoutAPlacedJointAllStaysAsItIs) {
  TemplateSkeleton skeleton;
  skeleton.joints = {{"a", {}, {0, 0, 0}, TemplateRole::kBetween, {}},
                     {"b", 0, {0, 0.5, 0.1}, TemplateRole::kBetween, {}},
                     {"c", 1, {0, 1, 0}, TemplateRole::kBetween, {}},
                     {"c tip", 2, {0, 1.2, 0}, TemplateRole::kTip, {}}};
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  const std::vector<Vec3> before = positions;
  placeBetween(skeleton, positions);
  for (std::size_t j = 0; j < before.size(); ++j) EXPECT_LT((positions[j] - before[j]).norm(), 1e-9) << j;
}

}  // namespace limber
