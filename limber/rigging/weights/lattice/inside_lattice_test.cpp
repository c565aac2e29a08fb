// Lattices against asking every node of the grid, over all kinds of meshes.
#include "limber/rigging/weights/lattice/inside_lattice.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using testing::NamedMesh;

class InsideLatticeOf : public ::testing::TestWithParam<NamedMesh> {};

// Nodes near the surface are cells whatever the mesh. Where it is closed, so are those inside, and no others.
TEST_P(InsideLatticeOf, HoldsWhatIsInsideOrNear) {
  const TriMesh& mesh = GetParam().mesh;
  const InsideQueries queries(mesh);
  const InsideLattice lattice(mesh, queries, 20);
  Index wrong = 0, count = 0;
  for (Index cell = 0; cell < lattice.cellCount(); ++cell) {
    const Vec3 position = lattice.position(cell);
    const bool near = queries.surface->nearestPoint(position).distance < 0.87 * lattice.spacing();
    wrong += !near && queries.winding->at(position) <= 0.5;
    ++count;
    // All neighbors that should be there are.
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 beside = position + lattice.spacing() * Vec3::Unit(axis);
      const bool isNear = queries.surface->nearestPoint(beside).distance < 0.8699 * lattice.spacing();
      const Index next = lattice.neighbor(cell, lattice.step(axis == 0, axis == 1, axis == 2));
      if (isNear) {
        ASSERT_NE(next, kNoIndex);
      } else if (next == kNoIndex) {
        wrong += queries.winding->at(beside) > 0.5;
      }
      if (next != kNoIndex) {
        ASSERT_LT((lattice.position(next) - beside).norm(), 1e-9);
      }
    }
  }
  ASSERT_GT(count, 0u);
  const bool isClosed = GetParam().name == "closed" || GetParam().name == "capped tube" ||
                        GetParam().name == "many pieces" || GetParam().name == "crossing";
  EXPECT_LE(wrong, isClosed ? 0 : count / 20);
}

INSTANTIATE_TEST_SUITE_P(, InsideLatticeOf, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST(InsideLattice, ABonesCellsLieOnIt) {
  const TriMesh ball = testing::moved(testing::icosphere(2), {0.5f, 0.5f, 0.5f}, Vec3f::Zero());
  InsideLattice lattice(ball, InsideQueries(ball), 16);
  const Index inside = lattice.cellCount();
  const Bone bone{3, {-0.3, 0.1, 0}, {0.52, 0.1, 0}, 0};
  const std::vector<Index> cells = lattice.cellsAlong(bone);
  ASSERT_FALSE(cells.empty());
  for (const Index cell : cells) {
    const Vec3 position = lattice.position(cell);
    EXPECT_LE(std::abs(position.y() - 0.1), 0.501 * lattice.spacing());
    EXPECT_LE(std::abs(position.z()), 0.501 * lattice.spacing());
  }
  EXPECT_LE(lattice.cellCount(), inside + 2);
  EXPECT_TRUE(lattice.cellsAlong({0, {90, 0, 0}, {91, 0, 0}, 0}).empty());
}

TEST(InsideLattice, PartsOfTheCellsRoundAPlaceAreItsInterpolation) {
  const TriMesh ball = testing::moved(testing::icosphere(2), {0.5f, 0.5f, 0.5f}, Vec3f::Zero());
  const InsideLattice lattice(ball, InsideQueries(ball), 16);
  const Vec3 position(0.11, -0.07, 0.2);
  std::array<Index, 8> cells;
  std::array<double, 8> parts;
  ASSERT_EQ(lattice.cellsRound(position, cells, parts), 8);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 8; ++i) sum += parts[i] * lattice.position(cells[i]);
  EXPECT_LT((sum - position).norm(), 1e-9);
}

TEST(InsideLattice, RefusesWhatItCannotMake) {
  const TriMesh ball = testing::icosphere(1);
  const InsideQueries queries(ball);
  EXPECT_THROW(InsideLattice(ball, queries, 7), Error);
  EXPECT_THROW(InsideLattice(ball, queries, 513), Error);
}

}  // namespace
}  // namespace limber
