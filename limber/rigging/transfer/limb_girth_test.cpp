#include "limber/rigging/transfer/limb_girth.h"

#include <gmock/gmock.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

constexpr Index kHead = 2, kHand = 5;

LimbAlignment fitted(const std::vector<JointLandmark>& landmarks, const TriMesh& target) {
  const RiggedBody person = testing::riggedCapsulePerson();
  const std::vector<Affine> globals = restGlobals(person.skeleton);
  LimbAlignment alignment = alignLimbs(person.skeleton, globals, landmarks);
  fitGirths(person.skeleton, globals, landmarks, person.mesh, person.weights, target, alignment);
  return alignment;
}

std::vector<JointLandmark> ownLandmarks() {
  return testing::landmarksAt(testing::jointPositions(testing::riggedCapsulePerson().skeleton));
}

TEST(LimbGirthTest, OfTheSameBodyIsAsItWas) {
  const LimbAlignment alignment = fitted(ownLandmarks(), testing::riggedCapsulePerson().mesh);
  for (std::size_t j = 0; j < alignment.maps.size(); ++j) {
    EXPECT_LT((alignment.maps[j].matrix() - Affine::Identity().matrix()).norm(), 1e-3) << j;
  }
}

TEST(LimbGirthTest, OfASimilarBodyIsTheSimilarity) {
  Affine similarity = Affine::Identity();
  similarity.linear() = 0.3 * Eigen::AngleAxisd(2, Vec3(1, 2, 0).normalized()).toRotationMatrix();
  similarity.translation() = Vec3(1, 2, 3);
  std::vector<JointLandmark> landmarks = ownLandmarks();
  for (JointLandmark& landmark : landmarks) landmark.position = similarity * landmark.position;
  std::erase_if(landmarks, [](const JointLandmark& l) { return l.joint == kHand; });  // goes along with the arm
  const LimbAlignment alignment = fitted(
      landmarks,
      testing::mapped(testing::riggedCapsulePerson().mesh, [&](const Vec3& p) -> Vec3 { return similarity * p; }));
  for (std::size_t j = 0; j < alignment.maps.size(); ++j) {
    EXPECT_LT((alignment.maps[j].matrix() - similarity.matrix()).norm(), 0.01) << j;
  }
}

// A rod with a joint at 0, 1 and 2 along x, each holding what lies behind it.
RiggedBody rod(double radius) {
  RiggedBody body;
  testing::addCapsule(body.mesh, Vec3(0, 0, 0), Vec3(2.5, 0, 0), radius);
  for (int i = 0; i < 3; ++i) body.mesh = testing::cutInFour(body.mesh);
  body.weights.slots = 1;
  for (const Vec3f& p : body.mesh.positions) {
    body.weights.joints.push_back(p.x() < 1 ? 0 : p.x() < 2 ? 1 : 2);
    body.weights.weights.push_back(1);
  }
  for (Index j = 0; j < 3; ++j) {
    Joint joint;
    joint.name = std::string(1, static_cast<char>('a' + j));
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = Vec3(j > 0 ? 1 : 0, 0, 0);
    body.skeleton.joints.push_back(joint);
  }
  return body;
}

TEST(LimbGirthTest, ThickensALimbButDoesNotLengthenIt) {
  const RiggedBody thin = rod(0.1), thick = rod(0.2);
  const std::vector<Affine> globals = restGlobals(thin.skeleton);
  const std::vector<JointLandmark> landmarks = testing::landmarksAt(testing::jointPositions(thin.skeleton));
  LimbAlignment alignment = alignLimbs(thin.skeleton, globals, landmarks);
  fitGirths(thin.skeleton, globals, landmarks, thin.mesh, thin.weights, thick.mesh, alignment);
  EXPECT_LT((alignment.maps[1] * Vec3(1.5, 0.1, 0) - Vec3(1.5, 0.2, 0)).norm(), 1e-3);
  EXPECT_LT((alignment.maps[1] * Vec3(2, 0, -0.1) - Vec3(2, 0, -0.2)).norm(), 1e-3);
  const std::vector<Vec3f> surface = alignedSurface(thin.mesh.positions, thin.weights, alignment);
  for (Index v = 0; v < thin.mesh.vertexCount(); ++v) {
    if (thin.weights.jointsOf(v)[0] != 1) continue;
    ASSERT_LT((surface[v] - thick.mesh.positions[v]).norm(), 1e-3) << v;
  }
}

// A head three times as large about its joint: found, and as large all round.
TEST(LimbGirthTest, GrowsAHead) {
  const Vec3 neck = testing::personJoints()[kHead].position;
  TriMesh target = testing::riggedCapsulePerson().mesh;
  const std::size_t ofEach = target.positions.size() / testing::personJoints().size();
  for (std::size_t v = kHead * ofEach; v < (kHead + 1) * ofEach; ++v) {
    target.positions[v] = (neck + 3 * (target.positions[v].cast<double>() - neck)).cast<float>();
  }
  const LimbAlignment alignment = fitted(ownLandmarks(), target);
  EXPECT_LT((alignment.maps[kHead].linear() - 3 * Mat3::Identity()).norm(), 0.15);
  EXPECT_LT((alignment.maps[kHead] * neck - neck).norm(), 1e-6);
}

// The bones lie outside of it, as where every landmark is wrong.
TEST(LimbGirthTest, LeavesAloneWhatMeetsNothing) {
  const TriMesh target =
      testing::mapped(testing::riggedCapsulePerson().mesh, [](const Vec3& p) -> Vec3 { return p + Vec3(9, 9, 9); });
  const LimbAlignment alignment = fitted(ownLandmarks(), target);
  for (std::size_t j = 0; j < alignment.maps.size(); ++j) {
    EXPECT_LT((alignment.maps[j].matrix() - Affine::Identity().matrix()).norm(), 1e-6) << j;
  }
}

// Half of the triangles, so that rays leave through holes, and some with no area.
TEST(LimbGirthTest, TakesAnOpenTarget) {
  TriMesh target = testing::riggedCapsulePerson().mesh;
  std::erase_if(target.triangles, [](const Triangle& t) { return (t[0] + t[1] + t[2]) % 2 == 0; });
  target.triangles.push_back({0, 0, 1});
  const LimbAlignment alignment = fitted(ownLandmarks(), target);
  for (const Affine& map : alignment.maps) EXPECT_TRUE(map.matrix().allFinite());
  for (const Vec3& position : alignment.positions) EXPECT_TRUE(position.allFinite());
}

}  // namespace

}  // namespace limber
