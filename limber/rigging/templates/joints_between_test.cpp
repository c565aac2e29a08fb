#include "limber/rigging/templates/joints_between.h"

#include <gtest/gtest.h>

namespace limber {

// Joints between go along with their placed neighbours: turned and scaled as these are.
TEST(JointsBetween, GoAlongWithTheirNeighbours) {
  TemplateSkeleton skeleton;
  skeleton.joints = {{"a", {}, {0, 0, 0}, TemplateRole::kPlaced, 1, 1, {}},
                     {"b", 0, {0, 0.25, 0}, TemplateRole::kBetween, 1, 1, {}},
                     {"c", 1, {0, 1, 0}, TemplateRole::kPlaced, 1, 1, {}},
                     {"d", 2, {0, 2, 0}, TemplateRole::kTip, 1, 1, {}},
                     {"e", 2, {0.5, 1.5, 0}, TemplateRole::kBetween, 1, 1, {}}};
  std::vector<Vec3> positions = {{0, 0, 0}, {9, 9, 9}, {2, 0, 0}, {4, 0, 0}, {9, 9, 9}};
  placeBetween(skeleton, positions);
  EXPECT_LT((positions[1] - Vec3(0.5, 0, 0)).norm(), 1e-9);
  EXPECT_LT((positions[4] - Vec3(3, -1, 0)).norm(), 1e-9);
}

}  // namespace limber
