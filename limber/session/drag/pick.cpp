#include "limber/session/drag/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/geometry/mesh/bvh.h"

namespace limber {

namespace {

constexpr double kBehind = 1e-6;  // of the distance: what a ray that goes on leaves out

// Where a ray is nearest to a point.
struct Passing {
  double along = 0, beside = 0;
};

Passing passing(const Ray& ray, const Vec3& point) {
  const Vec3 direction = ray.direction.normalized(), to = point - ray.origin;
  const double along = direction.dot(to);
  return {along, (to - along * direction).norm()};
}

// The joint with the largest weight at a point of a triangle.
Index strongestJoint(const SkinWeights& weights, const Triangle& triangle, const Vec3& barycentric) {
  Index best = 0;
  double most = -1;
  const auto total = [&](Index joint) {
    double sum = 0;
    for (int corner = 0; corner < 3; ++corner) {
      for (Index k = 0; k < weights.slots; ++k) {
        if (weights.jointsOf(triangle[corner])[k] == joint) {
          sum += barycentric[corner] * weights.weightsOf(triangle[corner])[k];
        }
      }
    }
    return sum;
  };
  for (const Index v : triangle) {
    for (Index k = 0; k < weights.slots; ++k) {
      if (!(weights.weightsOf(v)[k] > 0)) continue;
      const Index joint = weights.jointsOf(v)[k];
      const double sum = total(joint);
      if (sum > most || (sum == most && joint < best)) {
        most = sum;
        best = joint;
      }
    }
  }
  return best;
}

}  // namespace

std::optional<PickHit> pickHandle(const Ray& ray, std::span<const Vec3> centers, std::span<const double> radii,
                                  double slope) {
  std::optional<PickHit> best;
  double bestRank = std::numeric_limits<double>::infinity();
  bool bestMet = false;
  for (Index j = 0; j < centers.size(); ++j) {
    const Passing pass = passing(ray, centers[j]);
    const bool met = pass.beside <= radii[j] && pass.along > -radii[j];
    if (!met && !(pass.along > 0 && pass.beside <= slope * pass.along)) continue;
    const double entry = met ? pass.along - std::sqrt(radii[j] * radii[j] - pass.beside * pass.beside) : pass.along;
    const double rank = met ? entry : pass.beside / pass.along;
    if (met < bestMet || (met == bestMet && rank >= bestRank)) continue;
    bestRank = rank;
    bestMet = met;
    best = PickHit{j, true, centers[j], std::max(entry, 0.0), centers[j]};
  }
  return best;
}

SurfacePicker::SurfacePicker(const RiggedModel& model, const Pose& pose, const Deformer& deformer)
    : model_(model), posed_{posedPositions(model, pose, deformer), model.geometry().triangles}, tree_(posed_) {}

std::optional<SurfaceHit> SurfacePicker::hit(const Ray& ray) const {
  const Vec3 direction = ray.direction.normalized();
  constexpr double kAnyFar = std::numeric_limits<double>::infinity();
  const auto met = tree_.firstHit(ray.origin, direction, kAnyFar);
  if (!met) return std::nullopt;
  const auto exit = tree_.firstHit(met->position + kBehind * met->distance * direction, direction, kAnyFar);
  const Triangle& corners = posed_.triangles[met->triangle];
  const Vec3 a = posed_.position(corners[0]), b = posed_.position(corners[1]), c = posed_.position(corners[2]);
  SurfaceHit hit{{met->triangle, met->weights[1], met->weights[2]}, met->position, (b - a).cross(c - a).normalized()};
  if (hit.normal.dot(direction) > 0) hit.normal = -hit.normal;
  hit.joint = strongestJoint(model_.weights, corners, met->weights);
  hit.inside = exit ? Vec3(0.5 * (met->position + exit->position)) : met->position;
  return hit;
}

std::optional<PickHit> pickSurface(const Ray& ray, const RiggedModel& model, const Pose& pose,
                                   const Deformer& deformer) {
  const std::optional<SurfaceHit> hit = SurfacePicker(model, pose, deformer).hit(ray);
  if (!hit) return std::nullopt;
  return PickHit{hit->joint, false, hit->position, (hit->position - ray.origin).norm(), hit->inside};
}

}  // namespace limber
