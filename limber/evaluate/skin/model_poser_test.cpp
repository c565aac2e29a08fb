// Tubes that are twisted, whose shape is known in closed form.
#include "limber/evaluate/skin/model_poser.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

constexpr double kRadius = 0.1, kTwist = 2;  // radians

// A tube from -0.5 to 0.5 along x that goes over from the joint at its one end to the one at its other.
SkinnedModel rampedTube() {
  SkinnedModel model;
  model.mesh = limber::testing::tube(16, 21, true);
  Transform start, along;
  start.translation = Vec3(-0.5, 0, 0);
  along.translation = Vec3(1, 0, 0);
  model.skeleton.joints = {{"start", std::nullopt, start, 0}, {"end", Index{0}, along, 0}};
  model.weights.slots = 2;
  for (const Vec3f& p : model.mesh.positions) {
    model.weights.joints.insert(model.weights.joints.end(), {0, 1});
    model.weights.weights.insert(model.weights.weights.end(), {0.5f - p.x(), 0.5f + p.x()});
  }
  return model;
}

std::vector<Vec3f> twistedBy(const SkinnedModel& model, const Deformer& deformer) {
  Pose pose = restPose(model.skeleton);
  pose.locals[1].rotation = Quat(Eigen::AngleAxisd(kTwist, Vec3::UnitX()));
  ModelPoser poser(model, deformer);
  std::vector<Vec3f> positions(model.mesh.positions.size());
  poser.pose(pose, positions);
  return positions;
}

// By linear blending a point goes to the mean of where the two joints take it, on the chord: the candy wrapper. By dual
// quaternions it stays on the circle.
TEST(ModelPoser, ATwistedTubeIsThinAsItsDeformerSays) {
  const SkinnedModel model = rampedTube();
  const std::vector<Vec3f> linear = twistedBy(model, kLinearBlendDeformer),
                           dual = twistedBy(model, findDeformer("dual-quaternion"));
  for (std::size_t v = 0; v + 2 < linear.size(); ++v) {  // but for the middles of the caps
    const double w = 0.5 + static_cast<double>(model.mesh.positions[v].x());
    const double chord = std::hypot(1 - w + w * std::cos(kTwist), w * std::sin(kTwist));
    EXPECT_NEAR(linear[v].tail<2>().norm(), kRadius * chord, 1e-6);
    EXPECT_NEAR(dual[v].tail<2>().norm(), kRadius, 1e-6);
    EXPECT_NEAR(linear[v].x(), model.mesh.positions[v].x(), 1e-6);
    EXPECT_NEAR(dual[v].x(), model.mesh.positions[v].x(), 1e-6);
  }
}

TEST(ModelPoser, TurnedAsAWholeByAnyDeformerAModelKeepsItsShape) {
  const SkinnedModel model = rampedTube();
  for (const Deformer& deformer : deformers()) {
    SCOPED_TRACE(deformer.name);
    ModelPoser poser(model, deformer);
    Pose pose = restPose(model.skeleton);
    std::vector<Vec3f> rest(model.mesh.positions.size()), turned(rest);
    poser.pose(pose, rest);
    const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    pose.locals[0].rotation = turn;
    poser.pose(pose, turned);
    const Vec3 pivot(-0.5, 0, 0);
    for (std::size_t v = 0; v < rest.size(); ++v) {
      const Vec3 expected = pivot + turn * (rest[v].cast<double>() - pivot);
      EXPECT_LT((turned[v].cast<double>() - expected).norm(), 1e-5);
    }
  }
}

TEST(ModelPoser, WhatDoesNotFitIsRefused) {
  SkinnedModel model = rampedTube();
  ModelPoser poser(model);
  std::vector<Vec3f> few(3);
  EXPECT_THROW(poser.pose(restPose(model.skeleton), few), Error);
  SkinnedModel bad = model;
  bad.weights.joints[0] = 2;
  EXPECT_THROW(ModelPoser{bad}, Error);
}

}  // namespace
}  // namespace limber
