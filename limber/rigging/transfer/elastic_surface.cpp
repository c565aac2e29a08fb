#include "limber/rigging/transfer/elastic_surface.h"

#include <algorithm>
#include <cmath>

#include "limber/core/parallel.h"
#include "limber/core/rotation_fit.h"
#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

// Cotangents of both corners opposite an edge add up to 1.15 where triangles are equilateral. Below the first an edge
// would hold next to nothing, above the second, in slivers, it would be a rod.
constexpr double kMinWeight = 0.05, kMaxWeight = 10;
constexpr double kLinkWeight = 1;
constexpr double kMinScale = 0.5, kMaxScale = 2;
constexpr std::size_t kGrain = 512;

using Edge = ElasticSurface::Edge;

Edge edgeOf(Index a, Index b, double weight) {
  return {std::min(a, b), std::max(a, b), weight};
}

std::vector<Edge> weightedEdges(const TriMesh& rest, std::span<const VertexPair> links) {
  std::vector<Edge> edges;
  for (const Triangle& t : rest.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Index a = t[(corner + 1) % 3], b = t[(corner + 2) % 3];
      const Vec3 u = rest.position(a) - rest.position(t[corner]), v = rest.position(b) - rest.position(t[corner]);
      const double area = u.cross(v).norm();
      edges.push_back(edgeOf(a, b, area > 0 ? 0.5 * std::clamp(u.dot(v) / area, -kMaxWeight, kMaxWeight) : 0));
    }
  }
  const auto before = [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; };
  std::stable_sort(edges.begin(), edges.end(), before);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (kept > 0 && edges[kept - 1].a == edges[i].a && edges[kept - 1].b == edges[i].b) {
      edges[kept - 1].weight += edges[i].weight;
    } else {
      edges[kept++] = edges[i];
    }
  }
  edges.resize(kept);
  for (Edge& edge : edges) edge.weight = std::clamp(edge.weight, kMinWeight, kMaxWeight);
  for (const VertexPair& link : links) edges.push_back(edgeOf(link[0], link[1], kLinkWeight));
  std::stable_sort(edges.begin(), edges.end(), before);
  return edges;
}

}  // namespace

ElasticSurface::ElasticSurface(const TriMesh& rest, std::span<const VertexPair> links)
    : masses_(vertexAreas(rest)), edges_(weightedEdges(rest, links)) {
  for (Index v = 0; v < rest.vertexCount(); ++v) rest_.push_back(rest.position(v));
  neighbours_ = Grouped<Neighbour>(rest_.size(), [&](const auto& visit) {
    for (const Edge& edge : edges_) {
      visit(edge.a, {edge.b, edge.weight});
      visit(edge.b, {edge.a, edge.weight});
    }
  });
  buildMatrix();
}

ElasticSurface::~ElasticSurface() = default;

void ElasticSurface::buildMatrix() {
  const auto size = static_cast<Eigen::Index>(rest_.size());
  matrix_.resize(size, size);
  matrix_.resizeNonZeros(size + static_cast<Eigen::Index>(edges_.size()));
  offDiagonal_.resize(edges_.size());
  std::ptrdiff_t at = 0;
  std::size_t edge = 0;
  for (Index column = 0; column < rest_.size(); ++column) {
    matrix_.outerIndexPtr()[column] = static_cast<int>(at);
    matrix_.innerIndexPtr()[at] = static_cast<int>(column);
    diagonal_.push_back(at++);
    for (; edge < edges_.size() && edges_[edge].a == column; ++edge) {
      matrix_.innerIndexPtr()[at] = static_cast<int>(edges_[edge].b);
      offDiagonal_[edge] = at++;
    }
  }
  matrix_.outerIndexPtr()[size] = static_cast<int>(at);
  std::fill_n(matrix_.valuePtr(), at, 1.0);
  factor_ = std::make_unique<SparseCholesky>(matrix_);
}

std::vector<Mat3> ElasticSurface::frames(std::span<const Vec3> positions) const {
  std::vector<Mat3> result(rest_.size(), Mat3::Identity());
  parallelFor(rest_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Mat3 correlation = Mat3::Zero();
      double size = 0;
      for (const auto& [neighbour, weight] : neighbours_.of(v)) {
        const Vec3 atRest = rest_[neighbour] - rest_[v], now = positions[neighbour] - positions[v];
        correlation += weight * now * atRest.transpose();
        size += weight * atRest.squaredNorm();
      }
      if (!(size > 0)) continue;
      const Mat3 turn = bestRotation(correlation).toRotationMatrix();
      const double scale = turn.cwiseProduct(correlation).sum() / size;
      result[v] = std::clamp(scale, kMinScale, kMaxScale) * turn;
    }
  });
  return result;
}

std::vector<Vec3> ElasticSurface::solve(std::span<const Mat3> frames, double stiffness, std::span<const double> pulls,
                                        std::span<const Vec3> goals) {
  std::vector<Vec3> right(rest_.size());
  double* values = matrix_.valuePtr();
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    right[v] = pulls[v] * goals[v];
    values[diagonal_[v]] = pulls[v];
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const double weight = stiffness * edge.weight;
    const Vec3 wanted = 0.5 * (frames[edge.a] + frames[edge.b]) * (rest_[edge.a] - rest_[edge.b]);
    right[edge.a] += weight * wanted;
    right[edge.b] -= weight * wanted;
    values[diagonal_[edge.a]] += weight;
    values[diagonal_[edge.b]] += weight;
    values[offDiagonal_[e]] = -weight;
  }
  factor_->factorize(matrix_);
  std::vector<double> x(SparseCholesky::kColumns * rest_.size(), 0);
  const auto row = [&](std::size_t v) {
    return x.data() + std::size_t{SparseCholesky::kColumns} * factor_->rowOf(static_cast<Index>(v));
  };
  for (std::size_t v = 0; v < rest_.size(); ++v) std::copy_n(right[v].data(), 3, row(v));
  factor_->solve(x.data(), 3);
  std::vector<Vec3> result(rest_.size());
  for (std::size_t v = 0; v < rest_.size(); ++v) result[v] = Eigen::Map<const Vec3>(row(v));
  return result;
}

}  // namespace limber
