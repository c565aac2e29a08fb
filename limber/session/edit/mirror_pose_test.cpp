#include "limber/session/edit/mirror_pose.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// hip on the plane; a leg of two joints on each side, whose own axes differ from side to side; a tail without image.
Skeleton walker() {
  Skeleton skeleton;
  const auto add = [&](const char* name, std::optional<Index> parent, const Vec3& at, const Quat& turned) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.rest.translation = at;
    joint.rest.rotation = turned;
    skeleton.joints.push_back(joint);
  };
  const Quat some(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), none = Quat::Identity();
  add("hip", std::nullopt, {2, 1, 0}, none);
  add("leg.L", 0, {0.2, -0.1, 0}, none);
  add("leg.R", 0, {-0.2, -0.1, 0}, some);
  add("foot.L", 1, {0.1, -0.5, 0.2}, some);
  add("foot.R", 2, some.conjugate() * Vec3(-0.1, -0.5, 0.2), none);
  add("tail", 0, {0.05, 0, -0.4}, none);
  return skeleton;
}

const MirrorPlane kPlane{Vec3::UnitX(), 2};

Vec3 mirrored(const Vec3& p) {
  return {4 - p.x(), p.y(), p.z()};
}

Pose bent(const Skeleton& skeleton) {
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < pose.locals.size(); ++j) {
    const Quat turn(Eigen::AngleAxisd(0.3 + 0.2 * j, Vec3(1, 0.5 * j, -1).normalized()));
    pose.locals[j].rotation = (turn * pose.locals[j].rotation).normalized();
  }
  pose.locals[0].translation += Vec3(0.3, 0.1, 0.2);
  return pose;
}

// Where points fixed to each joint at rest go, the joint's origin and two beside it.
std::vector<Vec3> pointsOf(const Skeleton& skeleton, const Pose& pose, Index joint, bool image) {
  const Affine rest = restGlobals(skeleton)[joint], posed = poseGlobals(skeleton, pose)[joint];
  std::vector<Vec3> points;
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(0.1, 0.2, 0), Vec3(0, -0.1, 0.3)}) {
    const Vec3 at = rest.translation() + (image ? Vec3(-offset.x(), offset.y(), offset.z()) : offset);
    points.push_back(posed * rest.inverse(Eigen::Affine) * at);
  }
  return points;
}

TEST(MirrorPose, FindsImagesByWhereJointsStand) {
  EXPECT_EQ(mirrorJoints(walker(), kPlane, 0.01), (std::vector<Index>{0, 2, 1, 4, 3, kNoIndex}));
}

TEST(MirrorPose, EveryPointOfAJointGoesWhereTheImagesWent) {
  const Skeleton skeleton = walker();
  const Pose pose = bent(skeleton);
  const std::vector<Index> images = mirrorJoints(skeleton, kPlane, 0.01);
  const Pose mirror = mirrorPose(skeleton, pose, kPlane, images, MirrorFrom::kBoth);
  for (Index j = 0; j < 5; ++j) {
    const auto got = pointsOf(skeleton, mirror, j, false), want = pointsOf(skeleton, pose, images[j], true);
    for (std::size_t p = 0; p < got.size(); ++p) EXPECT_LT((got[p] - mirrored(want[p])).norm(), 1e-12) << j;
  }
  const Pose twice = mirrorPose(skeleton, mirror, kPlane, images, MirrorFrom::kBoth);
  for (Index j = 0; j < 6; ++j) {
    EXPECT_LT((twice.locals[j].translation - pose.locals[j].translation).norm(), 1e-12);
    EXPECT_LT(twice.locals[j].rotation.angularDistance(pose.locals[j].rotation), 1e-7);
  }
}

TEST(MirrorPose, OneSideStaysAndTheWholeBecomesSymmetric) {
  const Skeleton skeleton = walker();
  const Pose pose = bent(skeleton);
  const std::vector<Index> images = mirrorJoints(skeleton, kPlane, 0.01);
  for (const MirrorFrom from : {MirrorFrom::kLeft, MirrorFrom::kRight}) {
    const Pose result = mirrorPose(skeleton, pose, kPlane, images, from);
    for (Index j = 0; j < 5; ++j) {
      const auto got = pointsOf(skeleton, result, j, false), image = pointsOf(skeleton, result, images[j], true);
      for (std::size_t p = 0; p < got.size(); ++p) EXPECT_LT((got[p] - mirrored(image[p])).norm(), 1e-9) << j;
    }
    const Index kept = from == MirrorFrom::kLeft ? 3 : 4;
    const auto before = pointsOf(skeleton, pose, kept, false), after = pointsOf(skeleton, result, kept, false);
    for (std::size_t p = 0; p < before.size(); ++p) EXPECT_LT((before[p] - after[p]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace limber
