#include "limber/rigging/transfer/elastic_surface.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>

#include "limber/core/random.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {

namespace {

std::vector<Vec3> positionsOf(const TriMesh& mesh) {
  std::vector<Vec3> positions;
  for (Index v = 0; v < mesh.vertexCount(); ++v) positions.push_back(mesh.position(v));
  return positions;
}

// The normal equations of the same energy, written down edge by edge and solved densely.
std::vector<Vec3> denseSolve(const ElasticSurface& surface, const std::vector<Vec3>& rest,
                             const std::vector<Mat3>& frames, double stiffness, const std::vector<double>& pulls,
                             const std::vector<Vec3>& goals) {
  const auto size = static_cast<Eigen::Index>(rest.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size), right = Eigen::MatrixXd::Zero(size, 3);
  for (const auto& edge : surface.edges()) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(size);
    row[edge.a] = 1;
    row[edge.b] = -1;
    const Vec3 wanted = (frames[edge.a] + frames[edge.b]) / 2 * (rest[edge.a] - rest[edge.b]);
    matrix += stiffness * edge.weight * row.transpose() * row;
    right += stiffness * edge.weight * row.transpose() * wanted.transpose();
  }
  for (Eigen::Index v = 0; v < size; ++v) {
    matrix(v, v) += pulls[static_cast<std::size_t>(v)];
    right.row(v) += pulls[static_cast<std::size_t>(v)] * goals[static_cast<std::size_t>(v)].transpose();
  }
  const Eigen::MatrixXd x = matrix.ldlt().solve(right);
  std::vector<Vec3> result;
  for (Eigen::Index v = 0; v < size; ++v) result.push_back(x.row(v).transpose());
  return result;
}

TEST(ElasticSurfaceTest, SolvesAsADenseSolveDoes) {
  const TriMesh two = testing::join(testing::icosphere(1), testing::moved(testing::icosphere(1), {1, 1, 1}, {3, 0, 0}));
  const std::vector<VertexPair> links = {{0, 42}, {3, 50}};
  ElasticSurface surface(two, links);
  Random random(3);
  const std::vector<Vec3> rest = positionsOf(two);
  std::vector<Mat3> frames;
  std::vector<Vec3> goals;
  std::vector<double> pulls;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    frames.push_back(Mat3::Identity() + 0.3 * Mat3::NullaryExpr([&] { return random.normal(); }));
    goals.push_back(rest[v] + Vec3::NullaryExpr([&] { return random.normal(); }));
    pulls.push_back(v % 3 == 0 ? random.uniform() : 0);
  }
  for (const double stiffness : {0.01, 1.0, 20.0}) {
    const std::vector<Vec3> x = surface.solve(frames, stiffness, pulls, goals);
    const std::vector<Vec3> dense = denseSolve(surface, rest, frames, stiffness, pulls, goals);
    for (std::size_t v = 0; v < rest.size(); ++v) ASSERT_LT((x[v] - dense[v]).norm(), 1e-9) << v;
  }
}

TEST(ElasticSurfaceTest, FramesAreTheTurnAndTheScaleOfAWhole) {
  const TriMesh sphere = testing::icosphere(2);
  const ElasticSurface surface(sphere, {});
  const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Vec3> moved = positionsOf(sphere);
  for (Vec3& p : moved) p = 1.4 * turn * p + Vec3(5, 0, 1);
  for (const Mat3& frame : surface.frames(moved)) ASSERT_LT((frame - 1.4 * turn).norm(), 1e-5);
}

TEST(ElasticSurfaceTest, StaysWhereItIsWithoutAnythingToFollow) {
  const TriMesh grid = testing::flatGrid(6, 5, 0.2f);  // open
  ElasticSurface surface(grid, {});
  const std::vector<Vec3> rest = positionsOf(grid);
  const std::vector<double> pulls(rest.size(), 0.1);
  const std::vector<Vec3> x = surface.solve(surface.frames(rest), 1, pulls, rest);
  for (std::size_t v = 0; v < rest.size(); ++v) ASSERT_LT((x[v] - rest[v]).norm(), 1e-6);
}

TEST(ElasticSurfaceTest, LinksTakeAPieceAlong) {
  const TriMesh two = testing::join(testing::icosphere(1), testing::moved(testing::icosphere(1), {1, 1, 1}, {3, 0, 0}));
  const std::vector<VertexPair> links = {{0, 42}, {3, 50}, {7, 60}};
  ElasticSurface surface(two, links);
  std::vector<Vec3> rest = positionsOf(two), goals = rest;
  std::vector<double> pulls(rest.size(), 0);
  for (std::size_t v = 0; v < 42; ++v) {
    pulls[v] = 1;
    goals[v] += Vec3(0, 2, 0);
  }
  const std::vector<Vec3> x = surface.solve(std::vector<Mat3>(rest.size(), Mat3::Identity()), 1, pulls, goals);
  for (std::size_t v = 42; v < rest.size(); ++v) ASSERT_LT((x[v] - rest[v] - Vec3(0, 2, 0)).norm(), 1e-9);
}

TEST(ElasticSurfaceTest, TakesDegenerateTriangles) {
  TriMesh mesh = testing::icosphere(1);
  mesh.positions[5] = mesh.positions[0];  // neighbours: triangles without an area
  ElasticSurface surface(mesh, {});
  const std::vector<Vec3> rest = positionsOf(mesh);
  for (const Vec3& p : surface.solve(surface.frames(rest), 1, std::vector<double>(rest.size(), 1), rest)) {
    ASSERT_TRUE(p.allFinite());
  }
}

}  // namespace

}  // namespace limber
