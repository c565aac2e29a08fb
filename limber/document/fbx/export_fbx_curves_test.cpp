#include "limber/document/fbx/export_fbx_curves.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/document/fbx/export_fbx_angles.h"

namespace limber {
namespace {

Eigen::Quaternionf turnAbout(const Vec3& axis, double degrees) {
  return Eigen::Quaternionf(Quat(Eigen::AngleAxisd(degrees * kDegree, axis.normalized())).cast<float>());
}

// What a reader that goes straight between keys has.
Vec3 straight(const FbxKeys& keys, double time) {
  const auto after = std::upper_bound(keys.times.begin(), keys.times.end(), time);
  if (after == keys.times.begin()) return keys.values.front();
  if (after == keys.times.end()) return keys.values.back();
  const auto k = static_cast<std::size_t>(after - keys.times.begin());
  const double u = (time - keys.times[k - 1]) / (keys.times[k] - keys.times[k - 1]);
  return (1 - u) * keys.values[k - 1] + u * keys.values[k];
}

TEST(FbxKeys, LinearTracksHaveTheirOwnKeys) {
  const Track<Vec3f> track{0, Interpolation::kLinear, {0, 0.5f, 2}, {{0, 0, 0}, {1, 2, 3}, {1, 0, 0}}};
  const FbxKeys keys = fbxKeys(track);
  EXPECT_EQ(keys.times, (std::vector<double>{0, 0.5, 2}));
  EXPECT_FALSE(keys.isStepped);
}

TEST(FbxKeys, CubicTracksStayWithinTheTolerance) {
  const Track<Vec3f> track{
      0, Interpolation::kCubic, {0, 1}, {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}, {0, 3, 0}, {1, 1, 0}, {0, 0, 0}}};
  const FbxKeys keys = fbxKeys(track);
  for (double t = 0; t <= 1; t += 0.001) {
    EXPECT_LT((straight(keys, t) - sampleTrack(track, t)).norm(), 1.2 * kFbxTolerance * std::sqrt(2.0)) << t;
  }
}

TEST(FbxKeys, RotationsStayWithinTheTolerance) {
  Track<Eigen::Quaternionf> track;
  track.times = {0, 1, 2, 3};
  track.values = {turnAbout({1, 2, 0}, 0), turnAbout({1, 2, 0}, 170), turnAbout({0, 1, 0}, 90),
                  turnAbout({0.1, -1, 1}, 100)};
  const Quat turn(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const FbxKeys keys = fbxKeys(track, turn);
  for (double t = 0; t <= 3; t += 0.0007) {
    const Quat wanted = turn * sampleTrack(track, t);
    EXPECT_LT(eulerRotation(straight(keys, t)).angularDistance(wanted), 1.5 * kFbxAngleTolerance * kDegree) << t;
  }
}

TEST(FbxKeys, NoAngleChangesByMoreThanAQuarterTurn) {
  const Track<Eigen::Quaternionf> track{
      0, Interpolation::kLinear, {0, 1}, {turnAbout({0, 0, 1}, 0), turnAbout({0, 0, 1}, 180)}};
  const FbxKeys keys = fbxKeys(track, Quat::Identity());
  EXPECT_EQ(keys.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_NEAR(std::abs(keys.values[2].z()), 180, 1e-4);
}

TEST(FbxKeys, StepsHoldUntilTheirKey) {
  const Track<Vec3f> track{0, Interpolation::kStep, {0, 1}, {{0, 0, 0}, {1, 0, 0}}};
  const FbxKeys keys = fbxKeys(track);
  EXPECT_TRUE(keys.isStepped);
  ASSERT_EQ(keys.times.size(), 3u);
  EXPECT_LT(keys.times[1], 1);
  EXPECT_EQ(keys.values[1], Vec3(0, 0, 0));
}

}  // namespace
}  // namespace limber
