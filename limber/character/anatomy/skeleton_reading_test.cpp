#include "limber/character/anatomy/skeleton_reading.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

Skeleton chain() {
  Skeleton skeleton;
  for (Index j = 0; j < 4; ++j) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = "joint" + std::to_string(j);
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = Vec3(0, 0.3, 0);
  }
  return skeleton;
}

TEST(SkeletonReading, IsReadOnce) {
  const SkeletonReading reading(chain());
  const SkeletonReading copy = reading;
  EXPECT_EQ(&reading.anatomy(), &copy.anatomy());
  EXPECT_EQ(reading.anatomy().parts.size(), readAnatomy(chain()).parts.size());
}

TEST(SkeletonReading, OfItsOwnSkeletonIsItself) {
  const SkeletonReading reading(chain());
  EXPECT_EQ(&reading.of(chain()).anatomy(), &reading.anatomy());
  Skeleton other = chain();
  other.joints[2].rest.translation.y() += 1e-15;
  const SkeletonReading ofOther = reading.of(other);
  EXPECT_NE(&ofOther.anatomy(), &reading.anatomy());
  EXPECT_TRUE(ofOther.isOf(other));
}

TEST(SkeletonReading, KnowsItsSkeletonToTheBit) {
  const SkeletonReading reading(chain());
  EXPECT_TRUE(reading.isOf(chain()));
  Skeleton other = chain();
  other.joints[2].rest.translation.y() += 1e-15;
  EXPECT_FALSE(reading.isOf(other)) << "moved";
  EXPECT_TRUE(reading.hasJointsOf(other)) << "moved";
  other = chain();
  other.joints[2].name = "head";
  EXPECT_FALSE(reading.isOf(other)) << "renamed";
  EXPECT_FALSE(reading.hasJointsOf(other)) << "renamed";
  other = chain();
  other.joints[3].parent = 1;
  EXPECT_FALSE(reading.isOf(other)) << "hung elsewhere";
  other = chain();
  other.joints.pop_back();
  EXPECT_FALSE(reading.isOf(other)) << "fewer";
}

}  // namespace
}  // namespace limber
