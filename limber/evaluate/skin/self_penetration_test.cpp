// Two boxes that move into each other by known amounts.
#include "limber/evaluate/skin/self_penetration.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

constexpr int kCells = 8;  // of a box along each axis

// The surface of the unit cube round the origin, each side a grid of squares.
TriMesh box() {
  TriMesh mesh;
  const TriMesh side = limber::testing::flatGrid(kCells, kCells);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float end : {-0.5f, 0.5f}) {
      TriMesh face = side;
      for (Vec3f& p : face.positions) {
        const Vec3f flat = p - Vec3f(0.5f, 0.5f, 0);
        p[axis] = end;
        p[(axis + 1) % 3] = end > 0 ? flat.x() : flat.y();
        p[(axis + 2) % 3] = end > 0 ? flat.y() : flat.x();
      }
      mesh = limber::testing::join(mesh, face);
    }
  }
  return mesh;
}

// Two boxes, the second two to the right of the first; each has a joint.
SkinnedModel twoBoxes() {
  SkinnedModel model;
  const TriMesh one = box();
  model.mesh = limber::testing::join(one, limber::testing::moved(one, Vec3f::Ones(), {2, 0, 0}));
  Transform beside;
  beside.translation = Vec3(2, 0, 0);
  model.skeleton.joints = {{"left", std::nullopt, {}, 0}, {"right", Index{0}, beside, 0}};
  model.weights.slots = 1;
  for (const Vec3f& p : model.mesh.positions) {
    model.weights.joints.push_back(p.x() > 1 ? 1 : 0);
    model.weights.weights.push_back(1);
  }
  return model;
}

Pose secondBoxAt(const SkinnedModel& model, const Vec3& position) {
  Pose pose = restPose(model.skeleton);
  pose.locals[1].translation = position;
  return pose;
}

// Pushed in by 2.4 cells, and half a cell to both sides: of each box the end's 8 x 8 vertices and two rings of 15 are
// inside the other, of 386.
const Vec3 kPushedIn(0.7, 0.0625, 0.0625);
constexpr double kFraction = (8 * 8 + 2 * 15) / 386.0;

TEST(SelfPenetration, CountsTheVerticesThatWentInside) {
  const SkinnedModel model = twoBoxes();
  const SelfPenetration result =
      measureSelfPenetration(model, {restPose(model.skeleton), secondBoxAt(model, kPushedIn)});
  EXPECT_NEAR(result.worst, kFraction, 1e-12);
  EXPECT_NEAR(result.mean, kFraction / 2, 1e-12);
  EXPECT_EQ(result.worstFrame, 1u);
}

TEST(SelfPenetration, PartsThatOnlyTouchAreOutside) {
  const SkinnedModel model = twoBoxes();
  EXPECT_EQ(measureSelfPenetration(model, {secondBoxAt(model, {1.01, 0, 0})}).worst, 0);
}

TEST(SelfPenetration, WhatIsInsideAtRestDoesNotCount) {
  SkinnedModel model = twoBoxes();
  for (Vec3f& p : model.mesh.positions) {
    if (p.x() > 1) p = 0.2f * (p - Vec3f(2, 0, 0));  // in the middle of the first
  }
  model.skeleton.joints[1].rest.translation = Vec3::Zero();
  EXPECT_EQ(measureSelfPenetration(model, {secondBoxAt(model, {0.3, 0, 0})}).worst, 0);
}

TEST(SelfPenetration, FramesAndVerticesAreTakenEvenly) {
  const SkinnedModel model = twoBoxes();
  std::vector<Pose> poses(101, restPose(model.skeleton));
  poses[50] = secondBoxAt(model, kPushedIn);
  SelfPenetrationOptions options;
  options.maxFrames = 3;
  const SelfPenetration three = measureSelfPenetration(model, poses, options);
  EXPECT_EQ(three.worstFrame, 50u);
  EXPECT_NEAR(three.mean, kFraction / 3, 1e-12);
  options.maxVertices = 200;
  EXPECT_NEAR(measureSelfPenetration(model, poses, options).worst, kFraction, 0.03);
  EXPECT_THROW(measureSelfPenetration(model, {}), Error);
}

}  // namespace
}  // namespace limber
