#include "limber/skeleton/clip/moving_roots.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(MovingRoots, AreTheTopmostJointsThatMove) {
  Skeleton skeleton;
  for (const char* name : {"root", "hips", "leg", "prop"}) {
    Joint joint;
    joint.name = name;
    if (skeleton.jointCount() > 0) joint.parent = skeleton.jointCount() == 3 ? 0 : skeleton.jointCount() - 1;
    joint.rest.translation = {0, 1, 0};
    skeleton.joints.push_back(joint);
  }
  const Vec3f position(0, 2, 0);
  Clip clip;
  clip.translations.push_back({0, Interpolation::kLinear, {0, 1}, {position, position}});  // baked, and constant
  clip.translations.push_back({1, Interpolation::kLinear, {0, 1}, {position, Vec3f(0, 2, 1)}});
  clip.translations.push_back({2, Interpolation::kLinear, {0, 1}, {position, Vec3f(0, 2, 1)}});
  clip.translations.push_back({3, Interpolation::kLinear, {0}, {position}});
  const std::vector<MovingRoot> roots = movingRoots(skeleton, clip);
  ASSERT_EQ(roots.size(), 1u);
  EXPECT_EQ(roots[0].joint, 1u);
  EXPECT_EQ(roots[0].above.translation(), Vec3(0, 2, 0));

  const Vec3f zero = Vec3f::Zero(), speed(1, 0, 0);
  clip.translations[0] = {0, Interpolation::kCubic, {0, 1}, {zero, position, zero, zero, position, zero}};
  EXPECT_EQ(movingRoots(skeleton, clip)[0].joint, 1u);
  clip.translations[0].values[2] = speed;
  EXPECT_EQ(movingRoots(skeleton, clip)[0].joint, 0u);
  EXPECT_TRUE(movingRoots(skeleton, {}).empty());
}

}  // namespace
}  // namespace limber
