#include "limber/actions/rig/left_out_weights.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

TEST(BindLeftOut, ShellsFollowTheSurfaceAndFloorsTheRoot) {
  FigureSurface surface;
  surface.prepared.mesh = testing::tube(8, 5, true);
  TriMesh& mesh = surface.prepared.mesh;
  SkinWeights weights;
  weights.slots = 2;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const float right = mesh.positions[v].x() + 0.5f;
    weights.joints.insert(weights.joints.end(), {2, 1});
    weights.weights.insert(weights.weights.end(), {right, 1 - right});
  }
  const SkinWeights before = weights;
  mesh.positions.push_back(0.8f * mesh.positions[17]);  // below a vertex of the middle ring
  mesh.positions.emplace_back(9, 9, 9);
  surface.innerShell = {mesh.vertexCount() - 2};
  surface.innerShellOuter = {kNoIndex};
  surface.surroundings = {mesh.vertexCount() - 1};
  weights.joints.insert(weights.joints.end(), {5, 5, 5, 5});
  weights.weights.insert(weights.weights.end(), {1, 0, 1, 0});
  EXPECT_EQ(outerVertices(surface), std::vector<Index>{17});
  surface.innerShellOuter = {3};
  EXPECT_EQ(outerVertices(surface), std::vector<Index>{3});
  surface.innerShellOuter = {kNoIndex};
  bindLeftOut(surface, weights);
  for (std::size_t i = 0; i < before.weights.size(); ++i) EXPECT_EQ(weights.weights[i], before.weights[i]);
  const Index inner = surface.innerShell[0], outside = surface.surroundings[0];
  EXPECT_EQ(weights.jointsOf(inner)[0], 2u);
  EXPECT_FLOAT_EQ(weights.weightsOf(inner)[0], before.weightsOf(17)[0]);
  EXPECT_FLOAT_EQ(weights.weightsOf(inner)[1], before.weightsOf(17)[1]);
  EXPECT_EQ(weights.jointsOf(outside)[0], 0u);
  EXPECT_EQ(weights.weightsOf(outside)[0], 1);
  EXPECT_EQ(weights.weightsOf(outside)[1], 0);
}

}  // namespace
}  // namespace limber
