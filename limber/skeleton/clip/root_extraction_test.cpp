// Root motion against what the movement was made of: travel and sway are added by formulas and taken apart again.
#include "limber/skeleton/clip/root_extraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "limber/core/error.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

constexpr double kTurn = 2 * std::numbers::pi;

// root? - hips at 1 m - chest - head; one leg.
Skeleton walker(bool withRoot) {
  Skeleton skeleton;
  const auto add = [&](const char* name, std::optional<Index> parent, const Vec3& at) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.rest.translation = at;
    skeleton.joints.push_back(joint);
    return skeleton.jointCount() - 1;
  };
  std::optional<Index> above;
  if (withRoot) above = add("root", std::nullopt, Vec3::Zero());
  const Index hips = add("hips", above, {0, 1, 0.05});
  const Index chest = add("chest", hips, {0, 0.4, 0});
  add("head", chest, {0, 0.3, 0});
  add("foot", hips, {0.1, -0.95, 0});
  return skeleton;
}

// Linear keys 30 times a second.
Clip walk(Index hips, double seconds, const std::function<Transform(double)>& hipsAt) {
  Clip clip;
  Track<Vec3f> positions;
  Track<Eigen::Quaternionf> turns, nods;
  positions.joint = turns.joint = hips;
  nods.joint = hips + 1;
  for (int k = 0; k <= std::lround(seconds * 30); ++k) {
    const double time = k / 30.0;
    const Transform local = hipsAt(time);
    positions.times.push_back(static_cast<float>(time));
    positions.values.emplace_back(local.translation.cast<float>());
    turns.values.emplace_back(local.rotation.cast<float>());
    nods.values.emplace_back(Quat(Eigen::AngleAxisd(0.3 * std::sin(5 * time), Vec3::UnitX())).cast<float>());
  }
  turns.times = nods.times = positions.times;
  clip.translations = {positions};
  clip.rotations = {turns, nods};
  return clip;
}

Transform straight(double time) {
  Transform local;
  local.translation = {0.04 * std::sin(kTurn * time), 1 + 0.02 * std::cos(2 * kTurn * time), 1.4 * time};
  local.rotation = Eigen::AngleAxisd(0.1 * std::sin(kTurn * time), Vec3(1, 2, 0.5).normalized());
  return local;
}

// Around a circle of 2 m in four seconds, facing where it goes.
Transform around(double time) {
  const double angle = kTurn * time / 4;
  const Quat heading(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  Transform local;
  local.translation = heading * Vec3(-2, 1 + 0.03 * std::sin(9 * time), 0);
  local.rotation = heading * Quat(Eigen::AngleAxisd(0.3 * std::sin(7 * time), Vec3::UnitZ()));
  return local;
}

std::vector<Vec3> positions(const Skeleton& skeleton, const Clip& clip, double time) {
  Pose pose = restPose(skeleton);
  sampleClip(clip, time, pose);
  return posePositions(skeleton, pose);
}

RootMotionOptions about(Index body) {
  RootMotionOptions options;
  options.body = body;
  return options;
}

// Positions of all joints but `root`, at random times.
void expectUnmoved(const Skeleton& skeleton, const Clip& a, const Clip& b, Index root) {
  RandomValues random(5);
  for (int i = 0; i < 600; ++i) {
    const double time = random.uniform(0, a.duration());
    const std::vector<Vec3> before = positions(skeleton, a, time), after = positions(skeleton, b, time);
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (j == root) continue;
      ASSERT_LT((before[j] - after[j]).norm(), 2e-6) << skeleton.joints[j].name << " at " << time;  // of 1.7 m
    }
  }
}

TEST(ExtractRootMotion, MovesNothingButTheRoot) {
  const Skeleton skeleton = walker(true);
  for (const auto& path : {straight, around}) {
    const Clip clip = walk(1, 4, path);
    for (const bool heading : {false, true}) {
      for (const bool height : {false, true}) {
        RootMotionOptions options = about(1);
        options.heading = heading;
        options.height = height;
        const Clip extracted = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
        checkClip(extracted, skeleton);
        expectUnmoved(skeleton, clip, extracted, 0);
        EXPECT_GT((positions(skeleton, extracted, 1)[0] - positions(skeleton, extracted, 0)[0]).norm(), 1);
      }
    }
  }
}

TEST(ExtractRootMotion, IsAsExactBelowAScale) {
  Skeleton skeleton = walker(true);
  Clip clip = walk(1, 4, around);
  skeleton.joints[0].rest.scale = Vec3::Constant(100);
  for (Index j = 1; j < skeleton.jointCount(); ++j) skeleton.joints[j].rest.translation /= 100;
  for (Vec3f& position : clip.translations[0].values) position /= 100;
  RootMotionOptions options = about(1);
  options.heading = true;
  const Clip extracted = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
  expectUnmoved(skeleton, clip, extracted, 0);
}

TEST(ExtractRootMotion, TakesMovementsOfTheRootThatAreThere) {
  const Skeleton skeleton = walker(true);
  Clip clip = walk(1, 2, straight);
  Clip onRoot = walk(0, 2, around);
  clip.translations.push_back(onRoot.translations[0]);
  clip.rotations.push_back(onRoot.rotations[0]);
  RootMotionOptions options = about(1);
  options.heading = true;
  const Clip extracted = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
  checkClip(extracted, skeleton);
  expectUnmoved(skeleton, clip, extracted, 0);
  for (const Vec3f& position : extracted.translations.back().values) EXPECT_EQ(position.y(), 0);
}

TEST(ExtractRootMotion, CurvesAndStepsAreFollowed) {
  const Skeleton skeleton = walker(true);
  Clip clip;
  Track<Vec3f> curve{1, Interpolation::kCubic, {0, 1, 2}, {}};
  for (const Vec3f& v : {Vec3f(0, 1, 0), Vec3f(1, 1, 2), Vec3f(0, 1.2f, 3)}) {
    curve.values.insert(curve.values.end(), {Vec3f(0, 0, 1), v, Vec3f(0.5f, 0, 1)});
  }
  clip.translations = {curve};
  clip.rotations = {
      {1, Interpolation::kLinear, {0, 2}, {Eigen::Quaternionf::Identity(), Eigen::Quaternionf(0, 0, 0, 1)}}};
  RootMotionOptions options = about(1);
  options.smoothing = 0;
  const Clip smooth = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
  expectUnmoved(skeleton, clip, smooth, 0);

  clip.translations[0] = {1, Interpolation::kStep, {0, 0.5f, 1, 2}, {{0, 1, 0}, {0, 1, 1}, {0, 1, 5}, {0, 1, 6}}};
  const Clip stepped = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
  for (const double time : {0.1, 0.4999, 0.5001, 0.75, 0.9999, 1.5}) {
    EXPECT_LT((positions(skeleton, clip, time)[3] - positions(skeleton, stepped, time)[3]).norm(), 2e-6) << time;
  }
}

TEST(ExtractRootMotion, WithoutSmoothingTheHipsKeepNoTravel) {
  const Skeleton skeleton = walker(true);
  const Clip clip = walk(1, 2, straight);
  RootMotionOptions options = about(1);
  options.smoothing = 0;
  const Clip extracted = extractRootMotion(skeleton, clip, 0, rootTrajectory(skeleton, clip, options));
  for (const auto& track : extracted.translations) {
    if (track.joint != 1) continue;
    for (const Vec3f& value : track.values) {
      EXPECT_NEAR(value.x(), 0, 1e-6);
      EXPECT_NEAR(value.z(), 0.05, 1e-6);  // as in rest pose
    }
  }
}

TEST(ExtractRootMotion, WantsTheOnlyRoot) {
  const Skeleton skeleton = walker(true);
  const Clip clip = walk(1, 1, straight);
  EXPECT_THROW(extractRootMotion(skeleton, clip, 1, rootTrajectory(skeleton, clip, about(1))), Error);
  EXPECT_THROW(rootTrajectory(skeleton, clip, about(9)), Error);
  RootMotionOptions endless = about(1);
  endless.smoothing = HUGE_VAL;
  EXPECT_THROW(rootTrajectory(skeleton, clip, endless), Error);
}

// A Gaussian lets exp(-(2 pi f s)^2 / 2) of a sine through.
TEST(RootTrajectory, LeavesTheSwayToTheBody) {
  const Skeleton skeleton = walker(false);
  const Clip clip = walk(0, 10, straight);
  const RootTrajectory trajectory = rootTrajectory(skeleton, clip, about(0));
  const double kept = std::exp(-0.5 * kTurn * kTurn * 0.3 * 0.3);
  for (double time = 2; time < 8; time += 0.1) {
    EXPECT_NEAR(trajectory.at(time).translation.x(), kept * 0.04 * std::sin(kTurn * time), 2e-4);
    EXPECT_NEAR(trajectory.at(time).translation.z(), 1.4 * time - 0.05, 2e-4);
    EXPECT_EQ(trajectory.at(time).translation.y(), 0);
  }
  EXPECT_NEAR(trajectory.at(0).translation.z(), -0.05, 1e-6);  // speed is even up to the ends
}

TEST(RootTrajectory, TurnsMoreThanOnce) {
  const Skeleton skeleton = walker(false);
  const Clip clip = walk(0, 10, around);
  RootMotionOptions options = about(0);
  options.heading = true;
  const RootTrajectory trajectory = rootTrajectory(skeleton, clip, options);
  EXPECT_NEAR(trajectory.headings.front(), 0, 0.05);
  EXPECT_NEAR(trajectory.headings.back(), kTurn * 10 / 4, 0.05);
  for (std::size_t k = 1; k < trajectory.headings.size(); ++k) {
    EXPECT_NEAR(trajectory.headings[k] - trajectory.headings[k - 1], kTurn / 4 / 30, 0.02);
  }
}

TEST(RootTrajectory, OfALoopGoesOnAsItBegan) {
  const Skeleton skeleton = walker(false);
  const Clip clip = walk(0, 4, around);  // one round
  RootMotionOptions options = about(0);
  options.heading = options.loops = true;
  const RootTrajectory trajectory = rootTrajectory(skeleton, clip, options);
  const Transform first = trajectory.at(0), last = trajectory.at(4);
  EXPECT_LT((first.translation - last.translation).norm(), 1e-5);
  EXPECT_LT(first.rotation.angularDistance(last.rotation), 1e-5);
  const Vec3 out = (first.translation - trajectory.at(1 / 30.0).translation) * 30;
  const Vec3 in = (trajectory.at(4 - 1 / 30.0).translation - last.translation) * 30;
  EXPECT_LT((out - in).norm(), 0.3);  // of 3 m/s, turned by three degrees
}

TEST(ClipInPlace, ARootThatStandsStillStaysSo) {
  Skeleton skeleton = walker(true);
  skeleton.joints[0].rest.rotation = Quat(Eigen::AngleAxisd(-1.5, Vec3::UnitX()));
  skeleton.joints[0].rest.scale = Vec3::Constant(0.5);
  const Affine toRoot = skeleton.joints[0].rest.toAffine().inverse(Eigen::Affine);
  for (const bool heading : {false, true}) {
    const Clip clip = walk(
        1, 4, [&](double time) { return decompose(toRoot * (heading ? around(time) : straight(time)).toAffine()); });
    RootMotionOptions options = about(1);
    options.heading = heading;
    const RootTrajectory travel = rootTrajectory(skeleton, clip, options);
    const Clip inPlace = clipInPlace(skeleton, clip, 1, travel);
    checkClip(inPlace, skeleton);
    for (const auto& track : inPlace.translations) EXPECT_NE(track.joint, 0u);
    for (const auto& track : inPlace.rotations) EXPECT_NE(track.joint, 0u);
    for (double time = 0; time < 4; time += 0.05) {
      const std::vector<Vec3> before = positions(skeleton, clip, time), after = positions(skeleton, inPlace, time);
      for (Index j = 1; j < skeleton.jointCount(); ++j) {
        EXPECT_LT((travel.at(time).toAffine() * after[j] - before[j]).norm(), 1e-5) << j << " at " << time;
      }
    }
  }
}

// Away from its rest, while its chest nods.
TEST(ClipInPlace, ABodyThatIsHeldStaysWhole) {
  const Skeleton skeleton = walker(true);
  const Clip clip = walk(1, 2, [](double) {
    Transform local;
    local.translation = {5, 1, 2};
    return local;
  });
  const RootTrajectory travel = rootTrajectory(skeleton, clip, about(1));
  const Clip inPlace = clipInPlace(skeleton, clip, 1, travel);
  for (double time = 0; time < 2; time += 0.1) {
    const std::vector<Vec3> before = positions(skeleton, clip, time), after = positions(skeleton, inPlace, time);
    for (Index j = 1; j < skeleton.jointCount(); ++j) {
      EXPECT_LT((travel.at(time).toAffine() * after[j] - before[j]).norm(), 1e-5) << j << " at " << time;
    }
  }
}

TEST(ClipInPlace, TheBodyStaysAboveItsPlace) {
  const Skeleton skeleton = walker(false);
  for (const bool heading : {false, true}) {
    const Clip clip = walk(0, 6, heading ? around : straight);
    RootMotionOptions options = about(0);
    options.heading = heading;
    const Clip inPlace = clipInPlace(skeleton, clip, options.body, rootTrajectory(skeleton, clip, options));
    checkClip(inPlace, skeleton);
    for (double time = 0; time < 6; time += 0.05) {
      const Vec3 hips = positions(skeleton, inPlace, time)[0], before = positions(skeleton, clip, time)[0];
      EXPECT_LT(std::hypot(hips.x(), hips.z() - 0.05), heading ? 0.25 : 0.06) << time;
      EXPECT_NEAR(hips.y(), before.y(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace limber
