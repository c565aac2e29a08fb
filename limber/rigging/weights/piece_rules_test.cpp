// Hard parts and hidden pieces, on machines and bodies put together from tubes and balls.
#include "limber/rigging/weights/piece_rules.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/bone_heat.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::countOf;

TriMesh tubeAt(float x, float length, float thickness = 0.5f) {
  return testing::moved(testing::tube(10, 9, true), {length, thickness, thickness}, {x, 0, 0});
}

Bone bone(Index joint, double from, double to) {
  return {joint, {from, 0, 0}, {to, 0, 0}, 0};
}

// Three links of a crane, each a closed tube that reaches a little into the next, and a ball at the second joint.
struct Machine {
  TriMesh mesh;
  std::vector<Bone> bones = {bone(0, -0.5, -0.15), bone(1, -0.15, 0.15), bone(2, 0.15, 0.5)};
  Index ballBegin = 0, ballEnd = 0;

  Machine() {
    mesh = testing::join(testing::join(tubeAt(-0.32f, 0.38f), tubeAt(0, 0.26f)), tubeAt(0.32f, 0.38f));
    ballBegin = mesh.vertexCount();
    mesh = testing::join(mesh, testing::moved(testing::icosphere(1), Vec3f::Constant(0.09f), {0.15f, 0, 0}));
    ballEnd = mesh.vertexCount();
  }
};

WeightResult heat(const TriMesh& mesh, std::span<const Bone> bones, bool rules = true) {
  Progress progress;
  WeightOptions options;
  if (!rules) options.pieces = PieceMode::kSoft;
  return boneHeatWeights(mesh, bones, options, progress);
}

// The joint that the vertices begin <= v < end follow alone, if it is one.
std::optional<Index> soleJoint(const SkinWeights& weights, Index begin, Index end) {
  for (Index v = begin; v < end; ++v) {
    if (weights.weightsOf(v)[0] != 1 || weights.jointsOf(v)[0] != weights.jointsOf(begin)[0]) return std::nullopt;
  }
  return weights.jointsOf(begin)[0];
}

TEST(PieceRules, LinksOfAMachineFollowOneJointEach) {
  const Machine machine;
  const Index link = (machine.ballBegin) / 3;
  const WeightResult soft = heat(machine.mesh, machine.bones, false);
  EXPECT_FALSE(soleJoint(soft.weights, 0, link));
  const WeightResult result = heat(machine.mesh, machine.bones);
  EXPECT_EQ(soleJoint(result.weights, 0, link), 0u);
  EXPECT_EQ(soleJoint(result.weights, link, 2 * link), 1u);
  EXPECT_EQ(soleJoint(result.weights, 2 * link, 3 * link), 2u);
  EXPECT_EQ(countOf(result.warnings, "rigid-pieces"), 4u);
}

TEST(PieceRules, BallTurnsWithTheJointAtItsMiddle) {
  const Machine machine;
  EXPECT_EQ(soleJoint(heat(machine.mesh, machine.bones).weights, machine.ballBegin, machine.ballEnd), 2u);
}

TEST(PieceRules, BodyStaysSoftAndItsButtonFollowsWhole) {
  const TriMesh body = testing::tube(16, 41, true);
  TriMesh mesh = testing::join(body, testing::moved(testing::icosphere(1), Vec3f::Constant(0.02f), {0.3f, 0.13f, 0}));
  const Bone bones[] = {bone(0, -0.5, -0.2), bone(1, -0.2, 0.1), bone(2, 0.1, 0.5)};
  const WeightResult result = heat(mesh, bones), soft = heat(mesh, bones, false);
  EXPECT_EQ(soleJoint(result.weights, body.vertexCount(), mesh.vertexCount()), 2u);
  for (Index v = 0; v < body.vertexCount(); ++v) {
    EXPECT_EQ(result.weights.weightsOf(v)[0], soft.weights.weightsOf(v)[0]) << v;
  }
}

TEST(PieceRules, OnePieceIsNeverRigid) {
  const Bone bones[] = {bone(0, -0.5, 0.4), bone(1, 0.4, 0.5)};
  const WeightResult result = heat(testing::tube(16, 41, true), bones);
  EXPECT_EQ(countOf(result.warnings, "rigid-pieces"), 0u);
  EXPECT_FALSE(soleJoint(result.weights, 0, result.weights.vertexCount()));
}

TEST(PieceRules, HandlesMoveWhatIsRoundThem) {
  const Machine machine;
  std::vector<Bone> handles;
  for (const double x : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
    handles.push_back({static_cast<Index>(handles.size()), {x, 0, 0}, {x, 0, 0}, 0.05});
  }
  const WeightResult result = heat(machine.mesh, handles);
  EXPECT_EQ(countOf(result.warnings, "rigid-pieces"), 0u);
  EXPECT_EQ(result.weights.weights, heat(machine.mesh, handles, false).weights.weights);
}

// Ten vertices of a sleeve, of which `seeing` see a bone, beside a body that sees all.
TEST(PieceRules, PieceThatHardlySeesABoneIsLeftToItsNeighbours) {
  const TriMesh body = testing::icosphere(2);
  const TriMesh mesh = testing::join(body, testing::moved(testing::icosphere(0), Vec3f::Constant(0.1f), {2, 0, 0}));
  const std::vector<Index> piece = vertexComponents(mesh);
  const Bone bones[] = {bone(0, -0.5, 0), bone(1, 0, 0.5), bone(2, 0.5, 1), bone(3, 1, 2), bone(4, 2, 3)};
  for (const int seeing : {0, 2, 4}) {
    std::vector<double> pull(mesh.vertexCount(), 0);
    std::fill_n(pull.begin(), body.vertexCount() + seeing, 1.0);
    InfluenceTable table(mesh.vertexCount(), 4);
    for (Index v = 0; v < mesh.vertexCount(); ++v) table.offer(v, v % 5, 1);
    const PieceRules rules(mesh, bones, piece, 2, pull);
    rules.dropHardlySeen(table);
    const bool kept = seeing >= 3;  // a quarter of its 12
    for (Index v = 0; v < mesh.vertexCount(); ++v) {
      EXPECT_EQ(table.weightsOf(v)[0] > 0, v < body.vertexCount() || kept) << v << " of " << seeing;
    }
  }
}

TEST(PieceRules, WhereEveryPieceIsHiddenNoneIsDropped) {
  const TriMesh mesh =
      testing::join(testing::icosphere(0), testing::moved(testing::icosphere(0), Vec3f::Ones(), {5, 0, 0}));
  std::vector<double> pull(mesh.vertexCount(), 0);
  pull[0] = 1;
  InfluenceTable table(mesh.vertexCount(), 4);
  for (Index v = 0; v < mesh.vertexCount(); ++v) table.offer(v, 0, 1);
  const Bone bones[] = {bone(0, 0, 1)};
  PieceRules(mesh, bones, vertexComponents(mesh), 2, pull).dropHardlySeen(table);
  for (Index v = 0; v < mesh.vertexCount(); ++v) EXPECT_EQ(table.weightsOf(v)[0], 1);
}

// A loose vertex may see a bone when the surface does not; there is nothing to take its weights from.
TEST(PieceRules, ALooseVertexInSightDoesNotBareTheSurface) {
  TriMesh mesh = testing::moved(testing::icosphere(1), Vec3f::Constant(0.5f), {0, 0, 0});
  mesh.positions.push_back(Vec3f(0.9f, 0, 0));
  const std::vector<Bone> bones = {bone(0, 0.8, 0.95), bone(1, 0.95, 1)};
  const WeightResult result = heat(mesh, bones);
  for (Index v = 0; v < mesh.vertexCount(); ++v) EXPECT_GT(result.weights.weightsOf(v)[0], 0.0f);
}

}  // namespace
}  // namespace limber
