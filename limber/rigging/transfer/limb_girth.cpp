#include "limber/rigging/transfer/limb_girth.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"

namespace limber {

namespace {

constexpr std::size_t kMaxRays = 200;
constexpr std::size_t kMinRays = 8;
// Rays in lengths from the bone to the vertex: as far as they are followed, and how far behind a triangle they go on.
constexpr double kRayLength = 12, kPast = 1e-4;
constexpr std::size_t kMaxCrossings = 32;
// Heads of toys are five times as large as those of people of their height.
constexpr double kMinGirth = 1.0 / 6, kMaxGirth = 6;

// The part of the body that one joint carries: vertices that hang on it most, or on joints that go along with it.
struct Carried {
  Index bones = 0;           // that lead from it to landmarks
  std::optional<Index> end;  // where its bone leads; where bones part, as at hips, it lies round none of them
  std::vector<Index> vertices;
};

class GirthFit {
 public:
  GirthFit(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const JointLandmark> landmarks)
      : skeleton_(skeleton), leads_(skeleton.jointCount(), false), carrier_(skeleton.jointCount()) {
    for (const Affine& global : globals) rest_.push_back(global.translation());
    for (const JointLandmark& landmark : landmarks) leads_[landmark.joint] = true;
    for (Index j = skeleton.jointCount(); j-- > 0;) {
      if (leads_[j] && skeleton.joints[j].parent) leads_[*skeleton.joints[j].parent] = true;
    }
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      const std::optional<Index> parent = skeleton.joints[j].parent;
      carrier_[j] = leads_[j] || !parent ? j : carrier_[*parent];
    }
  }

  std::vector<Carried> carried(const SkinWeights& weights) const {
    std::vector<Carried> parts(rest_.size());
    for (Index j = 0; j < rest_.size(); ++j) {
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      if (!leads_[j] || !parent) continue;
      Carried& above = parts[*parent];
      above.end = ++above.bones == 1 ? std::optional(j) : std::nullopt;
    }
    for (Index v = 0; v < weights.vertexCount(); ++v) {
      if (weights.weightsOf(v)[0] > 0) parts[carrier_[weights.jointsOf(v)[0]]].vertices.push_back(v);
    }
    return parts;
  }

  // The median of how much farther the target is from the bone; 1 where that cannot be told.
  double girth(Index joint, const Carried& part, const TriMesh& source, const Bvh& sourceTree, const TriMesh& target,
               const Bvh& targetTree, const Affine& map) const {
    const std::size_t step = (part.vertices.size() + kMaxRays - 1) / kMaxRays;
    std::size_t rays = 0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < part.vertices.size(); i += step) {
      const Vec3 to = source.position(part.vertices[i]), from = nearestOnBone(joint, part, to);
      const std::optional<double> there = leaves(sourceTree, source, from, to - from);
      if (!there) continue;
      ++rays;
      const std::optional<double> here = leaves(targetTree, target, map * from, map.linear() * (to - from));
      if (here) ratios.push_back(*here / *there);
    }
    if (rays < kMinRays || 2 * ratios.size() < rays) return 1;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return std::clamp(*middle, kMinGirth, kMaxGirth);
  }

  // Parents before children; what goes along with a joint is moved as that is.
  void apply(std::span<const double> girths, std::span<const Carried> parts, LimbAlignment& alignment) const {
    std::vector<Affine> grown(rest_.size(), Affine::Identity());
    for (Index j = 0; j < rest_.size(); ++j) {
      if (carrier_[j] == j) {
        grown[j] = about(alignment.positions[j], girths[j], alongBone(j, parts[j], alignment));
      } else {
        grown[j] = grown[carrier_[j]];
        alignment.positions[j] = grown[j] * alignment.positions[j];
      }
      alignment.maps[j] = grown[j] * alignment.maps[j];
    }
  }

 private:
  Vec3 nearestOnBone(Index joint, const Carried& part, const Vec3& point) const {
    const Vec3& start = rest_[joint];
    if (!part.end) return start;
    const Vec3 along = rest_[*part.end] - start;
    const double square = along.squaredNorm();
    if (!(square > 0)) return start;
    return start + std::clamp(along.dot(point - start) / square, 0.0, 1.0) * along;
  }

  // The parameter at which a ray leaves the solids that it starts in, all of them; those that it meets first where it
  // starts in none. Nothing where it meets none.
  static std::optional<double> leaves(const Bvh& tree, const TriMesh& mesh, const Vec3& from,
                                      const Vec3& displacement) {
    if (!(displacement.squaredNorm() > 0)) return std::nullopt;
    struct Crossing {
      double at;
      int depth;
    };
    std::vector<Crossing> crossings;
    int inside = 0;  // solids round the start: those that the ray leaves but never enters
    double at = 0;
    while (crossings.size() < kMaxCrossings) {
      const std::optional<SurfacePoint> hit = tree.firstHit(from + at * displacement, displacement, kRayLength);
      if (!hit) break;
      at += hit->distance + kPast;
      const auto& [a, b, c] = mesh.triangles[hit->triangle];
      const Vec3 normal = (mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a));
      crossings.push_back({at, normal.dot(displacement) > 0 ? -1 : 1});
      inside -= crossings.back().depth;
    }
    int depth = std::max(inside, 0);
    for (const Crossing& crossing : crossings) {
      depth += crossing.depth;
      if (crossing.depth < 0 && depth <= 0) return crossing.at;
    }
    return std::nullopt;
  }

  static Vec3 alongBone(Index joint, const Carried& part, const LimbAlignment& alignment) {
    if (!part.end) return Vec3::Zero();
    const Vec3 along = alignment.positions[*part.end] - alignment.positions[joint];
    return along.squaredNorm() > 0 ? Vec3(along.normalized()) : Vec3(Vec3::Zero());
  }

  // Scales about a position, but not along the unit vector; a zero vector: in all directions.
  static Affine about(const Vec3& position, double scale, const Vec3& along) {
    Affine result = Affine::Identity();
    result.linear() = scale * Mat3::Identity() + (1 - scale) * along * along.transpose();
    result.translation() = position - result.linear() * position;
    return result;
  }

  const Skeleton& skeleton_;
  std::vector<Vec3> rest_;
  std::vector<bool> leads_;     // has a landmark, or leads to one
  std::vector<Index> carrier_;  // the joint that it goes along with; of those that lead to a landmark itself
};

}  // namespace

void fitGirths(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const JointLandmark> landmarks,
               const TriMesh& source, const SkinWeights& weights, const TriMesh& target, LimbAlignment& alignment) {
  const GirthFit fit(skeleton, globals, landmarks);
  const std::vector<Carried> parts = fit.carried(weights);
  const Bvh sourceTree(source), targetTree(target);
  std::vector<double> girths(skeleton.jointCount(), 1);
  parallelFor(girths.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      if (parts[j].vertices.empty()) continue;
      girths[j] = fit.girth(static_cast<Index>(j), parts[j], source, sourceTree, target, targetTree, alignment.maps[j]);
    }
  });
  fit.apply(girths, parts, alignment);
}

}  // namespace limber
