#include "limber/skeleton/clip/clip_player.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

// Ten joints in a forked tree; tracks of all kinds with keys at uneven times, large turns, some joints without.
Skeleton tree() {
  Skeleton skeleton;
  for (Index j = 0; j < 10; ++j) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name.assign(1, static_cast<char>('a' + j));
    if (j > 0 && j != 7) joint.parent = j / 2;
    joint.rest.translation = Vec3(0.1 * j, 0.3, -0.1);
  }
  return skeleton;
}

Clip wild() {
  Clip clip;
  for (Index j = 0; j < 10; j += 2) {
    Track<Eigen::Quaternionf> turns{j, j == 4 ? Interpolation::kStep : Interpolation::kLinear, {}, {}};
    Track<Vec3f> moves{j, j == 6 ? Interpolation::kCubic : Interpolation::kLinear, {}, {}};
    for (int k = 0; k < 8; ++k) {
      turns.times.push_back(0.1f + 0.3f * static_cast<float>(k) + 0.01f * static_cast<float>(j));
      moves.times.push_back(0.25f * static_cast<float>(k));
      const auto wave = [&](double f) { return static_cast<float>(std::sin(f * k + j + 1)); };
      turns.values.push_back(Eigen::Quaternionf(wave(1.1), wave(2.3), wave(3.1), wave(0.7)).normalized());
      for (int repeat = 0; repeat < (j == 6 ? 3 : 1); ++repeat) {
        moves.values.push_back(Vec3f(wave(1.7), wave(0.9), wave(2.9 + repeat)));
      }
    }
    clip.rotations.push_back(turns);
    clip.translations.push_back(moves);
  }
  clip.scales.push_back({2, Interpolation::kLinear, {0.5f, 1.5f}, {Vec3f(1, 1, 1), Vec3f(2, 0.5f, 1)}});
  return clip;
}

TEST(ClipPlayer, PlaysWhatTheClipSays) {
  const Skeleton skeleton = tree();
  const Clip clip = wild();
  ClipPlayer player(clip, skeleton);
  std::vector<Eigen::Matrix4f> globals(10);
  for (int i = 0; i < 4000; ++i) {
    const double seconds = i < 2000 ? -0.2 + 0.0015 * i : std::fmod(1.7 * i, 3.0);  // forward, then anyhow
    player.sample(seconds, globals);
    Pose pose = restPose(skeleton);
    sampleClip(clip, seconds, pose);
    const std::vector<Affine> exact = poseGlobals(skeleton, pose);
    for (Index j = 0; j < 10; ++j) {
      EXPECT_LT((globals[j].cast<double>() - exact[j].matrix()).cwiseAbs().maxCoeff(), 5e-5) << seconds << " " << j;
    }
  }
}

// As recorded motion is: every joint at the same times, a few of them with no track, one with a single key, wide turns.
Clip recorded() {
  Clip clip;
  for (Index j = 0; j < 10; ++j) {
    if (j == 3) continue;
    Track<Eigen::Quaternionf> turns{j, Interpolation::kLinear, {}, {}};
    Track<Vec3f> moves{j, Interpolation::kLinear, {}, {}};
    for (int k = 0; k < (j == 5 ? 1 : 40); ++k) {
      turns.times.push_back(0.2f + static_cast<float>(k) / 30);
      const double angle = (j == 8 ? 3.0 : 0.4) * std::sin(0.9 * k + j);
      turns.values.push_back(Eigen::Quaternionf(
          Eigen::AngleAxisf(static_cast<float>(angle), Vec3f(1, static_cast<float>(j), -1).normalized())));
      if (k % 3 == 1) turns.values.back().coeffs() *= -1;
      moves.values.push_back(Vec3f(static_cast<float>(angle), 0.5f, 0.1f * static_cast<float>(k)));
    }
    moves.times = turns.times;
    clip.rotations.push_back(turns);
    if (j % 2 == 0) clip.translations.push_back(moves);
  }
  return clip;
}

TEST(ClipPlayer, PlaysRecordedMotion) {
  const Skeleton skeleton = tree();
  const Clip clip = recorded();
  ClipPlayer player(clip, skeleton);
  std::vector<Eigen::Matrix4f> globals(10);
  for (int i = 0; i < 3000; ++i) {
    const double seconds = i < 2000 ? -0.2 + 0.001 * i : std::fmod(1.7 * i, 2.0);
    player.sample(seconds, globals);
    Pose pose = restPose(skeleton);
    sampleClip(clip, seconds, pose);
    const std::vector<Affine> exact = poseGlobals(skeleton, pose);
    for (Index j = 0; j < 10; ++j) {
      EXPECT_LT((globals[j].cast<double>() - exact[j].matrix()).cwiseAbs().maxCoeff(), 5e-5) << seconds << " " << j;
    }
  }
}

TEST(ClipPlayer, ExactlyAtAStepTheNewValueHolds) {
  Skeleton skeleton;
  skeleton.joints.resize(1);
  skeleton.joints[0].name = "root";
  Clip clip;
  clip.translations.push_back({0, Interpolation::kStep, {0, 1, 2}, {Vec3f(1, 0, 0), Vec3f(2, 0, 0), Vec3f(3, 0, 0)}});
  ClipPlayer player(clip, skeleton);
  std::vector<Eigen::Matrix4f> globals(1);
  for (const auto& [seconds, x] :
       {std::pair{0.0, 1.0f}, {0.999, 1.0f}, {1.0, 2.0f}, {1.5, 2.0f}, {2.0, 3.0f}, {9.0, 3.0f}}) {
    player.sample(seconds, globals);
    EXPECT_EQ(globals[0](0, 3), x) << seconds;
    EXPECT_EQ(globals[0](3, 3), 1.0f);
  }
  globals.resize(2);
  EXPECT_THROW(player.sample(0, globals), Error);
}

}  // namespace
}  // namespace limber
