#include "limber/asset/bvh_axes.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// Hips with a head and two feet, as far from them as these offsets.
std::vector<BvhJoint> person(const Vec3& head, const Vec3& left, const Vec3& right) {
  std::vector<BvhJoint> joints(5);
  const char* names[] = {"Root", "Hips", "Head", "LeftFoot", "RightFoot"};
  const Vec3 offsets[] = {Vec3::Zero(), Vec3(0, 0, 0.9), head, left, right};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j].name = names[j];
    joints[j].offset = offsets[j];
    if (j > 0) joints[j].parent = j == 1 ? 0 : 1;
  }
  return joints;
}

TEST(BvhAxes, AHeadAboveTheFeetTells) {
  EXPECT_TRUE(standsAlongZ(person({0, 0.02, 0.6}, {0.1, 0, -0.8}, {-0.1, 0, -0.8})));
  EXPECT_FALSE(standsAlongZ(person({0, 0.6, 0.02}, {0.1, -0.8, 0}, {-0.1, -0.8, 0})));
}

// As programs write it that zero their joints' axes: the legs are longer than the trunk, to the same side of the hips.
TEST(BvhAxes, ARestPoseAlongOneAxisTellsNothing) {
  EXPECT_FALSE(standsAlongZ(person({0, 0, -0.6}, {0.1, 0, -0.8}, {-0.1, 0, -0.8})));
  EXPECT_FALSE(standsAlongZ(person({0, 0, 0.9}, {0.1, 0, 0.8}, {-0.1, 0, 0.8})));
  EXPECT_FALSE(standsAlongZ(person({0.6, 0, 0.1}, {0.8, 0, -0.1}, {0.8, 0, -0.1})));
}

}  // namespace
}  // namespace limber
