#include "limber/skeleton/clip/tracks.h"

#include <cmath>

#include <gmock/gmock.h>

namespace limber {
namespace {

using ::testing::ElementsAre;

TEST(Tracks, EachIsVisitedByKind) {
  Clip clip;
  clip.scales.push_back({4, Interpolation::kLinear, {0}, {Vec3f::Ones()}});
  clip.rotations.push_back({3, Interpolation::kLinear, {0}, {Eigen::Quaternionf::Identity()}});
  clip.translations.push_back({2, Interpolation::kLinear, {0}, {Vec3f::Zero()}});
  clip.translations.push_back({1, Interpolation::kLinear, {0}, {Vec3f::Zero()}});
  std::vector<Index> joints;
  forEachTrack(clip, [&](const auto& track) { joints.push_back(track.joint); });
  EXPECT_THAT(joints, ElementsAre(2, 1, 3, 4));
  EXPECT_EQ(findTrack(clip.translations, 1), &clip.translations[1]);
  EXPECT_EQ(findTrack(clip.rotations, 1), nullptr);
}

TEST(Tracks, AJointWithoutOneGetsItsRestPose) {
  std::vector<Track<Vec3f>> tracks = {{5, Interpolation::kStep, {0, 1}, {Vec3f::Zero(), Vec3f::Ones()}}};
  EXPECT_EQ(trackOf(tracks, 5, Vec3f(1, 2, 3)).values.size(), 2u);
  EXPECT_THAT(trackOf(tracks, 6, Vec3f(1, 2, 3)).values, ElementsAre(Vec3f(1, 2, 3)));
  EXPECT_EQ(tracks.size(), 2u);
}

TEST(Tracks, ConstantAreValuesThatNeitherChangeNorSwing) {
  Track<Vec3f> track{0, Interpolation::kLinear, {0, 1}, {Vec3f::Ones(), Vec3f::Ones()}};
  EXPECT_TRUE(isConstant(track));
  track.values[1].x() = std::nextafter(1.0f, 2.0f);
  EXPECT_FALSE(isConstant(track));
  Track<Vec3f> curve{0, Interpolation::kCubic, {0}, {Vec3f::Zero(), Vec3f::Ones(), Vec3f::Zero()}};
  EXPECT_TRUE(isConstant(curve));
  curve.values[2].y() = 1;
  EXPECT_FALSE(isConstant(curve));
}

TEST(Tracks, RotationsTakeTheSideOfTheOneBefore) {
  const Eigen::Quaternionf turn(0.6f, 0.8f, 0, 0), other(-0.6f, -0.8f, 0, 0);
  std::vector<Eigen::Quaternionf> values = {turn, other, other, turn};
  keepNearSide(values);
  for (const Eigen::Quaternionf& value : values) EXPECT_EQ(value.coeffs(), turn.coeffs());
}

}  // namespace
}  // namespace limber
