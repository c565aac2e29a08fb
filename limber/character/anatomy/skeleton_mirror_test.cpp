#include "limber/character/anatomy/skeleton_mirror.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "random_values.h"

namespace limber {
namespace {

using testing::randomRotation;

// A symmetric tree (about X = 0.3) whose joints have axes of their own on each side, as rigs do. `names` gives the two
// sides' names of a joint.
Skeleton symmetric(std::mt19937& random, const std::vector<std::array<const char*, 2>>& names) {
  std::uniform_real_distribution<double> length(0.1, 1);
  Skeleton skeleton;
  std::vector<Affine> globals;
  const auto add = [&](std::string name, std::optional<Index> parent, const Vec3& position) {
    Affine global = Affine::Identity();
    global.linear() = randomRotation(random).toRotationMatrix();
    global.translation() = position;
    Joint joint;
    joint.name = std::move(name);
    joint.parent = parent;
    joint.rest = decompose(parent ? globals[*parent].inverse() * global : global);
    globals.push_back(global);
    skeleton.joints.push_back(joint);
    return skeleton.jointCount() - 1;
  };
  const double middle = 0.3;
  const Index root = add("hips", std::nullopt, {middle, 1, 0});
  const Index chest = add("chest", root, {middle, 2, 0.1});
  std::array<Index, 2> ends = {chest, chest};
  for (const auto& pair : names) {
    const Vec3 offset(length(random), length(random), length(random));
    const Vec3 left(middle + offset.x(), 2 + offset.y(), offset.z());
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 position(side == 0 ? left.x() : 2 * middle - left.x(), left.y(), left.z());
      ends[side] = add(pair[side], ends[side], position);
    }
  }
  return skeleton;
}

const std::vector<std::vector<std::array<const char*, 2>>> kHabits = {
    {{"LeftArm", "RightArm"}, {"LeftHand", "RightHand"}},
    {{"arm.L", "arm.R"}, {"hand.L.001", "hand.R.001"}},
    {{"lArm", "rArm"}, {"lHand", "rHand"}},
    {{"Bip01 L Arm", "Bip01 R Arm"}, {"ArmL", "ArmR"}},
    {{"upper_l", "upper_r"}, {"l_lower", "r_lower"}},
    {{"joint1", "joint2"}, {"joint3", "joint4"}}};

TEST(SkeletonMirror, FindsPartnersByNamesAndByPlaces) {
  std::mt19937 random(1);
  for (const auto& names : kHabits) {
    for (int round = 0; round < 20; ++round) {
      const SkeletonMirror mirror = mirrorOf(symmetric(random, names));
      EXPECT_EQ(mirror.partner, (std::vector<Index>{0, 1, 3, 2, 5, 4})) << names[0][0];
      EXPECT_EQ(mirror.normal.cwiseAbs(), Vec3::UnitX()) << names[0][0];
    }
  }
}

TEST(SkeletonMirror, LeavesAChainWithoutSidesInTheMiddle) {
  Skeleton skeleton;
  for (Index j = 0; j < 4; ++j) {
    Joint joint;
    joint.name = "tail" + std::to_string(j);
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = Vec3(0, 0, -1);
    skeleton.joints.push_back(joint);
  }
  EXPECT_EQ(mirrorOf(skeleton).partner, (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_TRUE(mirrorOf({}).partner.empty());
}

}  // namespace
}  // namespace limber
