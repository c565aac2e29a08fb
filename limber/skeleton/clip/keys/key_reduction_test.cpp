// Key reduction: what a viewer would show, sampled between the keys, against the clip that came in.
#include "limber/skeleton/clip/keys/key_reduction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

// A spine with an arm of three joints, and vertices all over it, most with two joints.
struct Body {
  Skeleton skeleton;
  std::vector<Vec3f> positions;
  SkinWeights weights;

  Body() {
    RandomValues random(2);
    for (Index j = 0; j < 7; ++j) {
      Joint joint;
      joint.name = "joint" + std::to_string(j);
      if (j > 0) joint.parent = j - 1;
      joint.rest.translation = 0.25 * (j < 4 ? Vec3(0, 1, 0) : Vec3(1, 0, 0.1));
      joint.rest.rotation = random.rotation();
      if (j > 0) joint.rest.translation = 0.25 * random.direction();
      skeleton.joints.push_back(joint);
    }
    const std::vector<Vec3> points = restPositions(skeleton);
    weights.slots = 2;
    for (Index v = 0; v < 120; ++v) {
      const Index joint = v % 7, other = joint == 0 ? 1 : joint - 1;
      const auto weight = static_cast<float>(random.uniform(0.5, 1));
      positions.push_back((points[joint] + 0.1 * random.direction()).cast<float>());
      weights.joints.insert(weights.joints.end(), {joint, other});
      weights.weights.insert(weights.weights.end(), {weight, 1 - weight});
    }
  }

  CarriedPoints carried() const { return carriedPoints(skeleton, positions, weights); }

  std::vector<Vec3> surface(const Clip& clip, double time) const {
    Pose pose = restPose(skeleton);
    sampleClip(clip, time, pose);
    const std::vector<Affine> skin = skinTransforms(skeleton, pose);
    std::vector<Vec3> result;
    for (Index v = 0; v < positions.size(); ++v) {
      Vec3 position = Vec3::Zero();
      for (Index s = 0; s < 2; ++s) {
        position += weights.weightsOf(v)[s] * (skin[weights.jointsOf(v)[s]] * positions[v].cast<double>());
      }
      result.push_back(position);
    }
    return result;
  }

  // At times of its own, ten between two keys.
  double farthest(const Clip& a, const Clip& b) const {
    double worst = 0;
    for (double time = 0; time <= a.duration(); time += 1 / 197.0) {
      const std::vector<Vec3> one = surface(a, time), other = surface(b, time);
      for (std::size_t v = 0; v < one.size(); ++v) worst = std::max(worst, (one[v] - other[v]).norm());
    }
    return worst;
  }
};

// Smooth rotations of all joints, a wandering root, a still tail.
Clip moving(const Skeleton& skeleton, int frames, double noise = 0) {
  RandomValues random(9);
  Clip clip;
  clip.name = "moving";
  Track<Vec3f> path{0, Interpolation::kLinear, {}, {}};
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Track<Eigen::Quaternionf> track{j, Interpolation::kLinear, {}, {}};
    const Vec3 axis = random.direction();
    const double speed = random.uniform(1, 5);
    for (int k = 0; k <= frames; ++k) {
      const double time = k / 30.0, angle = j == 6 ? 0.2 : 0.5 * std::sin(speed * time) + noise * random.uniform();
      track.times.push_back(static_cast<float>(time));
      track.values.push_back((skeleton.joints[j].rest.rotation * Quat(Eigen::AngleAxisd(angle, axis))).cast<float>());
      if (j == 0)
        path.values.emplace_back(Vec3f(0.3f * std::sin(2 * path.times.emplace_back(track.times.back())), 0, 0));
    }
    clip.rotations.push_back(track);
  }
  clip.translations = {path};
  clip.scales.push_back({2, Interpolation::kLinear, {0, 1}, {Vec3f::Ones(), Vec3f::Ones()}});
  return clip;
}

TEST(ReduceKeys, StaysWithinTheToleranceOnTheSurface) {
  const Body body;
  const Clip clip = moving(body.skeleton, 150);
  std::size_t keys = 10000;
  for (const double tolerance : {0.0002, 0.001, 0.02}) {
    for (const bool shortRotations : {false, true}) {
      const ReducedClip reduced = reduceKeys(body.skeleton, clip, body.carried(), {tolerance, shortRotations});
      checkClip(reduced.clip, body.skeleton);
      EXPECT_LE(body.farthest(clip, reduced.clip), tolerance);
      EXPECT_LE(reduced.largestError, tolerance);
      EXPECT_GT(reduced.largestError, 0.4 * tolerance);  // it is used
      EXPECT_EQ(reduced.keysBefore, 8u * 151 + 2);
      EXPECT_FLOAT_EQ(reduced.clip.duration(), clip.duration());
      if (!shortRotations) {
        EXPECT_LT(reduced.keysAfter, keys);
        keys = reduced.keysAfter;
      }
    }
  }
  EXPECT_LT(keys, 250u);
}

TEST(ReduceKeys, StillTracksBecomeOneKey) {
  const Body body;
  const ReducedClip reduced = reduceKeys(body.skeleton, moving(body.skeleton, 60), body.carried());
  for (const auto& track : reduced.clip.rotations) EXPECT_EQ(track.times.size() == 1, track.joint == 6) << track.joint;
  ASSERT_EQ(reduced.clip.scales.size(), 1u);
  EXPECT_EQ(reduced.clip.scales[0].times.size(), 1u);
}

// A last key that repeats the pose only sets the clip's duration.
TEST(ReduceKeys, AClipThatStandsLastsAsLong) {
  const Body body;
  Clip clip;
  clip.rotations.push_back(
      {0, Interpolation::kLinear, {0, 2}, {Eigen::Quaternionf::Identity(), Eigen::Quaternionf::Identity()}});
  EXPECT_EQ(reduceKeys(body.skeleton, clip, body.carried()).clip.duration(), 2);
  EXPECT_EQ(reduceKeys(body.skeleton, Clip(), body.carried()).clip.duration(), 0);
}

TEST(ReduceKeys, ShortRotationsAreFractions) {
  const Body body;
  const Clip clip = moving(body.skeleton, 60);
  const ReducedClip reduced = reduceKeys(body.skeleton, clip, body.carried(), {0.001, true});
  for (const auto& track : reduced.clip.rotations) {
    if (track.times.size() == 1) continue;
    for (const auto& value : track.values) {
      for (const float x : value.coeffs()) EXPECT_NEAR(x * 32767, std::round(x * 32767), 5e-3);
    }
  }
  // Too coarse for this.
  const ReducedClip fine = reduceKeys(body.skeleton, clip, body.carried(), {1e-5, true});
  EXPECT_LE(body.farthest(clip, fine.clip), 1e-5);
}

TEST(ReduceKeys, StepsAndCurvesStay) {
  const Body body;
  Clip clip;
  Track<Eigen::Quaternionf> steps{3, Interpolation::kStep, {0, 1, 2, 3}, {}};
  for (const float angle : {0.f, 0.f, 1.f, 1.f}) steps.values.emplace_back(Eigen::AngleAxisf(angle, Vec3f::UnitX()));
  Track<Vec3f> curve{0, Interpolation::kCubic, {0, 3}, {}};
  for (int v = 0; v < 6; ++v) curve.values.emplace_back(0, v == 4 ? 2 : 1, v % 3 == 1 ? 0 : 3);
  clip.rotations = {steps};
  clip.translations = {curve};
  const ReducedClip reduced = reduceKeys(body.skeleton, clip, body.carried(), {0.0001, true});
  EXPECT_LT(body.farthest(clip, reduced.clip), 0.0001);
  EXPECT_EQ(reduced.clip.rotations[0].interpolation, Interpolation::kStep);
  EXPECT_EQ(reduced.clip.rotations[0].times, (std::vector<float>{0, 2, 3}));
  EXPECT_EQ(reduced.clip.translations[0].interpolation, Interpolation::kCubic);
  // A hundred centimetres of tolerance: two lines will do.
  EXPECT_EQ(reduceKeys(body.skeleton, clip, body.carried(), {1, true}).clip.translations[0].interpolation,
            Interpolation::kLinear);
}

TEST(ReduceKeys, LongClipsAndAnyNumberOfThreads) {
  const Body body;
  const Clip clip = moving(body.skeleton, 1300, 0.01);
  setThreadCount(1);
  const ReducedClip one = reduceKeys(body.skeleton, clip, body.carried());
  setThreadCount(0);
  const ReducedClip more = reduceKeys(body.skeleton, clip, body.carried());
  EXPECT_LE(one.largestError, 0.001);
  ASSERT_EQ(one.clip.rotations.size(), more.clip.rotations.size());
  for (std::size_t t = 0; t < one.clip.rotations.size(); ++t) {
    ASSERT_EQ(one.clip.rotations[t].times, more.clip.rotations[t].times);
    for (std::size_t k = 0; k < one.clip.rotations[t].values.size(); ++k) {
      ASSERT_EQ(one.clip.rotations[t].values[k].coeffs(), more.clip.rotations[t].values[k].coeffs());
    }
  }
}

TEST(ReduceKeys, WantsAToleranceAndPointsOfTheSkeleton) {
  const Body body;
  const Clip clip = moving(body.skeleton, 3);
  for (const double tolerance : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_THROW(reduceKeys(body.skeleton, clip, body.carried(), {tolerance, false}), Error);
  }
  EXPECT_THROW(reduceKeys(body.skeleton, clip, {}), Error);
}

// No vertex of one joint moves farther than the farthest of the joint's points.
TEST(CarriedPoints, BoundWhatTheJointMoves) {
  Body body;
  for (Index v = 0; v < body.positions.size(); ++v) bindTo(v % 7, v, body.weights);
  const CarriedPoints carried = body.carried();
  const std::vector<Affine> toJoint = inverseBindOf(body.skeleton);
  RandomValues random(1);
  for (int i = 0; i < 200; ++i) {
    Affine moved(random.rotation());
    for (int k = 0; k < 9; ++k) moved.linear()(k / 3, k % 3) += random.uniform(-0.3, 0.3);
    moved.translation() = random.direction();
    std::vector<double> most(7, 0);
    for (Index j = 0; j < 7; ++j) {
      for (const Vec3& point : carried.of[j]) most[j] = std::max(most[j], (moved * point - point).norm());
    }
    for (Index v = 0; v < body.positions.size(); ++v) {
      const Vec3 point = toJoint[v % 7] * body.positions[v].cast<double>();
      ASSERT_LE((moved * point - point).norm(), most[v % 7] + 1e-9);
    }
  }
  EXPECT_THROW(carriedPoints(body.skeleton, {}, body.weights), Error);
}

}  // namespace
}  // namespace limber
