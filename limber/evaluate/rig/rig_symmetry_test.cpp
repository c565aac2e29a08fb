// A symmetric body with joints that are so, or not.
#include "limber/evaluate/rig/rig_symmetry.h"

#include <string>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

// An ellipsoid, twice as long in x (from -1 to 1) as in y, and joints at these positions.
SkinnedModel ellipsoid(const std::vector<Vec3>& positions) {
  SkinnedModel model;
  model.mesh = limber::testing::moved(limber::testing::icosphere(3), {1, 0.5f, 0.7f}, Vec3f::Zero());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.rest.translation = positions[i];
    model.skeleton.joints.push_back(joint);
  }
  return model;
}

TEST(JointAsymmetry, IsNothingWhereEachJointHasATwinOrLiesInThePlane) {
  EXPECT_NEAR(*jointAsymmetry(ellipsoid({{0, 0.1, 0.2}, {0.5, 0, 0.1}, {-0.5, 0, 0.1}}), {true, true, true}), 0, 1e-4);
}

// One of the twins 0.1 off, of 2: the image of either is 0.1 from the other, 5 % of the longest side.
TEST(JointAsymmetry, IsTheDistanceFromTheTwin) {
  EXPECT_NEAR(*jointAsymmetry(ellipsoid({{0.5, 0, 0.1}, {-0.5, 0.1, 0.1}}), {true, true}), 5, 1e-3);
  // In the plane x = 0 the image is the joint itself; 0.2 off it is 0.4 away: 20 %, a third of the joints.
  EXPECT_NEAR(*jointAsymmetry(ellipsoid({{0.2, 0, 0}, {0.9, 0, 0}, {-0.9, 0, 0}}), {true, true, true}), 20.0 / 3, 1e-3);
}

TEST(JointAsymmetry, OnlyJointsThatCountDo) {
  const SkinnedModel model = ellipsoid({{0.5, 0, 0.1}, {-0.5, 0, 0.1}, {0.3, 0.2, 0}});
  EXPECT_GT(*jointAsymmetry(model, {true, true, true}), 1);
  EXPECT_NEAR(*jointAsymmetry(model, {true, true, false}), 0, 1e-4);
  EXPECT_FALSE(jointAsymmetry(model, {false, false, false}));
}

TEST(JointAsymmetry, ABodyWithoutAPlaneHasNone) {
  SkinnedModel model = ellipsoid({{0, 0, 0}});
  model.mesh = limber::testing::soup(40, 120, 3);
  EXPECT_FALSE(jointAsymmetry(model, {true}));
}

}  // namespace
}  // namespace limber
