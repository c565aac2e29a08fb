#include "limber/skeleton/clip/join_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "limber/core/error.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kRate = 60, kSeconds = 1.5;

// hips - knee - foot
Skeleton leg() {
  Skeleton skeleton;
  for (const char* name : {"hips", "knee", "foot"}) {
    Joint joint;
    joint.name = name;
    if (skeleton.jointCount() > 0) joint.parent = skeleton.jointCount() - 1;
    joint.rest.translation = skeleton.jointCount() == 0 ? Vec3(0, 1, 0) : Vec3(0, -0.5, 0);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

// Steps that end a little off where they began, in pose and in speed, of somebody who walks and turns by `turn`.
Clip steps(double turn) {
  Clip clip;
  Track<Vec3f> positions{0, Interpolation::kLinear, {}, {}};
  Track<Eigen::Quaternionf> turns{0, Interpolation::kLinear, {}, {}}, bends{1, Interpolation::kLinear, {}, {}};
  for (int k = 0; k <= kSeconds * kRate; ++k) {
    const double time = k / kRate, u = time / kSeconds;
    const Quat heading(Eigen::AngleAxisd(turn * u, Vec3::UnitY()));
    const double swing = 0.5 * std::sin(kFullTurn * u) + 0.04 * u * u;
    positions.times.push_back(static_cast<float>(time));
    const Vec3 at = turn == 0 ? Vec3(0, 1, 1.2 * time) : Vec3(heading * Vec3(-3, 1, 0));
    positions.values.emplace_back((at + Vec3(0, 0.02 * std::cos(kFullTurn * u) + 0.01 * u, 0)).cast<float>());
    turns.values.emplace_back((heading * Quat(Eigen::AngleAxisd(0.2 * swing, Vec3::UnitX()))).cast<float>());
    bends.values.emplace_back(Quat(Eigen::AngleAxisd(0.6 + swing, Vec3::UnitX())).cast<float>());
  }
  turns.times = bends.times = positions.times;
  clip.translations = {positions};
  clip.rotations = {turns, bends};
  return clip;
}

std::vector<Vec3> at(const Skeleton& skeleton, const Clip& clip, double time) {
  Pose pose = restPose(skeleton);
  sampleClip(clip, time, pose);
  return posePositions(skeleton, pose);
}

// By how much the knee's speed jumps where the clip begins again, radians a second.
double kink(const Clip& clip) {
  const std::vector<Eigen::Quaternionf>& bends = clip.rotations[1].values;
  const auto angle = [&](std::size_t k) { return 2 * std::atan2(double{bends[k].x()}, double{bends[k].w()}); };
  const std::size_t last = bends.size() - 1;
  return std::abs((angle(1) - angle(0)) - (angle(last) - angle(last - 1))) * kRate;
}

TEST(JoinLoop, EndsAsItBegins) {
  const Skeleton skeleton = leg();
  for (const double turn : {0.0, 0.7, -2.0}) {
    const Clip clip = steps(turn);
    const JoinedLoop joined = joinLoop(skeleton, clip, 0);
    checkClip(joined.clip, skeleton);
    EXPECT_FLOAT_EQ(joined.clip.duration(), clip.duration());
    // The knee by itself, bit for bit.
    const Track<Eigen::Quaternionf>& bends = joined.clip.rotations[1];
    ASSERT_EQ(bends.joint, 1u);
    EXPECT_EQ(bends.values.front().coeffs(), bends.values.back().coeffs());
    // The whole body: the rotation and the displacement over the ground take it there, its height is the same.
    const Affine turned(Eigen::AngleAxisd(turn, Vec3::UnitY()));
    const auto begin = at(skeleton, joined.clip, 0), end = at(skeleton, joined.clip, kSeconds);
    for (std::size_t j = 1; j < begin.size(); ++j) {
      EXPECT_LT((turned * (begin[j] - begin[0]) - (end[j] - end[0])).norm(), 2e-6) << turn;
    }
    EXPECT_NEAR(begin[0].y(), end[0].y(), 1e-6);
    // As far as before.
    const Vec3 displacement = end[0] - begin[0],
               displacementBefore = at(skeleton, clip, kSeconds)[0] - at(skeleton, clip, 0)[0];
    EXPECT_LT((displacement - displacementBefore - Vec3(0, displacement.y() - displacementBefore.y(), 0)).norm(), 0.01);
    // Little was changed for it, and the seam has no kink: 0.053 radians a second before.
    EXPECT_GT(joined.gap, 0.005);
    EXPECT_LT(joined.largestChange, joined.gap);
    EXPECT_NEAR(kink(clip), 0.053, 0.001);
    EXPECT_LT(kink(joined.clip), 0.01);
  }
}

TEST(JoinLoop, ALoopStaysWhatItIs) {
  const Skeleton skeleton = leg();
  Clip clip = steps(0);
  const JoinedLoop once = joinLoop(skeleton, clip, 0), twice = joinLoop(skeleton, once.clip, 0);
  EXPECT_GT(once.gap, 1e-3);
  EXPECT_LT(twice.gap, 1e-6);
  EXPECT_EQ(twice.largestChange, 0);
  EXPECT_EQ(twice.clip.rotations[1].values.size(), once.clip.rotations[1].values.size());
}

TEST(JoinLoop, WhatStandsAboveTheBodyStays) {
  Skeleton skeleton = leg();
  skeleton.joints.insert(skeleton.joints.begin(), Joint{"root", std::nullopt, {}, 0});
  skeleton.joints[0].rest.rotation = Quat(Eigen::AngleAxisd(-1.5, Vec3::UnitX()));
  for (Index j = 1; j < 4; ++j) skeleton.joints[j].parent = j - 1;
  const Affine up = skeleton.joints[0].rest.toAffine().inverse(Eigen::Isometry);
  Clip clip = steps(0.7);
  for (auto& track : clip.rotations) ++track.joint;
  clip.translations[0].joint = 1;
  for (Vec3f& position : clip.translations[0].values) position = (up * position.cast<double>()).cast<float>();
  for (auto& turn : clip.rotations[0].values) turn = (Quat(up.linear()) * turn.cast<double>()).cast<float>();
  const JoinedLoop joined = joinLoop(skeleton, clip, 1), plain = joinLoop(leg(), steps(0.7), 0);
  EXPECT_NEAR(joined.gap, plain.gap, 1e-5);
  for (double time = 0; time <= kSeconds; time += 0.1) {
    const auto with = at(skeleton, joined.clip, time), without = at(leg(), plain.clip, time);
    for (Index j = 0; j < 3; ++j) EXPECT_LT((with[j + 1] - without[j]).norm(), 1e-5);
  }
}

TEST(JoinLoop, TheSeamIsSmoothWhereTheClipEndsBetweenTwoFrames) {
  // As sampled 24 times a second and cut.
  const Clip clip = trimClip(resampleClip(steps(0), 24), 0, 1.41);
  const JoinedLoop joined = joinLoop(leg(), clip, 0);
  EXPECT_FLOAT_EQ(joined.clip.duration(), 1.41f);
  const std::vector<float>& times = joined.clip.rotations[1].times;
  for (std::size_t k = 1; k < times.size(); ++k) EXPECT_NEAR(times[k] - times[k - 1], 1.41 / 34, 1e-5);
  EXPECT_LT(kink(joined.clip), 0.5 * kink(clip));
}

TEST(JoinLoop, KeysFarApartGetFramesBetween) {
  Clip clip = resampleClip(steps(0), 4);
  EXPECT_GE(joinLoop(leg(), clip, 0).clip.rotations[1].times.size(), 45u);
  clip = trimClip(clip, 0, 0.25);
  EXPECT_EQ(joinLoop(leg(), clip, 0).clip.rotations[1].times.size(), 2u);
}

TEST(JoinLoop, ShortClipsStay) {
  const Skeleton skeleton = leg();
  Clip pose;
  pose.translations.push_back({0, Interpolation::kLinear, {0}, {Vec3f(0, 1, 0)}});
  EXPECT_EQ(joinLoop(skeleton, pose, 0).clip.translations[0].values.size(), 1u);
  EXPECT_THROW(joinLoop(skeleton, pose, 3), Error);
}

}  // namespace
}  // namespace limber
