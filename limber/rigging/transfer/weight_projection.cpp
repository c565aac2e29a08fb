#include "limber/rigging/transfer/weight_projection.h"

#include <algorithm>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/normals.h"

namespace limber {

namespace {

// A point that faces about the same direction is taken while it is no farther than this many times the nearest one of
// all, or than this part of the box's diagonal.
constexpr double kMuchFarther = 4, kNearEnough = 0.01;
constexpr std::size_t kProjectionGrain = 256;

bool hasWeights(const SkinWeights& weights, Index v) {
  const std::span<const float> of = weights.weightsOf(v);
  return std::any_of(of.begin(), of.end(), [](float w) { return w > 0; });
}

// The triangles that have a vertex with weights.
std::vector<Index> weightedTriangles(const TriMesh& source, const SkinWeights& weights) {
  std::vector<Index> triangles;
  for (Index t = 0; t < source.triangleCount(); ++t) {
    const Triangle& corners = source.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return hasWeights(weights, v); })) {
      triangles.push_back(t);
    }
  }
  if (triangles.empty()) throw Error(ErrorCode::kBadArgument, "no vertex of the surface has any weights");
  return triangles;
}

struct WeightedJoint {
  Index joint;
  double weight;
};

void addInfluences(const TriMesh& source, const SkinWeights& weights, const SurfacePoint& point,
                   std::vector<WeightedJoint>& influences) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const Index v = source.triangles[point.triangle][corner];
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const double weight = weights.weightsOf(v)[slot] * point.weights[static_cast<Eigen::Index>(corner)];
      if (!(weight > 0)) continue;
      const Index joint = weights.jointsOf(v)[slot];
      const auto same =
          std::find_if(influences.begin(), influences.end(), [&](const WeightedJoint& s) { return s.joint == joint; });
      if (same != influences.end()) {
        same->weight += weight;
      } else {
        influences.push_back({joint, weight});
      }
    }
  }
}

void storeInfluences(std::vector<WeightedJoint>& influences, Index vertex, SkinWeights& result) {
  std::sort(influences.begin(), influences.end(), [](const WeightedJoint& a, const WeightedJoint& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
  });
  if (influences.size() > result.slots) influences.resize(result.slots);
  double sum = 0;
  for (const WeightedJoint& influence : influences) sum += influence.weight;
  for (std::size_t slot = 0; slot < influences.size(); ++slot) {
    result.joints[std::size_t{vertex} * result.slots + slot] = influences[slot].joint;
    result.weights[std::size_t{vertex} * result.slots + slot] = static_cast<float>(influences[slot].weight / sum);
  }
}

}  // namespace

SurfaceProjector::SurfaceProjector(const TriMesh& source)
    : surface_(source), near_(kNearEnough * surfaceBox(source).diagonal()) {}

SurfacePoint SurfaceProjector::at(const Vec3& position, const Vec3& normal) const {
  const SurfacePoint nearest = surface_.nearest(position);
  const auto facing = surface_.nearestFacing(position, normal);
  return facing && facing->distance <= std::max(near_, kMuchFarther * nearest.distance) ? *facing : nearest;
}

std::vector<SurfacePoint> takenAfter(const TriMesh& source, const TriMesh& target) {
  const SurfaceProjector projector(source);
  const std::vector<Vec3> normals = areaNormals<Vec3f>(target.positions, target.triangles);
  std::vector<SurfacePoint> points(target.positions.size());
  parallelFor(points.size(), kProjectionGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      points[v] = projector.at(target.position(static_cast<Index>(v)), normals[v]);
    }
  });
  return points;
}

SkinWeights projectWeights(const TriMesh& source, const SkinWeights& weights, std::span<const SurfacePoint> points,
                           Index slots) {
  const Bvh weighted(source, weightedTriangles(source, weights));
  SkinWeights result;
  result.slots = slots;
  result.joints.assign(points.size() * slots, 0);
  result.weights.assign(points.size() * slots, 0.0f);
  parallelFor(points.size(), kProjectionGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<WeightedJoint> influences;
    for (std::size_t v = begin; v < end; ++v) {
      influences.clear();
      addInfluences(source, weights, points[v], influences);
      if (influences.empty()) {
        SurfacePoint next = weighted.nearestPoint(points[v].position);
        addInfluences(source, weights, next, influences);
        next.weights = Vec3::Constant(1.0 / 3);  // on an edge between vertices without
        if (influences.empty()) addInfluences(source, weights, next, influences);
      }
      storeInfluences(influences, static_cast<Index>(v), result);
    }
  });
  return result;
}

}  // namespace limber
