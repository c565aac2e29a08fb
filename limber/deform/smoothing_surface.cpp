#include "limber/deform/smoothing_surface.h"

#include <algorithm>
#include <numeric>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {

namespace {

constexpr double kAlike = 0.5;  // of the weights, for vertices at one position to be one

// What two vertices' bindings have in common, 0 to 1; what is missing to a sum of 1 counts as bound to the rest pose.
double commonWeight(const SkinWeights& weights, Index a, Index b) {
  double common = 0, sumA = 0, sumB = 0;
  for (Index i = 0; i < weights.slots; ++i) {
    const double weight = weights.weightsOf(a)[i];
    sumA += weight;
    sumB += weights.weightsOf(b)[i];
    for (Index k = 0; k < weights.slots; ++k) {
      if (weights.jointsOf(a)[i] != weights.jointsOf(b)[k]) continue;
      common += std::min<double>(weight, weights.weightsOf(b)[k]);
    }
  }
  return common + std::max(0.0, std::min(1 - sumA, 1 - sumB));
}

// Welds vertices that have the same number in `indices` and similar weights; returns the first of each welded vertex.
std::vector<Index> weldAlike(const std::vector<Index>& indices, const SkinWeights& weights,
                             std::vector<Index>& welded) {
  std::vector<Index> representatives, next, head(indices.size(), kNoIndex);
  for (Index v = 0; v < indices.size(); ++v) {
    Index found = head[indices[v]];
    while (found != kNoIndex && commonWeight(weights, representatives[found], v) < kAlike) found = next[found];
    if (found == kNoIndex) {
      found = static_cast<Index>(representatives.size());
      representatives.push_back(v);
      next.push_back(head[indices[v]]);
      head[indices[v]] = found;
    }
    welded.push_back(found);
  }
  return representatives;
}

bool hasTriangle(const BoundSurface& surface) {
  const std::span<const Vec3f> p = surface.positions;
  return std::any_of(surface.triangles.begin(), surface.triangles.end(),
                     [&](const Triangle& t) { return p[t[0]] != p[t[1]] && p[t[1]] != p[t[2]] && p[t[2]] != p[t[0]]; });
}

// The Laplacian, and how long the walk's steps are.
void connect(const BoundSurface& surface, const std::vector<Index>& representatives, const PreparedMesh& prepared,
             SmoothingSurface& result) {
  TriMesh mesh;
  for (const Index v : representatives) mesh.positions.push_back(prepared.mesh.positions[prepared.weldedVertex[v]]);
  for (const Triangle& source : surface.triangles) {
    const Triangle welded = {prepared.weldedVertex[source[0]], prepared.weldedVertex[source[1]],
                             prepared.weldedVertex[source[2]]};
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
    mesh.triangles.push_back(
        {result.weldedVertex[source[0]], result.weldedVertex[source[1]], result.weldedVertex[source[2]]});
  }
  Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(result.vertexCount());
  for (int column = 0; column < laplacian.stiffness.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(laplacian.stiffness, column); it; ++it) {
      if (it.row() == column) {
        result.diagonal[column] = it.value() > 0 ? it.value() : 1;
        continue;
      }
      const double length2 =
          (mesh.position(static_cast<Index>(it.row())) - mesh.position(static_cast<Index>(column))).squaredNorm();
      squared[column] -= it.value() * length2;
      squared[it.row()] -= it.value() * length2;
    }
  }
  const double area = laplacian.mass.sum();
  result.longestSide = prepared.frame.scale;
  if (area > 0) {
    result.meanSquaredStep =
        laplacian.mass.dot(squared.cwiseQuotient(result.diagonal)) / area * result.longestSide * result.longestSide;
  }
  result.stiffness = std::move(laplacian.stiffness);
}

}  // namespace

double SmoothingSurface::stepsFor(double reach) const {
  const double wanted = reach * reach * longestSide * longestSide;
  return meanSquaredStep > 0 ? std::max(1.0, wanted / meanSquaredStep) : 1;
}

SmoothingSurface smoothingSurface(const BoundSurface& surface) {
  SmoothingSurface result;
  const bool connected = hasTriangle(surface);
  PreparedMesh prepared;
  std::vector<Index> indices(surface.positions.size());
  std::iota(indices.begin(), indices.end(), Index{0});
  if (connected) {
    prepared = prepareMesh(surface.positions, surface.triangles);
    indices = prepared.weldedVertex;
  }
  const std::vector<Index> representatives = weldAlike(indices, surface.weights, result.weldedVertex);
  const int count = static_cast<int>(representatives.size());
  result.weights.slots = surface.weights.slots;
  for (const Index v : representatives) {
    result.positions.push_back(surface.positions[v]);
    const auto joints = surface.weights.jointsOf(v);
    const auto weights = surface.weights.weightsOf(v);
    result.weights.joints.insert(result.weights.joints.end(), joints.begin(), joints.end());
    result.weights.weights.insert(result.weights.weights.end(), weights.begin(), weights.end());
  }
  result.diagonal = Eigen::VectorXd::Ones(count);
  if (connected) {
    connect(surface, representatives, prepared, result);
  } else {
    result.stiffness.resize(count, count);
    result.stiffness.setIdentity();
    result.stiffness *= 0.0;
  }
  return result;
}

}  // namespace limber
