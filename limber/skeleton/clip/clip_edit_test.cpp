#include "limber/skeleton/clip/clip_edit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "limber/core/error.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::randomRotation;

Skeleton chain(Index count) {
  Skeleton skeleton;
  for (Index j = 0; j < count; ++j) {
    Joint joint;
    joint.name = "joint" + std::to_string(j);
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = Vec3(0, 1, 0);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

// Keys at 0, 0.1, ... 1. Turns between keys are small enough that a cubic quaternion does not pass near zero.
Clip randomClip(const Skeleton& skeleton, unsigned seed, Interpolation kind) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> length(-1, 1);
  Clip clip;
  clip.name = "made";
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Track<Eigen::Quaternionf> turns{j, kind, {}, {}};
    Track<Vec3f> moves{j, kind, {}, {}};
    for (int k = 0; k <= 10; ++k) {
      moves.times.push_back(0.1f * static_cast<float>(k));
      for (int v = 0; v < (kind == Interpolation::kCubic ? 3 : 1); ++v) {
        turns.values.emplace_back(Quat::Identity().slerp(0.3, randomRotation(random)).cast<float>());
        moves.values.emplace_back(length(random), length(random), length(random));
      }
    }
    turns.times = moves.times;
    clip.rotations.push_back(turns);
    clip.translations.push_back(moves);
    clip.scales.push_back({j, Interpolation::kLinear, {0}, {Vec3f::Ones()}});
  }
  return clip;
}

double difference(const Skeleton& skeleton, const Clip& a, double secondsA, const Clip& b, double secondsB) {
  Pose x = restPose(skeleton), y = restPose(skeleton);
  sampleClip(a, secondsA, x);
  sampleClip(b, secondsB, y);
  double largest = 0;
  for (std::size_t j = 0; j < x.locals.size(); ++j) {
    largest =
        std::max(largest, (x.locals[j].toAffine().matrix() - y.locals[j].toAffine().matrix()).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(ClipEdit, ResamplingKeepsTheFrames) {
  const Skeleton skeleton = chain(4);
  for (const Interpolation kind : {Interpolation::kLinear, Interpolation::kStep, Interpolation::kCubic}) {
    const Clip clip = randomClip(skeleton, 1, kind);
    for (const double rate : {7.0, 10.0, 24.0, 60.0}) {
      const Clip sampled = resampleClip(clip, rate);
      EXPECT_NO_THROW(checkClip(sampled, skeleton));
      EXPECT_EQ(sampled.name, "made");
      EXPECT_FLOAT_EQ(static_cast<float>(sampled.duration()), 1);
      for (int k = 0; k / rate < 1; ++k) {
        const double time = static_cast<float>(k / rate);  // a key's own time
        EXPECT_LT(difference(skeleton, clip, time, sampled, time), 1e-5) << rate << " frame " << k;
      }
      for (const auto& track : sampled.scales) EXPECT_EQ(track.times.size(), 1u);
    }
  }
}

// Frame times of 0.033333 s: the last key lies a little before the frame that it is.
TEST(ClipEdit, ResamplingEndsAtAFrame) {
  Clip clip;
  Track<Vec3f> track{0, Interpolation::kLinear, {}, {}};
  for (int k = 0; k <= 30; ++k) {
    track.times.push_back(static_cast<float>(k * 0.033333));
    track.values.emplace_back(static_cast<float>(k), 0, 0);
  }
  clip.translations.push_back(track);
  const Track<Vec3f> sampled = resampleClip(clip, 30).translations.at(0);
  ASSERT_EQ(sampled.times.size(), 31u);
  EXPECT_EQ(sampled.times.back(), 1);
  EXPECT_EQ(sampled.values.back().x(), 30);
}

TEST(ClipEdit, ResamplingALinearClipAtItsOwnRateChangesNothing) {
  const Skeleton skeleton = chain(3);
  const Clip clip = randomClip(skeleton, 2, Interpolation::kLinear), sampled = resampleClip(clip, 10);
  for (double time = 0; time <= 1; time += 0.01) {
    EXPECT_LT(difference(skeleton, clip, time, sampled, time), 1e-4);
  }
}

TEST(ClipEdit, TrimmingKeepsTheMovementBetween) {
  const Skeleton skeleton = chain(4);
  for (const Interpolation kind : {Interpolation::kLinear, Interpolation::kStep, Interpolation::kCubic}) {
    const Clip clip = randomClip(skeleton, 3, kind);
    for (const auto& [from, to] :
         {std::pair{0.0, 1.0}, {0.25, 0.77}, {0.2, 0.6}, {-3.0, 0.05}, {0.95, 9.0}, {0.31, 0.33}}) {
      const Clip part = trimClip(clip, from, to);
      EXPECT_NO_THROW(checkClip(part, skeleton));
      const double begin = std::max(0.0, from), end = std::min(1.0, to);
      EXPECT_NEAR(part.duration(), end - begin, 1e-6);
      // Cubic rotations that are cut inside a span are cut into lines.
      const double tolerance = kind == Interpolation::kCubic ? 1e-2 : 1e-4;
      for (double u = 0.013; u < 1; u += 0.05) {
        const double time = u * (end - begin);
        EXPECT_LT(difference(skeleton, clip, begin + time, part, time), tolerance)
            << from << " " << to << " at " << time;
      }
    }
  }
}

TEST(ClipEdit, TrimmingKeepsCubicTranslationsExactly) {
  const Skeleton skeleton = chain(2);
  Clip clip = randomClip(skeleton, 4, Interpolation::kCubic);
  clip.rotations.clear();
  const Clip part = trimClip(clip, 0.234, 0.871);
  EXPECT_EQ(part.translations[0].interpolation, Interpolation::kCubic);
  for (double time = 0.001; time < 0.63; time += 0.01) {
    EXPECT_LT(difference(skeleton, clip, 0.234 + time, part, time), 1e-5);
  }
}

TEST(ClipEdit, TrimmingNothingIsAnError) {
  const Clip clip = randomClip(chain(1), 5, Interpolation::kLinear);
  EXPECT_THROW(trimClip(clip, 0.5, 0.5), Error);
  EXPECT_THROW(trimClip(clip, 0.8, 0.2), Error);
  EXPECT_THROW(trimClip(clip, 2, 3), Error);
  EXPECT_THROW(trimClip(clip, std::nan(""), 1), Error);
}

TEST(ClipEdit, APoseIsTrimmedToItself) {
  Clip pose;
  pose.translations.push_back({0, Interpolation::kLinear, {0.0f}, {Vec3f(1, 2, 3)}});
  const Clip trimmed = trimClip(pose, 0, 4);
  ASSERT_EQ(trimmed.translations.size(), 1u);
  EXPECT_EQ(trimmed.translations[0].values.front(), Vec3f(1, 2, 3));
  EXPECT_THROW(trimClip(pose, 1, 4), Error);
}

TEST(ClipEdit, TurningTakesAllJointsAlong) {
  Skeleton skeleton = chain(3);
  skeleton.joints[2].parent.reset();  // a root that the clip leaves alone
  const Quat turn(0.5, 0.5, -0.5, 0.5);
  for (const Interpolation kind : {Interpolation::kLinear, Interpolation::kCubic}) {
    const Clip clip = randomClip(chain(2), 5, kind), turned = turnClip(clip, skeleton, turn);
    checkClip(turned, skeleton);
    for (const double seconds : {0.0, 0.13, 0.97}) {
      Pose pose = restPose(skeleton), after = pose;
      sampleClip(clip, seconds, pose);
      sampleClip(turned, seconds, after);
      const std::vector<Affine> was = poseGlobals(skeleton, pose), is = poseGlobals(skeleton, after);
      for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_TRUE(is[j].isApprox(turn * was[j], 1e-5)) << j;
    }
  }
}

// A pendulum that swings twice a second, on a root that walks away and turns.
Clip swinging(double seconds) {
  Clip clip;
  Track<Eigen::Quaternionf> root{0, Interpolation::kLinear, {}, {}}, swing{1, Interpolation::kLinear, {}, {}};
  Track<Vec3f> walk{0, Interpolation::kLinear, {}, {}};
  for (int k = 0; k <= static_cast<int>(seconds * 60); ++k) {
    const double time = k / 60.0;
    root.times.push_back(static_cast<float>(time));
    root.values.emplace_back(Eigen::AngleAxisf(static_cast<float>(time), Vec3f::UnitY()));
    walk.values.emplace_back(static_cast<float>(time), 1.0f, static_cast<float>(2 * time));
    swing.values.emplace_back(
        Eigen::AngleAxisf(static_cast<float>(std::sin(4 * 3.14159265358979 * time)), Vec3f::UnitX()));
  }
  swing.times = walk.times = root.times;
  clip.rotations = {root, swing};
  clip.translations = {walk};
  return clip;
}

TEST(ClipEdit, FindsAPeriodWhateverTheRootDoes) {
  const Skeleton skeleton = chain(3);
  const std::optional<ClipLoop> loop = findLoop(skeleton, swinging(2.2));
  ASSERT_TRUE(loop);
  const double periods = (loop->end - loop->begin) / 0.5;
  EXPECT_NEAR(periods, std::round(periods), 0.07);
  EXPECT_GE(std::round(periods), 1);
  EXPECT_LT(loop->error, 0.01);
}

TEST(ClipEdit, FindsAPeriodBelowARootThatStaysBehind) {
  Clip clip = swinging(2.2);
  for (auto& track : clip.rotations) ++track.joint;
  ++clip.translations[0].joint;
  LoopOptions options;
  options.body = 1;
  const std::optional<ClipLoop> loop = findLoop(chain(4), clip, options);
  ASSERT_TRUE(loop);
  EXPECT_LT(loop->error, 0.01);
}

TEST(ClipEdit, FindsNoLoopWhereNothingRepeatsOrMoves) {
  const Skeleton skeleton = chain(3);
  LoopOptions strict;
  strict.largestError = 0.01;
  Clip rising;
  rising.rotations.push_back(
      {1,
       Interpolation::kLinear,
       {0, 2},
       {Eigen::Quaternionf::Identity(), Eigen::Quaternionf(Eigen::AngleAxisf(2, Vec3f::UnitX()))}});
  EXPECT_FALSE(findLoop(skeleton, rising, strict));
  EXPECT_FALSE(findLoop(skeleton, {}));
  Clip still;
  still.rotations.push_back(
      {1, Interpolation::kLinear, {0, 2}, {Eigen::Quaternionf::Identity(), Eigen::Quaternionf::Identity()}});
  EXPECT_FALSE(findLoop(skeleton, still));
  EXPECT_FALSE(findLoop({}, swinging(1)));
}

}  // namespace
}  // namespace limber
