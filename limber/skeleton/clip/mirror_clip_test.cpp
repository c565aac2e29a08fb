#include "limber/skeleton/clip/mirror_clip.h"

#include <gtest/gtest.h>

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

const std::vector<std::array<const char*, 2>> kArms = {{"LeftArm", "RightArm"}, {"LeftHand", "RightHand"}};
const SkeletonMirror kMirror{{0, 1, 3, 2, 5, 4}, Vec3::UnitX()};

Clip randomClip(const Skeleton& skeleton, std::mt19937& random, Interpolation kind) {
  std::uniform_real_distribution<double> length(-1, 1);
  Clip clip;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Track<Eigen::Quaternionf> turns{j, kind, {0, 0.5f, 1}, {}};
    Track<Vec3f> moves{j, kind, {0, 0.5f, 1}, {}};
    for (int v = 0; v < (kind == Interpolation::kCubic ? 9 : 3); ++v) {
      turns.values.emplace_back(randomRotation(random).cast<float>());
      moves.values.emplace_back(Vec3(length(random), length(random), length(random)).cast<float>());
    }
    clip.rotations.push_back(turns);
    if (j % 2 == 0) clip.translations.push_back(moves);
  }
  return clip;
}

TEST(MirrorClip, ShowsEveryJointWhereAMirrorDoes) {
  std::mt19937 random(2);
  for (int round = 0; round < 60; ++round) {
    const Skeleton skeleton = symmetric(random, kArms);
    const Interpolation kinds[] = {Interpolation::kLinear, Interpolation::kStep, Interpolation::kCubic};
    const Clip clip = randomClip(skeleton, random, kinds[round % 3]);
    const Clip mirrored = mirrorClip(clip, skeleton, kMirror);
    EXPECT_NO_THROW(checkClip(mirrored, skeleton));
    for (const double seconds : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      Pose a = restPose(skeleton), b = restPose(skeleton);
      sampleClip(clip, seconds, a);
      sampleClip(mirrored, seconds, b);
      const std::vector<Affine> x = poseGlobals(skeleton, a), y = poseGlobals(skeleton, b);
      for (Index j = 0; j < skeleton.jointCount(); ++j) {
        Vec3 image = x[j].translation();
        image.x() = 2 * 0.3 - image.x();
        EXPECT_LT((image - y[kMirror.partner[j]].translation()).norm(), 1e-5) << round;
      }
    }
  }
}

TEST(MirrorClip, TwiceIsNothing) {
  std::mt19937 random(3);
  const Skeleton skeleton = symmetric(random, kArms);
  const Clip clip = randomClip(skeleton, random, Interpolation::kLinear);
  const Clip twice = mirrorClip(mirrorClip(clip, skeleton, kMirror), skeleton, kMirror);
  ASSERT_EQ(twice.rotations.size(), clip.rotations.size());
  for (std::size_t t = 0; t < clip.rotations.size(); ++t) {
    EXPECT_EQ(twice.rotations[t].joint, clip.rotations[t].joint);
    for (std::size_t v = 0; v < clip.rotations[t].values.size(); ++v) {
      EXPECT_TRUE(twice.rotations[t].values[v].coeffs().isApprox(clip.rotations[t].values[v].coeffs(), 1e-5f));
    }
  }
}

}  // namespace
}  // namespace limber
