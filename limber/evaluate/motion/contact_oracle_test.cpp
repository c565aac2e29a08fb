#include "limber/evaluate/motion/contact_oracle.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limber {
namespace {

constexpr double kFrame = 1.0 / 60;

// Rests for 30 frames, swings for 20 at that speed (heights a second), rests for 30 more.
std::vector<Vec3> stepped(double speed) {
  std::vector<Vec3> path;
  Vec3 at = Vec3::Zero();
  for (int f = 0; f < 80; ++f) {
    if (f >= 30 && f < 50) at.z() += speed * kFrame;
    path.push_back(at);
  }
  return path;
}

std::size_t countOf(const std::vector<bool>& frames) {
  return static_cast<std::size_t>(std::count(frames.begin(), frames.end(), true));
}

TEST(ContactOracle, FindsWhereAPointStaysInASmallBox) {
  const std::vector<bool> rests = restingFrames(stepped(2), {}, std::vector<bool>(80), kFrame);
  for (int f = 0; f < 80; ++f) EXPECT_EQ(rests[f], f < 30 || f >= 49) << f;
}

TEST(ContactOracle, TremblingIsRest) {
  std::vector<Vec3> path(60, Vec3(Vec3::Zero()));
  for (int f = 0; f < 60; ++f) path[f].x() = f % 2 == 0 ? 0.002 : -0.002;  // 0.24 heights a second
  EXPECT_EQ(countOf(restingFrames(path, {}, std::vector<bool>(60), kFrame)), 60u);
}

TEST(ContactOracle, WhatIsLiftedDoesNotRest) {
  const std::vector<Vec3> path(60, Vec3(Vec3::Zero()));
  const std::vector<double> above(60, 0.1);
  EXPECT_EQ(countOf(restingFrames(path, above, std::vector<bool>(60), kFrame)), 0u);
}

TEST(ContactOracle, ACutPartsRests) {
  std::vector<Vec3> path(60, Vec3(Vec3::Zero()));
  std::vector<bool> cuts(60, false);
  cuts[3] = true;  // what is before it is too short to be a rest
  const std::vector<bool> rests = restingFrames(path, {}, cuts, kFrame);
  EXPECT_FALSE(rests[2]);
  EXPECT_TRUE(rests[3]);
}

TEST(ContactOracle, AgreementCountsBothWays) {
  std::vector<bool> meant(40, false), found(40, false);
  std::fill(meant.begin() + 10, meant.begin() + 20, true);
  std::fill(found.begin() + 12, found.begin() + 32, true);
  ContactAgreement agreement;
  agreement.count(meant, found, 0);
  EXPECT_DOUBLE_EQ(agreement.recall(), 0.8);
  EXPECT_DOUBLE_EQ(agreement.precision(), 0.4);
  agreement = {};
  agreement.count(meant, found, 2);
  EXPECT_DOUBLE_EQ(agreement.recall(), 1);
  EXPECT_DOUBLE_EQ(agreement.precision(), 0.5);
}

}  // namespace
}  // namespace limber
