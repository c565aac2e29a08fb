#include "limber/deform/rotation_centers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

constexpr double kPerSquaredSigma = 1 / (0.1 * 0.1);  // sigma as in the paper
constexpr double kNothing = 30;                       // exp(-30) of a weight is left out
constexpr std::uint64_t kCells = 64;                  // along each of two joints' weights
constexpr std::size_t kCenterGrain = 64;              // vertices

struct JointWeight {
  Index joint = 0;
  double weight = 0;
};

// Sorted by joint, each joint once, without those of weight 0.
using Binding = std::vector<JointWeight>;

void addWeight(Binding& binding, Index joint, double weight) {
  if (weight <= 0) return;
  const auto at = std::lower_bound(binding.begin(), binding.end(), joint,
                                   [](const JointWeight& entry, Index j) { return entry.joint < j; });
  if (at != binding.end() && at->joint == joint) {
    at->weight += weight;
  } else {
    binding.insert(at, {joint, weight});
  }
}

void addVertex(Binding& binding, const SkinWeights& weights, Index vertex, double fraction) {
  for (Index slot = 0; slot < weights.slots; ++slot) {
    addWeight(binding, weights.jointsOf(vertex)[slot], fraction * static_cast<double>(weights.weightsOf(vertex)[slot]));
  }
}

// Calls body(first, second) for every two entries of a binding, the one of the lower joint first.
template <typename Body>
void forPairs(const Binding& binding, const Body& body) {
  for (std::size_t i = 0; i < binding.size(); ++i) {
    for (std::size_t k = i + 1; k < binding.size(); ++k) body(binding[i], binding[k]);
  }
}

// Triangles bound alike to two joints.
struct Group {
  std::uint64_t pair = 0, cell = 0;
  double area = 0;
  double a = 0, b = 0;         // mean weights of the two joints
  double mass = 0;             // sum of area * a * b
  Vec3 moment = Vec3::Zero();  // sum of area * a * b * centroid
};

std::uint64_t pairOf(const JointWeight& first, const JointWeight& second) {
  return std::uint64_t{first.joint} << 32 | second.joint;
}

std::uint64_t cellOf(double a, double b) {
  const auto step = [](double w) {
    return static_cast<std::uint64_t>(std::clamp(w * kCells, 0.0, static_cast<double>(kCells - 1)));
  };
  return step(a) * kCells + step(b);
}

bool sameGroup(const Group& x, const Group& y) {
  return x.pair == y.pair && x.cell == y.cell;
}

// Neighbours in order that are of one group become one entry.
void mergeNeighbours(std::vector<Group>& groups) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (kept > 0 && sameGroup(groups[kept - 1], groups[i])) {
      Group& to = groups[kept - 1];
      to.area += groups[i].area;
      to.a += groups[i].a;
      to.b += groups[i].b;
      to.mass += groups[i].mass;
      to.moment += groups[i].moment;
    } else {
      groups[kept++] = groups[i];
    }
  }
  groups.resize(kept);
}

// All groups, ordered by pair of joints. While they are gathered, a and b are sums by area.
std::vector<Group> groupTriangles(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                  const SkinWeights& weights) {
  std::vector<Group> groups;
  Binding binding;
  std::size_t mergeAt = std::size_t{1} << 20;
  const auto merge = [&] {
    std::stable_sort(groups.begin(), groups.end(), [](const Group& x, const Group& y) {
      return x.pair != y.pair ? x.pair < y.pair : x.cell < y.cell;
    });
    mergeNeighbours(groups);
    mergeAt = std::max(mergeAt, 2 * groups.size());
  };
  for (const Triangle& t : triangles) {
    const Vec3 p = positions[t[0]].cast<double>(), q = positions[t[1]].cast<double>(),
               r = positions[t[2]].cast<double>();
    const double area = triangleArea(p, q, r);
    const Vec3 centroid = (p + q + r) / 3;
    if (!(area > 0) || !std::isfinite(area)) continue;
    binding.clear();
    for (const Index v : t) addVertex(binding, weights, v, 1.0 / 3);
    forPairs(binding, [&](const JointWeight& first, const JointWeight& second) {
      const double a = first.weight, b = second.weight, mass = area * a * b;
      groups.push_back({pairOf(first, second), cellOf(a, b), area, area * a, area * b, mass, mass * centroid});
    });
    if (groups.size() >= mergeAt) merge();
  }
  merge();
  for (Group& group : groups) {
    group.a /= group.area;
    group.b /= group.area;
  }
  return groups;
}

Vec3f centerOf(const Vec3f& position, const Binding& binding, const std::vector<Group>& groups) {
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  forPairs(binding, [&](const JointWeight& first, const JointWeight& second) {
    const std::uint64_t pair = pairOf(first, second);
    const auto begin = std::lower_bound(groups.begin(), groups.end(), pair,
                                        [](const Group& group, std::uint64_t p) { return group.pair < p; });
    const double both = first.weight * second.weight;
    for (auto group = begin; group != groups.end() && group->pair == pair; ++group) {
      const double unlike = first.weight * group->b - second.weight * group->a;
      const double exponent = kPerSquaredSigma * unlike * unlike;
      if (exponent > kNothing) continue;
      const double alike = both * std::exp(-exponent);
      mass += alike * group->mass;
      moment += alike * group->moment;
    }
  });
  const Vec3 center = moment / mass;
  return mass > 0 && center.allFinite() ? Vec3f(center.cast<float>()) : position;
}

}  // namespace

std::vector<Vec3f> rotationCenters(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                   const SkinWeights& weights) {
  const std::size_t entries = positions.size() * weights.slots;
  if (weights.joints.size() != entries || weights.weights.size() != entries) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} weights, {} needed", weights.weights.size(), entries));
  }
  for (const Triangle& t : triangles) {
    if (*std::max_element(t.begin(), t.end()) >= positions.size()) {
      throw Error(ErrorCode::kBadArgument,
                  fmt::format("a triangle of a vertex beyond the {} there are", positions.size()));
    }
  }
  const std::vector<Group> groups = groupTriangles(positions, triangles, weights);
  std::vector<Vec3f> centers(positions.size());
  parallelFor(positions.size(), kCenterGrain, [&](std::size_t begin, std::size_t end) {
    Binding binding;
    for (std::size_t v = begin; v < end; ++v) {
      binding.clear();
      addVertex(binding, weights, static_cast<Index>(v), 1);
      centers[v] = centerOf(positions[v], binding, groups);
    }
  });
  return centers;
}

}  // namespace limber
