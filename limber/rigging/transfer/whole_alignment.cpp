#include "limber/rigging/transfer/whole_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/rotation_fit.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/normals.h"
#include "limber/rigging/transfer/facing_surface.h"

namespace limber {

namespace {

constexpr std::size_t kMaxPoints = 2000;
constexpr int kClosestRounds = 10;
constexpr double kMaxGrowth = 1.25;
// Pairs that lie farther apart say nothing; parts of the target's longest side.
constexpr double kFar = 0.1;

struct SurfaceSample {
  Vec3 position, normal;
};

std::vector<SurfaceSample> samplesOf(const TriMesh& mesh) {
  const std::vector<Vec3> normals = areaNormals<Vec3f>(mesh.positions, mesh.triangles);
  const std::size_t step = (mesh.positions.size() + kMaxPoints - 1) / kMaxPoints;
  std::vector<SurfaceSample> samples;
  for (Index v = 0; v < mesh.vertexCount(); v += static_cast<Index>(step)) {
    if (normals[v].norm() > 0) samples.push_back({mesh.position(v), normals[v].normalized()});
  }
  return samples;
}

struct PointPair {
  Vec3 source, target;
  double weight;
};

// Least squares (Umeyama 1991).
Affine similarityOf(const std::vector<PointPair>& pairs, const Affine& otherwise) {
  double total = 0, size = 0;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  for (const PointPair& pair : pairs) {
    total += pair.weight;
    from += pair.weight * pair.source;
    to += pair.weight * pair.target;
  }
  if (!(total > 0)) return otherwise;
  from /= total;
  to /= total;
  Mat3 correlation = Mat3::Zero();
  for (const PointPair& pair : pairs) {
    correlation += pair.weight * (pair.target - to) * (pair.source - from).transpose();
    size += pair.weight * (pair.source - from).squaredNorm();
  }
  const Mat3 turn = bestRotation(correlation).toRotationMatrix();
  const double trace = turn.cwiseProduct(correlation).sum();
  if (!(size > 0 && trace > 0)) return otherwise;
  Affine result = Affine::Identity();
  result.linear() = trace / size * turn;
  result.translation() = to - result.linear() * from;
  return result;
}

double nearness(double distance, double far) {
  return distance < far ? 1 - distance / far : 0;
}

double squareApart(const std::vector<SurfaceSample>& from, const FacingSurface& to, double far) {
  double sum = 0;
  for (const SurfaceSample& sample : from) {
    const auto found = to.nearestFacing(sample.position, sample.normal);
    const double distance = found ? std::min(found->distance, far) : far;
    sum += distance * distance;
  }
  return sum / std::max<double>(1, static_cast<double>(from.size()));
}

}  // namespace

double extentAlong(const TriMesh& mesh, const Vec3& axis) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) {
      low = std::min(low, axis.dot(mesh.position(v)));
      high = std::max(high, axis.dot(mesh.position(v)));
    }
  }
  return high - low;
}

Affine wholeSimilarity(const TriMesh& source, const TriMesh& target, const Quat& turn, const Vec3& up) {
  const Box goal = surfaceBox(target);
  TriMesh turned = source;
  for (Vec3f& p : turned.positions) p = (turn * p.cast<double>()).cast<float>();
  const double height = extentAlong(turned, up), far = kFar * goal.longestSide();
  Affine map = Affine::Identity();
  map.linear() = (height > 0 ? extentAlong(target, up) / height : 1.0) * turn.toRotationMatrix();
  map.translation() = goal.center() - map.linear() * (turn.conjugate() * surfaceBox(turned).center());

  const Affine first = map;
  const FacingSurface onSource(source), onTarget(target);
  const std::vector<SurfaceSample> ofSource = samplesOf(source), ofTarget = samplesOf(target);
  for (int round = 0; round < kClosestRounds; ++round) {
    const double scale = std::cbrt(map.linear().determinant());
    const Mat3 rotation = map.linear() / scale;
    const Affine back = map.inverse();
    std::vector<PointPair> pairs;
    for (const SurfaceSample& sample : ofSource) {
      const Vec3 position = map * sample.position;
      const auto found = onTarget.nearestFacing(position, rotation * sample.normal);
      if (found) pairs.push_back({sample.position, found->position, nearness(found->distance, far)});
    }
    for (const SurfaceSample& sample : ofTarget) {
      const auto found = onSource.nearestFacing(back * sample.position, rotation.transpose() * sample.normal);
      if (found) pairs.push_back({found->position, sample.position, nearness(scale * found->distance, far)});
    }
    map = similarityOf(pairs, map);
  }
  const double growth = std::cbrt(map.linear().determinant() / first.linear().determinant());
  return growth <= kMaxGrowth && growth * kMaxGrowth >= 1 ? map : first;
}

LimbAlignment alignWhole(std::span<const Affine> globals, const Affine& similarity) {
  LimbAlignment result;
  result.whole = similarity;
  const Quat turn = Quat(Mat3(similarity.linear() / std::cbrt(similarity.linear().determinant()))).normalized();
  for (const Affine& global : globals) {
    result.positions.push_back(similarity * Vec3(global.translation()));
    result.rotations.push_back(turn);
    result.maps.push_back(similarity);
  }
  return result;
}

double surfacesApart(const TriMesh& source, const TriMesh& target) {
  const double side = surfaceBox(target).longestSide(), far = kFar * side;
  if (!(side > 0)) return 0;
  const double square = squareApart(samplesOf(source), FacingSurface(target), far) +
                        squareApart(samplesOf(target), FacingSurface(source), far);
  return std::sqrt(square / 2) / side;
}

}  // namespace limber
