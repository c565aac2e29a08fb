#include "limber/geometry/mesh/bvh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/float4.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr int kWidth = 4;               // children of a node
constexpr Index kLeafTriangles = 4;     // at most, in one leaf
constexpr int kBins = 12;               // for the surface area heuristic
constexpr Index kParallelAbove = 4096;  // triangles; smaller subtrees are built by one thread
// Pending children of a traversal. No child holds more than (15/16)^3 of its node's triangles (see BvhBuilder), so 2^32
// triangles make at most 115 levels, each of which leaves up to three children waiting.
constexpr int kStackSize = 512;
constexpr Index kMaxUnevenness = 16;

using Lanes = Float4;  // a number for each child of a node

constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline Lanes all(float value) {
  return Lanes{value, value, value, value};
}
inline Lanes lesser(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes greater(Lanes a, Lanes b) {
  return a > b ? a : b;
}

struct Bounds {
  Vec3f min = Vec3f::Constant(kInfinity);
  Vec3f max = Vec3f::Constant(-kInfinity);

  void add(const Vec3f& lo, const Vec3f& hi) {
    min = min.cwiseMin(lo);
    max = max.cwiseMax(hi);
  }
  float halfArea() const {
    const Vec3f d = max - min;
    return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
  }
};

}  // namespace

// Boxes of the children, a lane each. The box of a lane that is not used lies at infinity, where nothing meets it.
struct Bvh::Node {
  Lanes lo[3], hi[3];
  Index child[kWidth];  // count == 0: a node; otherwise the first of `count` leaves
  std::uint8_t count[kWidth];
};

struct Bvh::Item {
  Vec3f lo, hi;
  Index triangle;

  float center(int axis) const { return lo[axis] + hi[axis]; }  // twice the centre, which serves as well
};

void Bvh::NodeDeleter::operator()(Node* nodes) const {
  delete[] nodes;
}

// The most nodes that a tree over so many items has: a node has four children, unless all of them are leaves; so each
// node has at least three items more to its name than it has nodes below.
constexpr Index nodeSlots(Index items) {
  return (items - 1) / 3;
}

// Splits the items top down, in place, so that each leaf's triangles end up side by side. A subtree owns nodeSlots()
// from its first one on, which makes node indices independent of the order in which subtrees are built.
class BvhBuilder {
 public:
  BvhBuilder(std::span<Bvh::Item> items, Bvh::Node* nodes) : items_(items), nodes_(nodes) {}

  void build(Index nodeIndex, Index begin, Index end) {
    Range ranges[kWidth] = {{begin, end}};
    int count = 1;
    while (count < kWidth) {  // split the largest range that is not yet a leaf
      int largest = 0;
      for (int i = 1; i < count; ++i) {
        if (ranges[i].size() > ranges[largest].size()) largest = i;
      }
      if (ranges[largest].size() <= kLeafTriangles) break;
      const Index middle = split(ranges[largest]);
      std::copy_backward(ranges + largest + 1, ranges + count, ranges + count + 1);
      ranges[largest + 1] = {middle, ranges[largest].end};
      ranges[largest].end = middle;
      ++count;
    }
    Bvh::Node& node = nodes_[nodeIndex];
    Index firstSlot = nodeIndex + 1;
    for (int lane = 0; lane < kWidth; ++lane) {
      const Range range = lane < count ? ranges[lane] : Range{};
      setLane(node, lane, range, firstSlot);
      if (range.size() > kLeafTriangles) firstSlot += nodeSlots(range.size());
    }
    buildChildren(node, ranges, count);
  }

 private:
  struct Range {
    Index begin = 0, end = 0;
    Index size() const { return end - begin; }
  };

  void setLane(Bvh::Node& node, int lane, Range range, Index slot) {
    Bounds bounds;
    for (Index i = range.begin; i < range.end; ++i) bounds.add(items_[i].lo, items_[i].hi);
    if (range.size() == 0) bounds.max = bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
      node.lo[axis][lane] = bounds.min[axis];
      node.hi[axis][lane] = bounds.max[axis];
    }
    const bool leaf = range.size() <= kLeafTriangles;
    node.child[lane] = leaf ? range.begin : slot;
    node.count[lane] = leaf ? static_cast<std::uint8_t>(range.size()) : 0;
  }

  void buildChildren(const Bvh::Node& node, const Range* ranges, int count) {
    const auto buildSome = [&](int first, int last) {
      for (int lane = first; lane < last; ++lane) {
        if (ranges[lane].size() > kLeafTriangles) build(node.child[lane], ranges[lane].begin, ranges[lane].end);
      }
    };
    const bool large = ranges[count - 1].end - ranges[0].begin > kParallelAbove;
    if (large && count > 1) {
      parallelInvoke([&] { buildSome(0, count / 2); }, [&] { buildSome(count / 2, count); });
    } else {
      buildSome(0, count);
    }
  }

  // Reorders the range and returns where its second half begins: the cheapest of kBins - 1 planes across the longest
  // extent of the centres, or the middle where the centres are all but one.
  Index split(Range range) {
    Bounds centers;
    for (Index i = range.begin; i < range.end; ++i) {
      const Vec3f center = items_[i].lo + items_[i].hi;
      centers.add(center, center);
    }
    int axis = 0;
    const float extent = (centers.max - centers.min).maxCoeff(&axis);
    const float start = centers.min[axis];
    const float scale = kBins / extent;
    if (!(extent > 0) || !std::isfinite(scale)) return range.begin + range.size() / 2;

    const auto binOf = [&](const Bvh::Item& item) {
      return std::min(kBins - 1, static_cast<int>((item.center(axis) - start) * scale));
    };
    const int plane = cheapestPlane(range, binOf);
    const auto first = items_.begin() + range.begin;
    const auto middle =
        std::partition(first, items_.begin() + range.end, [&](const Bvh::Item& item) { return binOf(item) < plane; });
    const Index left = static_cast<Index>(middle - first);
    // Very uneven splits make deep trees, and a traversal's stack is bounded.
    if (left == 0 || left == range.size() || tooUneven(left, range.size())) return medianSplit(range, axis);
    return range.begin + left;
  }

  static bool tooUneven(Index left, Index size) { return std::min(left, size - left) < size / kMaxUnevenness; }

  Index medianSplit(Range range, int axis) {
    const Index middle = range.begin + range.size() / 2;
    std::nth_element(items_.begin() + range.begin, items_.begin() + middle, items_.begin() + range.end,
                     [axis](const Bvh::Item& a, const Bvh::Item& b) {
                       const float ca = a.center(axis), cb = b.center(axis);
                       return ca != cb ? ca < cb : a.triangle < b.triangle;
                     });
    return middle;
  }

  // The bin at which the second half begins.
  template <class BinOf>
  int cheapestPlane(Range range, const BinOf& binOf) const {
    Bounds bounds[kBins];
    Index counts[kBins] = {};
    for (Index i = range.begin; i < range.end; ++i) {
      const int bin = binOf(items_[i]);
      bounds[bin].add(items_[i].lo, items_[i].hi);
      ++counts[bin];
    }
    float costBelow[kBins] = {};  // of all bins below the plane
    Bounds below, above;
    Index countBelow = 0, countAbove = 0;
    for (int plane = 1; plane < kBins; ++plane) {
      below.add(bounds[plane - 1].min, bounds[plane - 1].max);
      countBelow += counts[plane - 1];
      costBelow[plane] = countBelow == 0 ? 0 : below.halfArea() * static_cast<float>(countBelow);
    }
    int best = 1;
    float bestCost = kInfinity;
    for (int plane = kBins - 1; plane > 0; --plane) {
      above.add(bounds[plane].min, bounds[plane].max);
      countAbove += counts[plane];
      const float cost = costBelow[plane] + (countAbove == 0 ? 0 : above.halfArea() * static_cast<float>(countAbove));
      if (cost < bestCost) {
        bestCost = cost;
        best = plane;
      }
    }
    return best;
  }

  std::span<Bvh::Item> items_;
  Bvh::Node* nodes_;
};

Bvh::Bvh(const TriMesh& mesh) {
  std::vector<Item> items(mesh.triangleCount());
  for (Index t = 0; t < mesh.triangleCount(); ++t) items[t].triangle = t;
  build(mesh, items);
}

Bvh::Bvh(const TriMesh& mesh, std::span<const Index> triangles) {
  std::vector<Item> items(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) items[i].triangle = triangles[i];
  build(mesh, items);
}

void Bvh::build(const TriMesh& mesh, std::vector<Item>& items) {
  float largest = 0;
  for (const Vec3f& p : mesh.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  // Boxes a few rounding errors too large make single precision box tests safe.
  const Vec3f pad = Vec3f::Constant(4 * std::numeric_limits<float>::epsilon() * largest);
  for (Item& item : items) {
    const Triangle& t = mesh.triangles[item.triangle];
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    item.lo = a.cwiseMin(b).cwiseMin(c) - pad;
    item.hi = a.cwiseMax(b).cwiseMax(c) + pad;
  }
  const Index count = static_cast<Index>(items.size());
  nodes_.reset(new Node[count > kLeafTriangles ? nodeSlots(count) : 1]);
  BvhBuilder(items, nodes_.get()).build(0, 0, count);

  leaves_.resize(count);
  for (Index i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[items[i].triangle];
    leaves_[i] = {{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, items[i].triangle};
  }
}

// A ray, and the shear that turns it into the positive axis kz (Woop, Benthin, Wald 2013).
struct Bvh::Ray {
  Vec3 origin, direction;
  int kx, ky, kz;
  double shearX, shearY, shearZ;
  Lanes originForLo[3], originForHi[3], inverseLanes[3];

  Ray(const Vec3& from, const Vec3& along) : origin(from), direction(along) {
    direction.cwiseAbs().maxCoeff(&kz);
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    shearX = direction[kx] / direction[kz];
    shearY = direction[ky] / direction[kz];
    shearZ = 1 / direction[kz];
    const float pad = 4 * std::numeric_limits<float>::epsilon() * origin.cast<float>().cwiseAbs().maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      // A tiny number instead of zero keeps 0 * infinity out of the box test.
      const float d = static_cast<float>(direction[axis]);
      const float safe = std::abs(d) > 1e-30f ? d : std::copysign(1e-30f, d);
      originForLo[axis] = all(static_cast<float>(origin[axis]) + pad);
      originForHi[axis] = all(static_cast<float>(origin[axis]) - pad);
      inverseLanes[axis] = all(1 / safe);
    }
  }

  // Where the ray enters each child's box; infinity where it misses it before maxT.
  Lanes enter(const Node& node, float maxT) const {
    Lanes nearT = {};
    Lanes farT = all(maxT);
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes a = (node.lo[axis] - originForLo[axis]) * inverseLanes[axis];
      const Lanes b = (node.hi[axis] - originForHi[axis]) * inverseLanes[axis];
      nearT = greater(nearT, lesser(a, b));
      farT = lesser(farT, greater(a, b));
    }
    constexpr float kSlack = 1 + 4 * std::numeric_limits<float>::epsilon();
    return nearT <= farT * kSlack ? nearT : all(kInfinity);
  }

  // The parameter at which the ray meets the triangle, with the corners' weights.
  bool meets(const Leaf& leaf, double& t, Vec3& weights) const {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = leaf.corners[k].cast<double>() - origin;
      x[k] = p[kx] - shearX * p[kz];
      y[k] = p[ky] - shearY * p[kz];
      z[k] = shearZ * p[kz];
    }
    const double u = x[2] * y[1] - y[2] * x[1];
    const double v = x[0] * y[2] - y[0] * x[2];
    const double w = x[1] * y[0] - y[1] * x[0];
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double sum = u + v + w;
    if (sum == 0) return false;
    t = (u * z[0] + v * z[1] + w * z[2]) / sum;
    weights = Vec3(u, v, w) / sum;
    return true;
  }
};

bool Bvh::segmentBlocked(const Vec3& from, const Vec3& to, double margin) const {
  const Vec3 along = to - from;
  const double length = along.norm();
  if (leaves_.empty() || !(length > 2 * margin)) return false;
  const Ray ray(from, along);
  const Vec3f start = from.cast<float>();
  const double minT = margin / length, maxT = 1 - minT;

  Index stack[kStackSize];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Lanes enter = ray.enter(node, 1.0f);
    for (int lane = 0; lane < kWidth; ++lane) {
      if (!(enter[lane] <= 1.0f)) continue;
      if (node.count[lane] == 0) {
        stack[depth++] = node.child[lane];
        continue;
      }
      for (Index i = node.child[lane]; i < node.child[lane] + node.count[lane]; ++i) {
        double t;
        Vec3 weights;
        const Leaf& leaf = leaves_[i];
        if (!ray.meets(leaf, t, weights) || t <= minT || t >= maxT) continue;
        if (leaf.corners[0] != start && leaf.corners[1] != start && leaf.corners[2] != start) return true;
      }
    }
  }
  return false;
}

namespace {

// Children still to be visited, with what is known of their distance.
struct Pending {
  Index node;
  float key;
};

// Pushes the lanes for which key is finite so that the nearest is popped first.
template <class Node>
int pushByKey(const Node& node, const Lanes& keys, Pending* stack, int depth) {
  const int base = depth;
  for (int lane = 0; lane < kWidth; ++lane) {
    if (node.count[lane] != 0 || !(keys[lane] < kInfinity)) continue;
    int at = depth++;
    for (; at > base && stack[at - 1].key < keys[lane]; --at) stack[at] = stack[at - 1];
    stack[at] = {node.child[lane], keys[lane]};
  }
  return depth;
}

// The point of triangle abc nearest to p, as weights of the corners (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b, int ia, int ib) {
  const Vec3 ab = b - a;
  const double lengthSquared = ab.squaredNorm();
  const double s = lengthSquared > 0 ? std::clamp((p - a).dot(ab) / lengthSquared, 0.0, 1.0) : 0.0;
  Vec3 weights = Vec3::Zero();
  weights[ia] = 1 - s;
  weights[ib] = s;
  return weights;
}

Vec3 nearestOnTriangle(const Vec3& p, const Vec3 corners[3]) {
  const Vec3 &a = corners[0], &b = corners[1], &c = corners[2];
  const Vec3 normal = (b - a).cross(c - a);
  const double areaSquared = normal.squaredNorm();
  if (areaSquared > 0) {
    const double u = (c - b).cross(p - b).dot(normal) / areaSquared;
    const double v = (a - c).cross(p - c).dot(normal) / areaSquared;
    const double w = 1 - u - v;
    if (u >= 0 && v >= 0 && w >= 0) return {u, v, w};
  }
  // Outside, or no area: the nearest of the three sides' nearest points.
  Vec3 best = nearestOnSegment(p, a, b, 0, 1);
  double bestSquared = (p - best[0] * a - best[1] * b).squaredNorm();
  for (const Vec3& weights : {nearestOnSegment(p, b, c, 1, 2), nearestOnSegment(p, c, a, 2, 0)}) {
    const double squared = (p - weights[0] * a - weights[1] * b - weights[2] * c).squaredNorm();
    if (squared < bestSquared) {
      bestSquared = squared;
      best = weights;
    }
  }
  return best;
}

}  // namespace

std::optional<SurfacePoint> Bvh::firstHit(const Vec3& origin, const Vec3& direction, double maxT) const {
  if (leaves_.empty() || !(direction.squaredNorm() > 0)) return std::nullopt;
  const Ray ray(origin, direction);
  std::optional<SurfacePoint> best;
  double bestT = maxT;
  Pending stack[kStackSize];
  int depth = 0;
  stack[depth++] = {0, 0.0f};
  while (depth > 0) {
    const Pending next = stack[--depth];
    if (next.key > bestT * (1 + 1e-6)) continue;
    const Node& node = nodes_[next.node];
    const Lanes enter = ray.enter(node, static_cast<float>(std::min(bestT * (1 + 1e-6), 1e30)));
    for (int lane = 0; lane < kWidth; ++lane) {
      if (!(enter[lane] < kInfinity)) continue;
      for (Index i = node.child[lane]; i < node.child[lane] + node.count[lane]; ++i) {
        double t;
        Vec3 weights;
        if (!ray.meets(leaves_[i], t, weights) || t <= 0 || t >= maxT) continue;
        if (t > bestT || (t == bestT && !(best && leaves_[i].triangle < best->triangle))) continue;
        bestT = t;
        best = SurfacePoint{leaves_[i].triangle, weights, origin + t * direction, t};
      }
    }
    depth = pushByKey(node, enter, stack, depth);
  }
  return best;
}

SurfacePoint Bvh::nearestPoint(const Vec3& point) const {
  if (leaves_.empty()) throw Error(ErrorCode::kBadArgument, "a surface without triangles has no nearest point");
  const Vec3f p = point.cast<float>();
  SurfacePoint best;
  double bestSquared = std::numeric_limits<double>::infinity();
  // A little less than the true distance, so that rounding never prunes the nearest.
  const auto boxSquared = [&](const Node& node) -> Lanes {
    Lanes sum = {};
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes d = greater(greater(node.lo[axis] - p[axis], p[axis] - node.hi[axis]), Lanes{});
      sum += d * d;
    }
    return sum * (1 - 1e-5f);
  };
  Pending stack[kStackSize];
  int depth = 0;
  stack[depth++] = {0, 0.0f};
  while (depth > 0) {
    const Pending next = stack[--depth];
    if (next.key > bestSquared) continue;
    const Node& node = nodes_[next.node];
    const Lanes squared = boxSquared(node);
    for (int lane = 0; lane < kWidth; ++lane) {
      if (!(squared[lane] <= bestSquared)) continue;
      for (Index i = node.child[lane]; i < node.child[lane] + node.count[lane]; ++i) {
        const Leaf& leaf = leaves_[i];
        const Vec3 corners[3] = {leaf.corners[0].cast<double>(), leaf.corners[1].cast<double>(),
                                 leaf.corners[2].cast<double>()};
        const Vec3 weights = nearestOnTriangle(point, corners);
        const Vec3 position = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
        const double d = (position - point).squaredNorm();
        if (d > bestSquared || (d == bestSquared && leaf.triangle > best.triangle)) continue;
        bestSquared = d;
        best = {leaf.triangle, weights, position, 0};
      }
    }
    depth = pushByKey(node, squared, stack, depth);
  }
  best.distance = std::sqrt(bestSquared);
  return best;
}

Index nearestCorner(const TriMesh& mesh, const SurfacePoint& point) {
  Eigen::Index corner = 0;
  point.weights.maxCoeff(&corner);
  return mesh.triangles[point.triangle][static_cast<std::size_t>(corner)];
}

}  // namespace limber
