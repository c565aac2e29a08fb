#include "limber/rigging/weights/heat_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/rigging/weights/outward_normals.h"

namespace limber {

namespace {

constexpr std::size_t kSourceRange = 1024;  // vertices of one parallel piece of work
constexpr std::size_t kGroup = 32;  // vertices, likely neighbours, that use one order of bones; divides kSourceRange
// Surfaces closer than this to either end of a line of sight do not block it: layers that touch, bones that end on the
// surface. In longest sides.
constexpr double kSightMargin = 1e-5;
// Keeps the distance to a bone straight in front of the surface finite: a thousand times the true one.
constexpr double kFacingMargin = 1e-3;

struct BoneDistance {
  double surface;  // signed: negative inside the bone's radius
  double axis;
  Vec3 target;  // the nearest point of the bone's surface, or the vertex itself where it lies inside
};

class BoneFinder {
 public:
  BoneFinder(std::span<const Bone> bones, const Bvh* bvh, const HeatSourceOptions& options)
      : bones_(bones), bvh_(bvh), options_(options) {
    for (const Bone& bone : bones) {
      const Vec3 along = bone.b - bone.a;
      const double lengthSquared = along.squaredNorm();
      along_.push_back(along);
      inverse_.push_back(lengthSquared > 0 ? 1 / lengthSquared : 0);
    }
  }

  // Sorts the bones for these vertices by the least distance that each can have from any of them.
  void approach(std::span<const Vec3f> vertices) {
    Box box;
    for (const Vec3f& vertex : vertices) box.add(vertex.cast<double>());
    const Vec3 middle = box.center();
    const double reach = (0.5 + 1e-6) * box.diagonal();
    order_.clear();
    for (std::size_t i = 0; i < bones_.size(); ++i) {
      const double least = plainDistance(middle, i) - bones_[i].radius - reach;
      // Facing away makes it at most one part in a thousand less than that.
      order_.push_back({least > 0 ? (1 - kFacingMargin) * least : least, i});
    }
    std::sort(order_.begin(), order_.end());
  }

  // Appends the joints that hold the vertex and returns their pull. The vertex is one of those of the last approach();
  // `normal` is a unit vector, or zero where it does not count; `region` is the joint whose region the vertex is of,
  // kNoIndex where that is not known.
  double find(const Vec3& vertex, const Vec3& normal, Index region, std::vector<Index>& joints) {
    normal_ = normal;
    region_ = region;
    nearBones_.clear();
    double nearest = std::numeric_limits<double>::infinity(), tolerance = 0;
    for (const auto& [least, i] : order_) {
      if (least > nearest + tolerance) break;
      const BoneDistance d = distance(vertex, i);
      const double surface = d.surface + (isOfOtherRegion(i) ? d.axis : 0);
      nearBones_.push_back({surface, i});
      if (surface >= nearest) continue;
      nearest = surface;
      tolerance = options_.tieTolerance * d.axis;
    }
    return pullUpTo(vertex, nearest + tolerance, joints);
  }

 private:
  Vec3 armTo(const Vec3& vertex, std::size_t i) const {
    const double s = std::clamp((vertex - bones_[i].a).dot(along_[i]) * inverse_[i], 0.0, 1.0);
    return bones_[i].a + s * along_[i] - vertex;
  }

  double plainDistance(const Vec3& vertex, std::size_t i) const { return armTo(vertex, i).norm(); }

  BoneDistance distance(const Vec3& vertex, std::size_t i) const {
    const Vec3 arm = armTo(vertex, i);
    const double axis = arm.norm();
    const double surface = axis - bones_[i].radius;
    if (!(surface > 0)) return {surface, axis, vertex};
    const double farther = 1 / facing(arm, axis);
    return {farther * surface, farther * axis, vertex + arm * (surface / axis)};
  }

  bool isOfOtherRegion(std::size_t i) const { return region_ != kNoIndex && region_ != bones_[i].joint; }

  // 1 where the vertex faces straight away from the bone, near 0 where it faces the bone.
  double facing(const Vec3& arm, double length) const {
    if (normal_.isZero(0)) return 1;
    return 0.5 * (1 + kFacingMargin - normal_.dot(arm) / length);
  }

  // Appends the joints of the visible bones that are no farther than that.
  double pullUpTo(const Vec3& vertex, double most, std::vector<Index>& joints) const {
    const std::size_t start = joints.size();
    double nearestAxis = std::numeric_limits<double>::infinity();
    for (const auto& [surface, i] : nearBones_) {
      if (surface > most) continue;
      const BoneDistance d = distance(vertex, i);
      const bool mayBeHidden = bvh_ && bones_[i].joint != region_;
      if (mayBeHidden && bvh_->segmentBlocked(vertex, d.target, kSightMargin)) continue;
      joints.push_back(bones_[i].joint);
      nearestAxis = std::min(nearestAxis, d.axis);
    }
    if (joints.size() == start) return 0;
    std::sort(joints.begin() + start, joints.end());
    joints.erase(std::unique(joints.begin() + start, joints.end()), joints.end());
    const double d = std::max(nearestAxis, options_.minDistance);
    return options_.heat / (d * d);
  }

  std::span<const Bone> bones_;
  const Bvh* bvh_;
  const HeatSourceOptions& options_;
  std::vector<Vec3> along_;
  std::vector<double> inverse_;                            // of the squared length; 0 for a sphere
  std::vector<std::pair<double, std::size_t>> order_;      // least distance from the group, bone; ascending
  std::vector<std::pair<double, std::size_t>> nearBones_;  // distance from the vertex in hand, bone
  Vec3 normal_ = Vec3::Zero();                             // of the vertex in hand
  Index region_ = kNoIndex;                                // likewise
};

}  // namespace

HeatSources findHeatSources(const TriMesh& mesh, std::span<const Bone> bones, const Bvh* bvh,
                            const HeatSourceOptions& options, std::span<const Index> jointOf) {
  const std::size_t vertexCount = mesh.positions.size();
  const std::vector<Vec3> normals =
      options.facing ? outwardNormals(mesh) : std::vector<Vec3>(vertexCount, Vec3::Zero());
  HeatSources result;
  result.pull.resize(vertexCount);
  result.first.resize(vertexCount + 1, 0);
  std::vector<std::vector<Index>> found((vertexCount + kSourceRange - 1) / kSourceRange);
  parallelFor(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    BoneFinder finder(bones, bvh, options);
    for (std::size_t range = begin; range < end; ++range) {
      for (std::size_t v = range * kSourceRange; v < std::min(vertexCount, (range + 1) * kSourceRange); ++v) {
        if (v % kGroup == 0) finder.approach({mesh.positions.data() + v, std::min(kGroup, vertexCount - v)});
        const std::size_t before = found[range].size();
        const Index region = jointOf.empty() ? kNoIndex : jointOf[v];
        result.pull[v] = finder.find(mesh.positions[v].cast<double>(), normals[v], region, found[range]);
        result.first[v + 1] = static_cast<Index>(found[range].size() - before);
      }
    }
  });
  for (std::size_t v = 0; v < vertexCount; ++v) result.first[v + 1] += result.first[v];
  result.joints.reserve(result.first.back());
  for (const std::vector<Index>& part : found) result.joints.insert(result.joints.end(), part.begin(), part.end());
  return result;
}

}  // namespace limber
