#include "limber/rigging/transfer/surface_registration.h"

#include <algorithm>
#include <cmath>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/normals.h"
#include "limber/rigging/transfer/elastic_surface.h"
#include "limber/rigging/transfer/facing_surface.h"

namespace limber {

namespace {

constexpr std::size_t kMaxTargetPoints = 20000;
// A goal may be as far as a pull spreads, and this part of the target's longest side where pulls spread less.
constexpr double kMinDistance = 0.03;
// Cosine: normals that differ by more do not speak for each other.
constexpr double kAgree = 0.5;
// What holds vertices without a goal where they are, against a pull of 1: next to nothing.
constexpr double kHold = 1e-6;
constexpr std::size_t kRegistrationGrain = 256;

struct TargetPoint {
  Vec3 position, normal;
  double area;
};

std::vector<Vec3> unitNormals(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
  std::vector<Vec3> normals = areaNormals(positions, triangles);
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

std::vector<TargetPoint> pointsOf(const TriMesh& target) {
  const std::vector<Vec3> normals = areaNormals<Vec3f>(target.positions, target.triangles);
  const std::vector<double> areas = vertexAreas(target);
  const std::size_t step = (target.positions.size() + kMaxTargetPoints - 1) / kMaxTargetPoints;
  std::vector<TargetPoint> points;
  for (Index v = 0; v < target.vertexCount(); v += static_cast<Index>(step)) {
    if (areas[v] > 0)
      points.push_back({target.position(v), normals[v].normalized(), areas[v] * static_cast<double>(step)});
  }
  return points;
}

Vec3 normalOf(const TriMesh& mesh, Index triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a)).normalized();
}

// How much a pair of points of both surfaces counts, 0 to 1.
double agreement(const Vec3& normal, const Vec3& other, double distance, double most) {
  if (distance > most) return 0;
  const double cosine = normal.dot(other);
  if (cosine <= kAgree) return 0;
  const double nearness = 1 - distance / most;
  return (cosine - kAgree) / (1 - kAgree) * nearness * (2 - nearness);
}

class Registration {
 public:
  Registration(const TriMesh& source, std::span<const VertexPair> links, const TriMesh& target)
      : moved_(source), target_(target), onTarget_(target), targetPoints_(pointsOf(target)), elastic_(source, links) {
    side_ = surfaceBox(target).longestSide();
    for (Index v = 0; v < source.vertexCount(); ++v) positions_.push_back(source.position(v));
    pulls_.resize(positions_.size());
    goals_.resize(positions_.size());
  }

  void round(double reach) {
    for (std::size_t v = 0; v < positions_.size(); ++v) moved_.positions[v] = positions_[v].cast<float>();
    const double most = std::max(reach, kMinDistance) * side_;
    const double hold = kHold * side_ * side_ / static_cast<double>(positions_.size());
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      pulls_[v] = hold;
      goals_[v] = hold * positions_[v];
    }
    pullToTarget(most);
    pullFromTarget(most);
    for (std::size_t v = 0; v < positions_.size(); ++v) goals_[v] /= pulls_[v];
    const std::vector<Mat3> frames = elastic_.frames(positions_);
    positions_ = elastic_.solve(frames, reach * reach * side_ * side_, pulls_, goals_);
  }

  std::vector<Vec3> result() { return std::move(positions_); }

 private:
  // Each vertex to the target.
  void pullToTarget(double most) {
    const std::vector<Vec3> normals = unitNormals(moved_.positions, moved_.triangles);
    parallelFor(positions_.size(), kRegistrationGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const auto found = onTarget_.nearestFacing(positions_[v], normals[v]);
        if (!found) continue;
        const double weight =
            elastic_.masses()[v] * agreement(normals[v], normalOf(target_, found->triangle), found->distance, most);
        pulls_[v] += weight;
        goals_[v] += weight * found->position;
      }
    });
  }

  // Points of the target to themselves, each what of the source is nearest to it.
  void pullFromTarget(double most) {
    struct Pull {
      SurfacePoint at;
      double weight = 0;
    };
    const FacingSurface onSource(moved_);
    std::vector<Pull> pulls(targetPoints_.size());
    parallelFor(pulls.size(), kRegistrationGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const TargetPoint& point = targetPoints_[i];
        const auto found = onSource.nearestFacing(point.position, point.normal);
        if (!found) continue;
        pulls[i] = {*found,
                    point.area * agreement(point.normal, normalOf(moved_, found->triangle), found->distance, most)};
      }
    });
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      if (!(pulls[i].weight > 0)) continue;
      const Vec3 displacement = targetPoints_[i].position - pulls[i].at.position;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Index v = moved_.triangles[pulls[i].at.triangle][corner];
        const double weight = pulls[i].weight * pulls[i].at.weights[static_cast<Eigen::Index>(corner)];
        pulls_[v] += weight;
        goals_[v] += weight * (positions_[v] + displacement);
      }
    }
  }

  TriMesh moved_;
  const TriMesh& target_;
  FacingSurface onTarget_;
  std::vector<TargetPoint> targetPoints_;
  ElasticSurface elastic_;
  double side_ = 0;
  std::vector<Vec3> positions_, goals_;
  std::vector<double> pulls_;
};

}  // namespace

std::vector<Vec3> registerSurface(const TriMesh& source, std::span<const VertexPair> links, const TriMesh& target,
                                  const RegistrationOptions& options, Progress& progress) {
  progress.step("register");
  Registration registration(source, links, target);
  const double all = static_cast<double>(options.reaches.size()) * options.rounds;
  int done = 0;
  for (const double reach : options.reaches) {
    for (int round = 0; round < options.rounds; ++round) {
      progress.update(done++ / all);
      registration.round(reach);
    }
  }
  return registration.result();
}

}  // namespace limber
