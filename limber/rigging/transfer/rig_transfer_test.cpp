#include "limber/rigging/transfer/rig_transfer.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

using testing::jointPositions;
using testing::landmarksAt;
using testing::riggedCapsulePerson;

constexpr double kHeight = 1.76;  // of the person

double weightOfJoint(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index slot = 0; slot < weights.slots; ++slot) {
    if (weights.jointsOf(vertex)[slot] == joint) sum += weights.weightsOf(vertex)[slot];
  }
  return sum;
}

// The mean over the first vertices, as many as `truth` has, of the sum over joints of |w - w truth|.
double meanL1(const SkinWeights& weights, const SkinWeights& truth, Index joints) {
  double sum = 0;
  for (Index v = 0; v < truth.vertexCount(); ++v) {
    for (Index j = 0; j < joints; ++j) sum += std::abs(weightOfJoint(weights, v, j) - weightOfJoint(truth, v, j));
  }
  return sum / truth.vertexCount();
}

void expectSumsOfOne(const SkinWeights& weights) {
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    double sum = 0;
    for (const float w : weights.weightsOf(v)) sum += w;
    ASSERT_NEAR(sum, 1, 1e-5) << v;
  }
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t j = 0; j < a.size(); ++j) most = std::max(most, (a[j] - b[j]).norm());
  return most;
}

double meanDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]).norm();
  return sum / static_cast<double>(a.size());
}

// Landmarks as far off as a template's are.
std::vector<JointLandmark> roughLandmarks(std::vector<Vec3> positions, double off) {
  for (std::size_t j = 0; j < positions.size(); ++j) {
    positions[j] += off * Vec3(std::sin(3.0 * j), std::cos(5.0 * j), std::sin(7.0 * j)).normalized();
  }
  return landmarksAt(positions);
}

RigTransfer transferPerson(const RiggedBody& source, const std::vector<JointLandmark>& landmarks,
                           const TriMesh& target) {
  RigTransferOptions options;
  options.registration.rounds = 2;  // quick, and enough for bodies that differ little
  Progress progress;
  return transferRig(source, landmarks, target, options, progress);
}

TEST(RigTransferTest, GivesACopyItsOwnRig) {
  const RiggedBody person = riggedCapsulePerson();
  const std::vector<Vec3> positions = jointPositions(person.skeleton);
  const RigTransfer result = transferPerson(person, roughLandmarks(positions, 0.03), person.mesh);
  EXPECT_LT(farthest(result.positions, positions), 1e-3);
  EXPECT_LT(meanL1(result.weights, person.weights, person.skeleton.jointCount()), 0.01);
  EXPECT_LT(result.gaps.rms, 0.1);
}

TEST(RigTransferTest, FollowsATurnedAndScaledCopy) {
  const RiggedBody person = riggedCapsulePerson();
  Affine map = Affine::Identity();
  map.linear() = 2.5 * Eigen::AngleAxisd(1.2, Vec3(0.3, 1, -0.2).normalized()).toRotationMatrix();
  map.translation() = Vec3(3, -1, 0.5);
  std::vector<Vec3> positions = jointPositions(person.skeleton);
  for (Vec3& position : positions) position = map * position;
  const TriMesh target = testing::mapped(person.mesh, [&](const Vec3& p) { return Vec3(map * p); });
  const RigTransfer result = transferPerson(person, roughLandmarks(positions, 0.05), target);
  EXPECT_LT(farthest(result.positions, positions), 0.01);
  EXPECT_LT(meanL1(result.weights, person.weights, person.skeleton.jointCount()), 0.02);
  for (const Quat& turn : result.turns) {
    EXPECT_LT(turn.angularDistance(Quat(Mat3(map.linear() / 2.5))), 0.03);
  }
}

TEST(RigTransferTest, GivesAFinerCopyTheSameWeights) {
  const RiggedBody person = riggedCapsulePerson();
  const std::vector<Vec3> positions = jointPositions(person.skeleton);
  const TriMesh fine = testing::cutInFour(person.mesh);
  const RigTransfer result = transferPerson(person, roughLandmarks(positions, 0.02), fine);
  EXPECT_LT(farthest(result.positions, positions), 2e-3);
  EXPECT_EQ(result.weights.vertexCount(), fine.vertexCount());
  EXPECT_LT(meanL1(result.weights, person.weights, person.skeleton.jointCount()), 0.02);
  expectSumsOfOne(result.weights);
}

// Longer legs, thicker above, bent a little forward: where the joints come to lie is known.
TEST(RigTransferTest, FollowsASmoothDeformation) {
  const RiggedBody person = riggedCapsulePerson();
  const auto deform = [](const Vec3& p) {
    const double thick = 1 + 0.15 * std::sin(2 * p.y());
    return Vec3(thick * p.x(), 1.1 * p.y() + 0.03 * std::sin(4 * p.y()), 1.2 * p.z() + 0.05 * p.y() * p.y());
  };
  std::vector<Vec3> positions = jointPositions(person.skeleton);
  for (Vec3& position : positions) position = deform(position);
  const RigTransfer result =
      transferPerson(person, roughLandmarks(positions, 0.03), testing::mapped(person.mesh, deform));
  EXPECT_LT(meanDistance(result.positions, positions), 0.01 * kHeight);
  EXPECT_LT(meanL1(result.weights, person.weights, person.skeleton.jointCount()), 0.15);
}

TEST(RigTransferTest, FollowsAnotherPose) {
  const RiggedBody person = riggedCapsulePerson();
  Skeleton lowered = person.skeleton;
  lowered.joints[*lowered.find("leftUpperArm")].rest.rotation = Quat(Eigen::AngleAxisd(-0.9, Vec3::UnitZ()));
  lowered.joints[*lowered.find("rightUpperArm")].rest.rotation = Quat(Eigen::AngleAxisd(0.9, Vec3::UnitZ()));
  const std::vector<Affine> from = restGlobals(person.skeleton), to = restGlobals(lowered);
  LimbAlignment pose;
  for (std::size_t j = 0; j < from.size(); ++j) pose.maps.push_back(to[j] * from[j].inverse());
  TriMesh target = person.mesh;
  target.positions = alignedSurface(person.mesh.positions, person.weights, pose);
  const RigTransfer result = transferPerson(person, roughLandmarks(jointPositions(lowered), 0.02), target);
  EXPECT_LT(meanDistance(result.positions, jointPositions(lowered)), 0.01 * kHeight);
  EXPECT_LT(meanL1(result.weights, person.weights, person.skeleton.jointCount()), 0.15);
}

TEST(RigTransferTest, BindsAtMostAsManyJointsAsAskedFor) {
  const RiggedBody person = riggedCapsulePerson();
  RigTransferOptions options;
  options.maxInfluences = 1;
  options.registration.reaches = {0.05};
  Progress progress;
  const RigTransfer result =
      transferRig(person, landmarksAt(jointPositions(person.skeleton)), person.mesh, options, progress);
  EXPECT_EQ(result.weights.slots, 1u);
  expectSumsOfOne(result.weights);
}

TEST(RigTransferTest, GivesTheSameEveryTime) {
  const RiggedBody person = riggedCapsulePerson();
  const auto landmarks = roughLandmarks(jointPositions(person.skeleton), 0.03);
  RigTransferOptions options;
  options.registration.reaches = {0.1, 0.02};
  options.registration.rounds = 1;
  Progress progress;
  const RigTransfer a = transferRig(person, landmarks, person.mesh, options, progress);
  const RigTransfer b = transferRig(person, landmarks, person.mesh, options, progress);
  EXPECT_EQ(a.weights.weights, b.weights.weights);
  EXPECT_EQ(a.weights.joints, b.weights.joints);
  EXPECT_EQ(farthest(a.positions, b.positions), 0);
}

}  // namespace

}  // namespace limber
