// Dolls of overlapping balls, whose skeletons tell more or less of how they hang together.
#include "limber/rigging/weights/jointed_pieces.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/bone_heat.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::countOf;

// A body on its own joint 0, a thigh and a shin on 1 and 2, a head on 3, an ear on the head without a joint, and a hat
// on the ear.
struct Doll {
  TriMesh mesh;
  std::vector<Bone> bones;
  std::vector<Index> expected = {0, 1, 2, 3, 3, 3};

  Doll() {
    addBall({0, 0, 0}, {0.2f, 0.3f, 0.15f});
    addBall({0, -0.45f, 0}, {0.08f, 0.2f, 0.08f});
    addBall({0, -0.8f, 0}, {0.07f, 0.2f, 0.07f});
    addBall({0, 0.45f, 0}, {0.2f, 0.2f, 0.2f});
    addBall({0.16f, 0.62f, 0}, {0.06f, 0.06f, 0.03f});
    addBall({0.19f, 0.72f, 0}, {0.05f, 0.05f, 0.05f});
    addBone(0, {0, -0.1, 0}, {0, 0.2, 0}, std::nullopt);
    addBone(1, {0, -0.28, 0}, {0, -0.62, 0}, 0);
    addBone(2, {0, -0.62, 0}, {0, -0.9, 0}, 1);
    addBone(3, {0, 0.28, 0}, {0, 0.6, 0}, 0);
  }

  void addBall(const Vec3f& at, const Vec3f& size) {
    const TriMesh ball = testing::moved(testing::icosphere(2), size, at);
    mesh = mesh.vertexCount() == 0 ? ball : testing::join(mesh, ball);
  }

  void addBone(Index joint, const Vec3& a, const Vec3& b, std::optional<Index> parent) {
    Bone bone;
    bone.joint = joint;
    bone.a = a;
    bone.b = b;
    bone.parent = parent;
    bones.push_back(bone);
  }

  std::optional<std::vector<Index>> joints() const {
    Index count = 0;
    Progress progress;
    const std::vector<Index> piece = vertexComponents(mesh, &count);
    const std::optional<PieceBinding> binding = jointsOfPieces(mesh, piece, count, bones, progress);
    if (!binding) return std::nullopt;
    std::vector<Index> result;
    for (const std::optional<Index>& joint : *binding) result.push_back(joint.value_or(kNoIndex));
    return result;
  }
};

TEST(JointedPieces, EachPieceFollowsTheJointThatItTurnsAbout) {
  EXPECT_EQ(Doll().joints(), Doll().expected);
}

TEST(JointedPieces, ALeafThatPointsAnywhereChangesNothing) {
  Doll doll;
  doll.bones[3].b = {0, -0.8, 0};
  doll.bones[2].b = {0.5, 0.5, 0};
  EXPECT_EQ(doll.joints(), doll.expected);
}

TEST(JointedPieces, JointsInAListHangTogetherAsTheirPiecesDo) {
  Doll doll;
  for (Bone& bone : doll.bones) bone.parent.reset();
  EXPECT_EQ(doll.joints(), doll.expected);
  for (Index i = 1; i < 4; ++i) doll.bones[i].parent = 0;
  EXPECT_EQ(doll.joints(), doll.expected);
}

TEST(JointedPieces, ARootMayLieAnywhere) {
  Doll doll;
  doll.bones[0].a = doll.bones[0].b = {0, -1.2, 0.4};
  EXPECT_EQ(doll.joints(), doll.expected);
}

TEST(JointedPieces, InsideOutPiecesAndLooseVerticesDoNotMatter) {
  Doll doll;
  for (Triangle& t : doll.mesh.triangles) std::swap(t[0], t[1]);
  doll.mesh.positions.push_back({0.3f, -0.9f, 0.1f});
  std::vector<Index> expected = doll.expected;
  expected.push_back(2);
  EXPECT_EQ(doll.joints(), expected);
}

TEST(JointedPieces, NoneWhereAJointHasNoPieceOfItsOwn) {
  Doll doll;
  doll.addBone(4, {0, 0.1, 0}, {0, 0.28, 0}, 0);  // a chest, which bends the body
  EXPECT_EQ(doll.joints(), std::nullopt);
}

TEST(JointedPieces, NoneWhereOneSkinRunsThroughAllJoints) {
  Doll doll;
  doll.mesh = {};
  doll.bones.pop_back();
  doll.addBall({0, -0.3f, 0}, {0.15f, 0.8f, 0.15f});
  for (const float height : {-0.28f, -0.62f}) doll.addBall({0, height, 0}, {0.18f, 0.04f, 0.18f});  // bands about it
  EXPECT_EQ(doll.joints(), std::nullopt);
}

TEST(JointedPieces, ManyLoosePiecesAllFindTheirPart) {
  Doll doll;
  for (int i = 0; i < 300; ++i) {
    const double turn = 0.7 * i, height = -0.9 + 1.5 * i / 300;
    doll.addBall(Vec3(0.4 * std::cos(turn), height, 0.4 * std::sin(turn)).cast<float>(), Vec3f::Constant(0.01f));
  }
  const std::optional<std::vector<Index>> joints = doll.joints();
  ASSERT_TRUE(joints);
  EXPECT_EQ((*joints)[6], 2u);
  EXPECT_EQ(joints->back(), 3u);
}

TEST(JointedPieces, WeightsAreOfOneJointAndAreSaidToBe) {
  const Doll doll;
  Progress progress;
  const WeightResult rigid = boneHeatWeights(doll.mesh, doll.bones, {}, progress);
  Index count = 0;
  const std::vector<Index> piece = vertexComponents(doll.mesh, &count);
  for (Index v = 0; v < doll.mesh.vertexCount(); ++v) {
    EXPECT_EQ(rigid.weights.jointsOf(v)[0], doll.expected[piece[v]]);
    EXPECT_EQ(rigid.weights.weightsOf(v)[0], 1);
  }
  EXPECT_EQ(countOf(rigid.warnings, "rigid-pieces"), 6u);
  WeightOptions soft;
  soft.pieces = PieceMode::kSoft;
  const WeightResult bent = boneHeatWeights(doll.mesh, doll.bones, soft, progress);
  EXPECT_EQ(countOf(bent.warnings, "rigid-pieces"), 0u);
  EXPECT_LT(*std::min_element(bent.weights.weights.begin(), bent.weights.weights.end()), 1);
}

TEST(JointedPieces, RigidBindsWhatWouldBend) {
  Doll doll;
  doll.addBone(4, {0, 0.1, 0}, {0, 0.28, 0}, 0);
  WeightOptions options;
  options.pieces = PieceMode::kRigid;
  Progress progress;
  const WeightResult result = boneHeatWeights(doll.mesh, doll.bones, options, progress);
  for (Index v = 0; v < doll.mesh.vertexCount(); ++v) EXPECT_EQ(result.weights.weightsOf(v)[0], 1);
  EXPECT_EQ(countOf(result.warnings, "rigid-pieces"), 6u);
}

}  // namespace
}  // namespace limber
