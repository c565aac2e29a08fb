#include "limber/evaluate/rig/bone_coverage.h"

#include <algorithm>

#include "limber/core/parallel.h"
#include "limber/evaluate/motion/body_inside.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/rigging/weights/outward_normals.h"

namespace limber {

namespace {

constexpr std::size_t kMaxSamples = 5000;
constexpr std::size_t kSampleGrain = 64;

double squaredDistance(const Vec3& point, const Bone& bone) {
  const Vec3 along = bone.b - bone.a;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp(along.dot(point - bone.a) / length, 0.0, 1.0) : 0.0;
  return (bone.a + t * along - point).squaredNorm();
}

bool isCovered(const Vec3& point, double thickness, const std::vector<Bone>& bones) {
  return std::any_of(bones.begin(), bones.end(),
                     [&](const Bone& bone) { return squaredDistance(point, bone) <= thickness * thickness; });
}

}  // namespace

std::optional<double> boneCoverage(const SkinnedModel& model, const std::vector<bool>& counts) {
  const std::vector<Bone> bones = bonesOf(model.skeleton, counts);
  if (bones.empty()) return std::nullopt;
  const BodyInside body(model.mesh);
  const std::vector<Vec3> normals = outwardNormals(model.mesh);
  const std::vector<double> areas = vertexAreas(model.mesh);
  const std::size_t step = std::max<std::size_t>(1, (normals.size() + kMaxSamples - 1) / kMaxSamples);
  const std::size_t samples = (normals.size() + step - 1) / step;
  enum class Seen : char { kNothing, kBare, kCovered };
  std::vector<Seen> seen(samples, Seen::kNothing);
  parallelFor(samples, kSampleGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 point = model.mesh.position(static_cast<Index>(i * step));
      const Vec3& normal = normals[i * step];
      if (!(normal.squaredNorm() > 0)) continue;
      const Vec3 below = point - body.step() * normal;
      if (!body.contains(below)) continue;
      const std::optional<double> thickness = body.exitFrom(below, -normal);
      if (thickness) seen[i] = isCovered(point, *thickness, bones) ? Seen::kCovered : Seen::kBare;
    }
  });
  double area = 0, covered = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    if (seen[i] == Seen::kNothing) continue;
    area += areas[i * step];
    if (seen[i] == Seen::kCovered) covered += areas[i * step];
  }
  if (!(area > 0)) return std::nullopt;
  return covered / area;
}

}  // namespace limber
