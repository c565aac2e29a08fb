// Tubes whose ends have bones or not.
#include "limber/evaluate/rig/bone_coverage.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

// Joints on the axis of the tube from -0.5 to 0.5 along x, 0.2 thick, at these positions.
SkinnedModel tubeWithJoints(const std::vector<double>& along, bool capped = true) {
  SkinnedModel model;
  model.mesh = limber::testing::tube(24, 101, capped);
  for (std::size_t i = 0; i < along.size(); ++i) {
    Joint joint;
    joint.name = "j" + std::to_string(i);
    if (i > 0) joint.parent = static_cast<Index>(i - 1);
    joint.rest.translation = Vec3(i > 0 ? along[i] - along[i - 1] : along[0], 0, 0);
    model.skeleton.joints.push_back(joint);
  }
  return model;
}

std::vector<bool> all(const SkinnedModel& model) {
  return std::vector<bool>(model.skeleton.jointCount(), true);
}

TEST(BoneCoverage, BonesAllAlongCoverAll) {
  const SkinnedModel model = tubeWithJoints({-0.45, 0, 0.3, 0.45});
  EXPECT_NEAR(*boneCoverage(model, all(model)), 1, 1e-9);
}

// A bone from a to b covers the sides as far as sqrt(0.2^2 - 0.1^2) beyond its ends. Bones may go on at leaves, so the
// reach is asked of the bones that there are.
TEST(BoneCoverage, ABoneCoversAsFarAsTheTubeIsThick) {
  const SkinnedModel model = tubeWithJoints({-0.5, -0.3}, false);
  double end = -0.5;
  for (const Bone& bone : bonesOf(model.skeleton)) end = std::max({end, bone.a.x(), bone.b.x()});
  const double reach = end + std::sqrt(0.2 * 0.2 - 0.1 * 0.1);
  ASSERT_LT(reach, 0.45);
  EXPECT_NEAR(*boneCoverage(model, all(model)), reach + 0.5, 0.015);
}

TEST(BoneCoverage, BonesOfJointsThatDoNotCountCoverNothing) {
  const SkinnedModel model = tubeWithJoints({-0.45, -0.2, 0.1, 0.45});
  const double part = *boneCoverage(model, {true, true, false, false});
  EXPECT_LT(part, 0.9);
  EXPECT_GT(part, 0.2);
  EXPECT_FALSE(boneCoverage(model, {false, false, false, false}));
}

TEST(BoneCoverage, ASheetHasNoThickness) {
  SkinnedModel model = tubeWithJoints({-0.4, 0.4});
  model.mesh = limber::testing::flatGrid(4, 4);
  EXPECT_FALSE(boneCoverage(model, all(model)));
}

class BoneCoverageOverTheCatalogue : public ::testing::TestWithParam<limber::testing::NamedMesh> {};

TEST_P(BoneCoverageOverTheCatalogue, IsAShareAndGrowsWithBones) {
  SkinnedModel model = tubeWithJoints({-0.4, -0.2, 0.4});
  model.mesh = GetParam().mesh;
  const std::optional<double> whole = boneCoverage(model, all(model)), one = boneCoverage(model, {true, false, false});
  ASSERT_EQ(whole.has_value(), one.has_value());
  if (!whole) return;
  EXPECT_GE(*one, 0);
  EXPECT_LE(*one, *whole);
  EXPECT_LE(*whole, 1 + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, BoneCoverageOverTheCatalogue, ::testing::ValuesIn(limber::testing::catalogue()),
                         limber::testing::MeshName());

}  // namespace
}  // namespace limber
