#include "limber/rigging/transfer/limb_alignment.h"

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

using testing::jointPositions;
using testing::landmarksAt;

const Affine& similarity() {
  static const Affine map = [] {
    Affine result = Affine::Identity();
    result.linear() = 0.6 * Eigen::AngleAxisd(0.8, Vec3(1, 1, 0).normalized()).toRotationMatrix();
    result.translation() = Vec3(1, 2, 3);
    return result;
  }();
  return map;
}

TEST(LimbAlignmentTest, OfASimilarBodyIsTheSimilarity) {
  const Skeleton skeleton = testing::riggedCapsulePerson().skeleton;
  std::vector<Vec3> positions = jointPositions(skeleton);
  for (Vec3& position : positions) position = similarity() * position;
  std::vector<JointLandmark> landmarks = landmarksAt(positions);
  std::erase_if(landmarks, [](const JointLandmark& l) { return l.joint == 1 || l.joint == 4 || l.joint == 5; });
  const LimbAlignment alignment = alignLimbs(skeleton, restGlobals(skeleton), landmarks);
  for (std::size_t j = 0; j < positions.size(); ++j) {
    EXPECT_LT((alignment.positions[j] - positions[j]).norm(), 1e-6) << j;
    EXPECT_LT((alignment.maps[j].matrix() - similarity().matrix()).norm(), 1e-5) << j;
  }
}

TEST(LimbAlignmentTest, TakesTheSurfaceAlongALimb) {
  const RiggedBody person = testing::riggedCapsulePerson();
  std::vector<Vec3> positions = jointPositions(person.skeleton);
  const Vec3 shoulder = positions[3];
  positions[4] = shoulder + Vec3(0, -0.4, 0);  // the upper arm hangs, and is longer
  positions[5] = positions[4] + Vec3(0, -0.25, 0);
  const LimbAlignment alignment = alignLimbs(person.skeleton, restGlobals(person.skeleton), landmarksAt(positions));
  EXPECT_LT((alignment.maps[3] * jointPositions(person.skeleton)[4] - positions[4]).norm(), 1e-6);
  EXPECT_LT((alignment.maps[4] * jointPositions(person.skeleton)[5] - positions[5]).norm(), 1e-6);
  // What lies across keeps its size, but for the scale of the whole.
  const Vec3 along = (jointPositions(person.skeleton)[4] - shoulder).normalized(), across = along.unitOrthogonal();
  EXPECT_NEAR((alignment.maps[3].linear() * across).norm(), std::cbrt(alignment.whole.linear().determinant()), 1e-6);
}

// Hips without a landmark lie by the legs, wherever head and arms are.
TEST(LimbAlignmentTest, NearLandmarksTellMoreThanFarOnes) {
  const Skeleton skeleton = testing::riggedCapsulePerson().skeleton;
  std::vector<Vec3> positions = jointPositions(skeleton);
  const Vec3 hips = positions[0];
  for (Index j = 2; j <= 8; ++j) positions[j] += Vec3(0, 0.5, 0);
  std::vector<JointLandmark> landmarks = landmarksAt(positions);
  std::erase_if(landmarks, [](const JointLandmark& l) { return l.joint <= 1; });
  const LimbAlignment alignment = alignLimbs(skeleton, restGlobals(skeleton), landmarks);
  EXPECT_LT((alignment.positions[0] - hips).norm(), 0.05);
}

TEST(LimbAlignmentTest, RefusesLandmarksThatFitNoJoint) {
  const Skeleton skeleton = testing::riggedCapsulePerson().skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  using Landmarks = std::vector<JointLandmark>;
  for (const Landmarks& landmarks :
       {Landmarks{}, Landmarks{{0, Vec3::Zero()}, {1, Vec3::UnitX()}}, Landmarks{{0, {}}, {1, {}}, {1, {}}},
        Landmarks{{0, Vec3::Zero()}, {1, Vec3::UnitX()}, {99, Vec3::UnitY()}}}) {
    EXPECT_THROW(alignLimbs(skeleton, globals, landmarks), Error);
  }
}

TEST(LimbAlignmentTest, MovedSkeletonsKeepNamesTreeAndScales) {
  Skeleton skeleton = testing::riggedCapsulePerson().skeleton;
  skeleton.joints[0].rest.scale = Vec3::Constant(100);  // as exporters in centimetres have it
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<Vec3> positions = jointPositions(skeleton);
  for (Vec3& position : positions) position = similarity() * position;
  const std::vector<Quat> turns = turnsBetween(skeleton, globals, positions, Quat(Mat3(similarity().linear() / 0.6)));
  const Skeleton moved = movedSkeleton(skeleton, globals, positions, turns);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    EXPECT_EQ(moved.joints[j].name, skeleton.joints[j].name);
    EXPECT_EQ(moved.joints[j].parent, skeleton.joints[j].parent);
    EXPECT_LT((moved.joints[j].rest.scale - skeleton.joints[j].rest.scale).norm(), 1e-6);
    EXPECT_LT((jointPositions(moved)[j] - positions[j]).norm(), 1e-6);
    if (!skeleton.joints[j].parent) continue;
    EXPECT_LT(moved.joints[j].rest.rotation.angularDistance(skeleton.joints[j].rest.rotation), 1e-5);
  }
}

}  // namespace

}  // namespace limber
