#include "limber/session/drag/drag.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/session/testing/two_armed_body.h"

namespace limber {
namespace {

using testing::kElbow;
using testing::kHand;
using testing::kOtherHand;
using testing::kShoulder;
using testing::twoArmedBody;

const Vec3 kView(0, 0, -1), kEye(0, 2, 10);

Ray through(const Vec3& point) {
  return {kEye, point - kEye};
}

Vec3 at(const Skeleton& skeleton, const Pose& pose, Index joint) {
  return poseGlobals(skeleton, pose)[joint].translation();
}

DragScene sceneOf(const Skeleton& skeleton, bool ik = false) {
  return {&skeleton, nullptr, restPose(skeleton), ik, {}, 1};
}

TEST(Drag, MoveSlidesInThePlaneThatFacesTheCamera) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 hand = at(skeleton, restPose(skeleton), kHand), grip = hand + Vec3(0.05, -0.03, 0),
             displacement(-0.4, 0.7, 0);
  Drag drag(sceneOf(skeleton), kHand, DragMode::kMove, through(grip), kView);
  const Pose pose = drag.at(through(grip + displacement), kView).value();
  EXPECT_LT((at(skeleton, pose, kHand) - hand - displacement).norm(), 1e-12);
  EXPECT_LT((at(skeleton, pose, kElbow) - at(skeleton, restPose(skeleton), kElbow)).norm(), 1e-12);
}

TEST(Drag, ATurnAboutTheJointsOwnPlaceCountsFromTheStart) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSegment);
  const Pose rest = restPose(skeleton);
  Drag drag(sceneOf(skeleton), kElbow, DragMode::kTurn, through(at(skeleton, rest, kElbow)), kView);
  const Vec3 axis = Vec3(1, 2, -1);
  drag.turned(Vec3::UnitX(), 70);
  const Pose pose = drag.turned(axis, 40);
  const Affine before = poseGlobals(skeleton, rest)[kElbow], after = poseGlobals(skeleton, pose)[kElbow];
  EXPECT_LT((after.translation() - before.translation()).norm(), 1e-12);
  const Quat turn(Mat3(after.linear() * before.linear().transpose()));
  EXPECT_LT(angleBetween(turn, Quat(Eigen::AngleAxisd(40 * EIGEN_PI / 180, axis.normalized()))), 1e-9);
  EXPECT_THROW(drag.turned(Vec3::Zero(), 10), Error);
}

TEST(Drag, CarriedAJointGoesAndTurnsAsTheHandDoes) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Pose rest = restPose(skeleton);
  const Affine before = poseGlobals(skeleton, rest)[kHand];
  const Vec3 offset(-0.5, 0.4, 0.3), turn(20, -50, 35);
  const Quat wanted(Eigen::AngleAxisd(turn.norm() * kDegree, turn.normalized()));
  for (const bool ik : {false, true}) {
    Drag drag(sceneOf(skeleton, ik), kHand, DragMode::kMove, through(before.translation()), kView);
    const Pose moved = drag.moved(offset), pose = drag.carried(offset, turn);
    const Affine after = poseGlobals(skeleton, pose)[kHand];
    EXPECT_LT((after.translation() - before.translation() - offset).norm(), 1e-3);
    EXPECT_LT(angleBetween(Quat(Mat3(after.linear() * before.linear().transpose())), wanted), 1e-9);
    // It leaves nothing behind for the moves that follow.
    const Pose again = drag.moved(offset);
    for (Index j = 0; j < moved.locals.size(); ++j) {
      EXPECT_EQ(moved.locals[j].rotation.coeffs(), again.locals[j].rotation.coeffs());
    }
  }
}

TEST(Drag, TheMirrorImageIsCarriedReflected) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  Mat3 flip = Mat3::Identity();
  flip(0, 0) = -1;
  DragScene scene = sceneOf(skeleton);
  scene.followers = {{kOtherHand, flip, kHand}};
  const std::vector<Affine> before = poseGlobals(skeleton, scene.start);
  Drag drag(scene, kHand, DragMode::kMove, through(before[kHand].translation()), kView);
  const std::vector<Affine> after = poseGlobals(skeleton, drag.carried({0.2, 0.3, -0.1}, {0, 0, 40}));
  const auto offset = [&](Index j) { return Vec3(after[j].translation() - before[j].translation()); };
  EXPECT_LT((flip * offset(kHand) - offset(kOtherHand)).norm(), 1e-12);
  const Quat turned(Mat3(after[kOtherHand].linear() * before[kOtherHand].linear().transpose()));
  EXPECT_LT(angleBetween(turned, Quat(Eigen::AngleAxisd(-40 * kDegree, Vec3::UnitZ()))), 1e-9);
}

TEST(Drag, ACameraThatWalksPullsTheJointAlong) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 hand = at(skeleton, restPose(skeleton), kHand), step(0, 0, -0.5);
  Drag drag(sceneOf(skeleton), kHand, DragMode::kMove, through(hand), kView);
  const Ray ray{kEye + step, hand - kEye};
  EXPECT_LT((at(skeleton, drag.at(ray, kView).value(), kHand) - hand - step).norm(), 1e-12);
}

TEST(Drag, TurnSwingsAboutTheParentRoundTheCamerasAxis) {
  for (const BoneShape shape : {BoneShape::kSphere, BoneShape::kSegment}) {
    const Skeleton skeleton = twoArmedBody(shape);
    const Pose rest = restPose(skeleton);
    const Vec3 elbow = at(skeleton, rest, kElbow), hand = at(skeleton, rest, kHand);
    Drag drag(sceneOf(skeleton), kHand, DragMode::kTurn, through(hand), kView);
    // A quarter turn: the hand that was to the right of the elbow is above it, whatever the distance of the pointer.
    const Pose pose = drag.at(through(elbow + Vec3(0, 3, 0)), kView).value();
    EXPECT_LT((at(skeleton, pose, kHand) - elbow - Vec3(0, 1, 0)).norm(), 1e-9);
    EXPECT_LT((at(skeleton, pose, kElbow) - elbow).norm(), 1e-12);
    const Index turned = shape == BoneShape::kSphere ? kHand : kElbow;
    const Quat rotation(poseGlobals(skeleton, pose)[turned].linear());
    EXPECT_LT(angleBetween(rotation, Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()))), 1e-9);
  }
}

TEST(Drag, ATurnedJointLeavesItsSiblingsAlone) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSegment);
  const Pose rest = restPose(skeleton);
  Drag drag(sceneOf(skeleton), kShoulder, DragMode::kTurn, through(at(skeleton, rest, kShoulder)), kView);
  const Pose pose = drag.at(through({0.2, 2.4, 0}), kView).value();
  EXPECT_GT((at(skeleton, pose, kHand) - at(skeleton, rest, kHand)).norm(), 0.5);
  EXPECT_EQ(at(skeleton, pose, kOtherHand), at(skeleton, rest, kOtherHand));
}

TEST(Drag, ARootRollsUnderThePointer) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 root(0, 1, 0);
  Drag drag(sceneOf(skeleton), 0, DragMode::kTurn, through(root), kView);
  const Pose pose = drag.at(through(root + Vec3(0.5, 0, 0)), kView).value();
  EXPECT_LT((at(skeleton, pose, 0) - root).norm(), 1e-12);
  // To the right: what faces the camera goes to the right.
  const Quat rotation(poseGlobals(skeleton, pose)[0].linear());
  EXPECT_LT(angleBetween(rotation, Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY()))), 1e-9);
}

TEST(Drag, AScaledJointGrowsAsThePointerGoesUpAndItsChildrenComeAlong) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Pose rest = restPose(skeleton);
  const Vec3 elbow = at(skeleton, rest, kElbow), hand = at(skeleton, rest, kHand);
  DragScene scene = sceneOf(skeleton, true);
  scene.start.locals[kElbow].scale *= 2;
  scene.followers = {{kOtherHand}};
  Drag drag(scene, kElbow, DragMode::kScale, through(elbow), kView);
  const auto scaleAt = [&](const Vec3& offset, bool snapping = false) {
    return drag.at(through(elbow + offset), kView, snapping).value().locals[kElbow].scale.x() / 2;
  };
  EXPECT_NEAR(scaleAt({0.7, 1, 0}), 2, 1e-12);
  EXPECT_NEAR(scaleAt({0, -1, 0}), 0.5, 1e-12);
  EXPECT_NEAR(scaleAt({0, 0.47, 0}, true), 1.5, 1e-12);
  const Pose pose = drag.scaled(1.5);
  EXPECT_LT((at(skeleton, pose, kElbow) - elbow).norm(), 1e-12);
  EXPECT_LT((at(skeleton, pose, kHand) - elbow - 3 * (hand - elbow)).norm(), 1e-12);
  EXPECT_EQ(pose.locals[kOtherHand].scale, Vec3(Vec3::Constant(1.5)));
  for (const double nothing : {0.0, -1.0, std::nan("")}) EXPECT_THROW(drag.scaled(nothing), Error);
}

TEST(Drag, WithInverseKinematicsTheLimbFollowsAndBonesKeepTheirLength) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Pose rest = restPose(skeleton);
  const Vec3 hand = at(skeleton, rest, kHand), goal = hand + Vec3(-0.8, 0.6, 0);
  Drag drag(sceneOf(skeleton, true), kHand, DragMode::kMove, through(hand), kView);
  const Pose pose = drag.at(through(goal), kView).value();
  EXPECT_LT((at(skeleton, pose, kHand) - goal).norm(), 1e-3);
  for (const Index j : {kShoulder, kElbow, kHand}) {
    EXPECT_LT((pose.locals[j].translation - rest.locals[j].translation).norm(), 1e-12);
  }
  EXPECT_EQ(at(skeleton, pose, kOtherHand), at(skeleton, rest, kOtherHand));
  EXPECT_GT((at(skeleton, pose, kElbow) - at(skeleton, rest, kElbow)).norm(), 0.05);
}

TEST(Drag, HeldJointsStayWhereTheyAreWhenTheBodyMoves) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Pose rest = restPose(skeleton);
  DragScene scene = sceneOf(skeleton, true);
  // Bent a little, since a stretched arm cannot follow away.
  scene.start.locals[kElbow].rotation = Quat(Eigen::AngleAxisd(1.2, Vec3::UnitZ()));
  const Vec3 hand = at(skeleton, scene.start, kHand);
  scene.pinned = {{kHand, hand}};
  Drag drag(scene, 0, DragMode::kMove, through({0, 1, 0}), kView);
  const Pose pose = drag.at(through({-0.2, 1.1, 0}), kView).value();
  EXPECT_LT((at(skeleton, pose, 0) - Vec3(-0.2, 1.1, 0)).norm(), 1e-12);
  EXPECT_LT((at(skeleton, pose, kHand) - hand).norm(), 1e-3);
}

TEST(Drag, OnlyTheLastPlaceOfThePointerCounts) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 hand = at(skeleton, restPose(skeleton), kHand), goal = hand + Vec3(-0.7, -0.2, 0);
  Drag straight(sceneOf(skeleton, true), kHand, DragMode::kMove, through(hand), kView);
  Drag about(sceneOf(skeleton, true), kHand, DragMode::kMove, through(hand), kView);
  for (int i = 0; i < 50; ++i) about.at(through(hand + Vec3(0.1 * i, std::sin(i), 0)), kView);
  const Pose a = straight.at(through(goal), kView).value(), b = about.at(through(goal), kView).value();
  for (Index j = 0; j < a.locals.size(); ++j) EXPECT_EQ(a.locals[j].rotation.coeffs(), b.locals[j].rotation.coeffs());
}

TEST(Drag, RaysThatMissThePlaneChangeNothing) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  Drag drag(sceneOf(skeleton), kHand, DragMode::kMove, through({2.5, 2, 0.1}), kView);
  EXPECT_FALSE(drag.at({kEye, {1, 0, 0}}, kView));
  EXPECT_FALSE(drag.at({kEye, {0, 0, 1}}, kView));
  EXPECT_THROW(drag.at({kEye, {0, 0, 0}}, kView), Error);
  EXPECT_THROW(drag.at({kEye, kView}, Vec3::Constant(NAN)), Error);
}

TEST(Drag, SnappedTheJointIsOnTheGrid) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 hand = at(skeleton, restPose(skeleton), kHand);
  DragScene scene = sceneOf(skeleton);
  scene.snap.step = 0.25;
  Drag drag(scene, kHand, DragMode::kMove, through(hand), kView);
  const Vec3 position = at(skeleton, drag.at(through(hand + Vec3(0.3, -0.4, 0)), kView, true).value(), kHand);
  EXPECT_LT((position - Vec3(2.75, 1.5, 0)).norm(), 1e-12);
}

TEST(Drag, SnappedTurnsGoInSteps) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const Vec3 elbow = at(skeleton, restPose(skeleton), kElbow), hand = at(skeleton, restPose(skeleton), kHand);
  Drag drag(sceneOf(skeleton), kHand, DragMode::kTurn, through(hand), kView);
  const Vec3 pointer = elbow + Vec3(std::cos(0.7), std::sin(0.7), 0);  // 40 degrees
  const Pose pose = drag.at(through(pointer), kView, true).value();
  const Quat rotation(poseGlobals(skeleton, pose)[kHand].linear());
  EXPECT_LT(angleBetween(rotation, Quat(Eigen::AngleAxisd(kPi / 4, Vec3::UnitZ()))), 1e-9);
}

TEST(Drag, ATurnFromRestIsTheSameHoweverTheJointStood) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSegment);
  DragScene scene = sceneOf(skeleton);
  scene.start.locals[kShoulder].rotation = Quat(Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()));
  scene.start.locals[kElbow].rotation = Quat(Eigen::AngleAxisd(-1.1, Vec3(3, 0, 1).normalized()));
  Mat3 flip = Mat3::Identity();
  flip(0, 0) = -1;
  scene.followers = {{kShoulder}, {kOtherHand, flip, kElbow}};
  Drag drag(scene, kElbow, DragMode::kTurn, through({0, 2, 0}), kView);
  const Vec3 turn(30, -20, 10);
  const Pose pose = drag.turnedTo(turn);
  const Quat wanted(Eigen::AngleAxisd(turn.norm() * kDegree, turn.normalized()));
  EXPECT_LT(angleBetween(pose.locals[kElbow].rotation, wanted), 1e-9);
  EXPECT_LT(angleBetween(pose.locals[kShoulder].rotation, wanted), 1e-9);
  EXPECT_LT((pose.locals[kElbow].translation - skeleton.joints[kElbow].rest.translation).norm(), 1e-12);
  // The image turns as far in the world as the elbow would alone.
  const Quat above(poseGlobals(skeleton, scene.start)[kShoulder].linear());
  const Quat change = above * wanted * scene.start.locals[kElbow].rotation.conjugate() * above.conjugate();
  EXPECT_LT(angleBetween(pose.locals[kOtherHand].rotation, Quat(Mat3(flip * change.toRotationMatrix() * flip))), 1e-9);
}

}  // namespace
}  // namespace limber
