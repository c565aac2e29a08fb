#include "limber/rigging/transfer/joint_follow.h"

#include <gmock/gmock.h>

#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

TEST(JointFollowTest, GoesAlongWithAShiftExactly) {
  const RiggedBody person = testing::riggedCapsulePerson();
  const std::vector<Vec3> positions = testing::jointPositions(person.skeleton);
  std::vector<Vec3> after;
  for (Index v = 0; v < person.mesh.vertexCount(); ++v) after.push_back(person.mesh.position(v) + Vec3(0.1, -0.2, 0.3));
  const std::vector<Vec3> moved = followSurface(person.skeleton, positions, person.mesh, after, person.weights);
  for (std::size_t j = 0; j < positions.size(); ++j) {
    ASSERT_LT((moved[j] - positions[j] - Vec3(0.1, -0.2, 0.3)).norm(), 1e-9);
  }
}

TEST(JointFollowTest, FollowsASmallAffineMap) {
  const RiggedBody person = testing::riggedCapsulePerson();
  const std::vector<Vec3> positions = testing::jointPositions(person.skeleton);
  Mat3 map;
  map << 1.1, 0.05, 0, -0.04, 0.95, 0.02, 0.03, 0, 1.2;
  std::vector<Vec3> after;
  for (Index v = 0; v < person.mesh.vertexCount(); ++v) after.push_back(map * person.mesh.position(v));
  const std::vector<Vec3> moved = followSurface(person.skeleton, positions, person.mesh, after, person.weights);
  for (std::size_t j = 0; j < positions.size(); ++j) ASSERT_LT((moved[j] - map * positions[j]).norm(), 0.004) << j;
}

TEST(JointFollowTest, JointsWithoutVerticesGoAlongWithTheOneAbove) {
  RiggedBody person = testing::riggedCapsulePerson();
  Joint tip;
  tip.name = "leftHand_end";
  tip.parent = *person.skeleton.find("leftHand");
  tip.rest.translation = Vec3(0.1, 0, 0);
  person.skeleton.joints.push_back(tip);
  Joint beyond = tip;
  beyond.name = "leftHand_end_end";
  beyond.parent = person.skeleton.jointCount() - 1;
  person.skeleton.joints.push_back(beyond);
  const std::vector<Vec3> positions = testing::jointPositions(person.skeleton);
  std::vector<Vec3> after;
  for (Index v = 0; v < person.mesh.vertexCount(); ++v) after.push_back(person.mesh.position(v) + Vec3::UnitY());
  const std::vector<Vec3> moved = followSurface(person.skeleton, positions, person.mesh, after, person.weights);
  EXPECT_LT((moved.back() - positions.back() - Vec3::UnitY()).norm(), 1e-9);
}

}  // namespace

}  // namespace limber
