// Multigrid against the factorisation, over surfaces of many shapes.
#include "limber/geometry/solve/multigrid.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {
namespace {

using testing::catalogue;
using testing::NamedMesh;
using Sparse = Eigen::SparseMatrix<double>;

constexpr float kTolerance = 1e-5f;

// Heat that leaves each vertex, some faster; with the right-hand side `leaving` every vertex stays at 1.
struct PinnedSurface {
  Sparse lower;
  Eigen::VectorXd leaving;
};

PinnedSurface pinnedSurface(const TriMesh& mesh) {
  Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  PinnedSurface result{laplacian.stiffness, Eigen::VectorXd(laplacian.mass.size())};
  for (int v = 0; v < result.leaving.size(); ++v) {
    result.leaving[v] = (laplacian.mass[v] > 0 ? laplacian.mass[v] : 1) * (1 + 40 * (v % 7));
    result.lower.coeffRef(v, v) += result.leaving[v];
  }
  return result;
}

// Every k-th unknown is pulled to 1 in the k-th of so many right-hand sides, to 0 in the others: solutions sum to 1.
std::vector<std::vector<Multigrid::Entry>> sharedSources(const PinnedSurface& surface, int count) {
  std::vector<std::vector<Multigrid::Entry>> result(count);
  for (int v = 0; v < surface.leaving.size(); ++v) {
    result[v % count].push_back({static_cast<Index>(v), surface.leaving[v]});
  }
  return result;
}

Eigen::MatrixXd solved(const Multigrid& multigrid, const std::vector<std::vector<Multigrid::Entry>>& right,
                       Index rows) {
  Multigrid::Scratch scratch(multigrid);
  const std::vector<std::span<const Multigrid::Entry>> spans(right.begin(), right.end());
  Eigen::MatrixXd result;
  for (int again = 0; again < 2; ++again) {  // what one solve leaves behind is not in the next
    EXPECT_TRUE(multigrid.solve(spans, kTolerance, scratch));
    const Eigen::MatrixXd before = result;
    result = Eigen::MatrixXd::Zero(rows, static_cast<int>(right.size()));
    scratch.forEachSolution([&](Index v, const float* x) {
      for (int k = 0; k < result.cols(); ++k) result(v, k) = x[k];
    });
    EXPECT_TRUE(!again || result == before);
  }
  return result;
}

// Five right-hand sides whose solutions sum to 1.
void expectAsFactored(const TriMesh& mesh, Index directBelow) {
  const PinnedSurface surface = pinnedSurface(mesh);
  const Index rows = mesh.vertexCount();
  const Multigrid multigrid(surface.lower, directBelow);
  const auto right = sharedSources(surface, 5);
  const Eigen::MatrixXd found = solved(multigrid, right, rows);

  SparseCholesky cholesky(surface.lower);
  cholesky.factorize(surface.lower);
  std::vector<double> x(rows * std::size_t{SparseCholesky::kColumns}, 0);
  for (std::size_t k = 0; k < right.size(); ++k) {
    for (const auto& [v, value] : right[k]) x[cholesky.rowOf(v) * std::size_t{SparseCholesky::kColumns} + k] = value;
  }
  cholesky.solve(x.data());
  for (Index v = 0; v < rows; ++v) {
    for (int k = 0; k < found.cols(); ++k) {
      ASSERT_NEAR(found(v, k),
                  x[cholesky.rowOf(v) * std::size_t{SparseCholesky::kColumns} + static_cast<std::size_t>(k)], 1e-4)
          << v << ' ' << k;
    }
    ASSERT_NEAR(found.row(v).sum(), 1, 5e-4) << v;
  }
}

class MultigridCatalogue : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(MultigridCatalogue, SolvesAsTheFactorisationDoes) {
  expectAsFactored(GetParam().mesh, 12);
}

INSTANTIATE_TEST_SUITE_P(, MultigridCatalogue, ::testing::ValuesIn(catalogue()), testing::MeshName());

// Passes over them run one behind the other, a thousand rows at a time.
TEST(Multigrid, SurfacesOfManyThousandsAreSolvedAsTheFactorisationDoes) {
  expectAsFactored(testing::icosphere(5), 300);
  expectAsFactored(testing::tube(24, 400, false), 300);
  expectAsFactored(testing::soup(5000, 12000, 3), 300);
}

TEST(Multigrid, LooksOnlyWhereTheSolutionLives) {
  const TriMesh strip = testing::flatGrid(600, 3);
  Sparse lower = robustLaplacian(strip, vertexComponents(strip)).stiffness;
  for (int v = 0; v < lower.cols(); ++v) lower.coeffRef(v, v) += 0.1;
  const Multigrid multigrid(lower, 50);
  Multigrid::Scratch scratch(multigrid);
  const std::vector<Multigrid::Entry> source = {{0, 0.1}};
  const std::vector<std::span<const Multigrid::Entry>> right = {source};
  ASSERT_TRUE(multigrid.solve(right, kTolerance, scratch));
  int reached = 0;
  float highest = 0;
  scratch.forEachSolution([&](Index, const float* x) {
    ++reached;
    highest = std::max(highest, x[0]);
  });
  EXPECT_GT(highest, 0.005);
  EXPECT_LT(reached, static_cast<int>(lower.cols()) / 4);
}

TEST(Multigrid, TheOrderOfUnknownsChangesNoSolution) {
  const TriMesh ball = testing::icosphere(3);
  TriMesh turned = ball;
  const Index count = ball.vertexCount();
  for (Index v = 0; v < count; ++v) turned.positions[count - 1 - v] = ball.positions[v];
  for (Triangle& triangle : turned.triangles) {
    for (Index& v : triangle) v = count - 1 - v;
  }
  const auto heat = [&](const TriMesh& mesh, Index from) {
    Sparse lower = robustLaplacian(mesh, vertexComponents(mesh)).stiffness;
    for (int v = 0; v < lower.cols(); ++v) lower.coeffRef(v, v) += 0.01;
    return solved(Multigrid(lower, 20), {{{from, 1.0}}}, count);
  };
  const Eigen::MatrixXd one = heat(ball, 5), other = heat(turned, count - 1 - 5);
  EXPECT_LT((one - other.colwise().reverse()).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace limber
