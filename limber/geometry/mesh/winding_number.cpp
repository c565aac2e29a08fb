#include "limber/geometry/mesh/winding_number.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

constexpr int kLevels = 20;             // of the octree: bits for each axis of a code
constexpr Index kFarLeafTriangles = 8;  // at most, but on the last level

// Every third bit of the result is a bit of `value`.
std::uint64_t spread(std::uint64_t value) {
  value &= 0x1fffff;
  value = (value | value << 32) & 0x1f00000000ffff;
  value = (value | value << 16) & 0x1f0000ff0000ff;
  value = (value | value << 8) & 0x100f00f00f00f00f;
  value = (value | value << 4) & 0x10c30c30c30c30c3;
  return (value | value << 2) & 0x1249249249249249;
}

struct Coded {
  std::uint64_t code;
  Index triangle;

  bool operator<(const Coded& other) const {
    return code != other.code ? code < other.code : triangle < other.triangle;
  }
};

void sortInParallel(std::span<Coded> items) {
  constexpr std::size_t kSortParallelAbove = 1 << 15;
  if (items.size() <= kSortParallelAbove) {
    std::sort(items.begin(), items.end());
    return;
  }
  const std::size_t half = items.size() / 2;
  parallelInvoke([&] { sortInParallel(items.first(half)); }, [&] { sortInParallel(items.subspan(half)); });
  std::inplace_merge(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end());
}

std::vector<Coded> codesOf(const TriMesh& mesh) {
  const Box box = surfaceBox(mesh);
  const double scale = box.longestSide() > 0 ? ((1 << kLevels) - 1) / box.longestSide() : 0;
  std::vector<Coded> codes(mesh.triangleCount());
  parallelFor(codes.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& corners = mesh.triangles[t];
      const Vec3 sum = mesh.position(corners[0]) + mesh.position(corners[1]) + mesh.position(corners[2]);
      const Vec3 cell = scale * (sum / 3 - box.min).cwiseMax(0.0);
      std::uint64_t code = 0;
      for (int axis = 0; axis < 3; ++axis) code |= spread(static_cast<std::uint64_t>(cell[axis])) << axis;
      codes[t] = {code, static_cast<Index>(t)};
    }
  });
  sortInParallel(codes);
  return codes;
}

// Of a triangle seen from the origin (Van Oosterom, Strackee 1983), halved.
double halfSolidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double base = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return volume == 0 ? 0 : std::atan2(volume, base);
}

}  // namespace

WindingNumber::WindingNumber(const TriMesh& mesh, const std::vector<bool>& flipped, double accuracy)
    : accuracy_(accuracy) {
  if (!flipped.empty() && flipped.size() != mesh.triangles.size()) {
    throw Error(ErrorCode::kBadArgument, "one turn for each triangle is needed, or none");
  }
  if (mesh.triangles.empty()) return;
  std::vector<std::uint64_t> codes(mesh.triangleCount());
  triangles_.resize(mesh.triangleCount());
  const std::vector<Coded> order = codesOf(mesh);
  for (std::size_t i = 0; i < order.size(); ++i) {
    codes[i] = order[i].code;
    const Triangle& t = mesh.triangles[order[i].triangle];
    for (int k = 0; k < 3; ++k) triangles_[i].corners[k] = mesh.positions[t[k]];
    if (!flipped.empty() && flipped[order[i].triangle]) std::swap(triangles_[i].corners[1], triangles_[i].corners[2]);
  }
  nodes_.reserve(triangles_.size() / 2 + 1);
  nodes_.emplace_back();
  nodes_[0].end = static_cast<Index>(triangles_.size());
  split(0, codes, kLevels - 1);
  parallelFor(nodes_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) expand(nodes_[n]);
  });
}

void WindingNumber::split(Index node, std::span<const std::uint64_t> codes, int level) {
  const Index begin = nodes_[node].begin, end = nodes_[node].end;
  if (end - begin <= kFarLeafTriangles || level < 0) return;
  const auto octant = [&](Index i) { return (codes[i] >> (3 * level)) & 7; };
  if (octant(begin) == octant(end - 1)) return split(node, codes, level - 1);  // one child would be the node itself
  const Index firstChild = static_cast<Index>(nodes_.size());
  for (Index from = begin; from < end;) {
    const auto last = std::partition_point(codes.begin() + from, codes.begin() + end, [&](std::uint64_t code) {
      return ((code >> (3 * level)) & 7) == octant(from);
    });
    Node child;
    child.begin = from;
    child.end = from = static_cast<Index>(last - codes.begin());
    nodes_.push_back(child);
  }
  const Index count = static_cast<Index>(nodes_.size()) - firstChild;
  nodes_[node].firstChild = firstChild;
  nodes_[node].childCount = static_cast<std::uint8_t>(count);
  for (Index c = 0; c < count; ++c) split(firstChild + c, codes, level - 1);
}

// Moments about the node's centre. Those of a triangle are exact: a quadratic polynomial's mean over a triangle is the
// mean over the middles of its edges.
void WindingNumber::expand(Node& node) const {
  Vec3 weighted = Vec3::Zero(), plain = Vec3::Zero();
  double total = 0;
  for (Index i = node.begin; i < node.end; ++i) {
    const auto& c = triangles_[i].corners;
    const Vec3 middle = (c[0] + c[1] + c[2]).cast<double>() / 3;
    const double area = (c[1] - c[0]).cast<double>().cross((c[2] - c[0]).cast<double>()).norm();
    weighted += area * middle;
    plain += middle;
    total += area;
  }
  const Vec3 center = total > 0 ? Vec3(weighted / total) : Vec3(plain / static_cast<double>(node.end - node.begin));
  node.center = center.cast<float>();
  const Vec3 origin = node.center.cast<double>();

  Vec3 area = Vec3::Zero(), trace = Vec3::Zero();
  Mat3 first = Mat3::Zero();
  double second[10] = {}, radius = 0;
  for (Index i = node.begin; i < node.end; ++i) {
    Vec3 d[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = triangles_[i].corners[k].cast<double>() - origin;
      radius = std::max(radius, d[k].norm());
    }
    const Vec3 n = 0.5 * (d[1] - d[0]).cross(d[2] - d[0]);
    area += n;
    first += (d[0] + d[1] + d[2]) / 3 * n.transpose();
    for (int k = 0; k < 3; ++k) {
      const Vec3 m = 0.5 * (d[k] + d[(k + 1) % 3]);
      const Vec3 w = n / 6;  // a third of the middles, half of Taylor's
      trace += 2 * m.dot(w) * m + m.squaredNorm() * w;
      const double xx = m.x() * m.x(), yy = m.y() * m.y(), zz = m.z() * m.z();
      const double xy = m.x() * m.y(), yz = m.y() * m.z(), zx = m.z() * m.x();
      second[0] += xx * w.x();
      second[1] += yy * w.y();
      second[2] += zz * w.z();
      second[3] += xx * w.y() + 2 * xy * w.x();
      second[4] += xx * w.z() + 2 * zx * w.x();
      second[5] += yy * w.x() + 2 * xy * w.y();
      second[6] += yy * w.z() + 2 * yz * w.y();
      second[7] += zz * w.x() + 2 * zx * w.z();
      second[8] += zz * w.y() + 2 * yz * w.z();
      second[9] += 2 * (xy * w.z() + yz * w.x() + zx * w.y());
    }
  }
  node.radius = static_cast<float>(radius);
  node.area = area.cast<float>();
  node.trace = trace.cast<float>();
  const double sums[6] = {first(0, 0),
                          first(1, 1),
                          first(2, 2),
                          first(0, 1) + first(1, 0),
                          first(1, 2) + first(2, 1),
                          first(2, 0) + first(0, 2)};
  for (int k = 0; k < 6; ++k) node.first[k] = static_cast<float>(sums[k]);
  for (int k = 0; k < 10; ++k) node.second[k] = static_cast<float>(second[k]);
}

// Taylor's series of x / |x|^3 about `away`, the displacement from the point to the node's centre, times 4 pi.
double WindingNumber::far(const Node& node, const Vec3& away) const {
  const double squared = away.squaredNorm();
  const double inverse = 1 / squared;
  const double cube = inverse / std::sqrt(squared), fifth = cube * inverse;
  const double x = away.x(), y = away.y(), z = away.z();
  const float *f = node.first, *s = node.second;
  const double linear = node.area.cast<double>().dot(away);
  const double quadratic = f[0] * x * x + f[1] * y * y + f[2] * z * z + f[3] * x * y + f[4] * y * z + f[5] * z * x;
  const double cubic = x * x * (s[0] * x + s[3] * y + s[4] * z) + y * y * (s[1] * y + s[5] * x + s[6] * z) +
                       z * z * (s[2] * z + s[7] * x + s[8] * y) + s[9] * x * y * z;
  return cube * (linear + (double{f[0]} + f[1] + f[2])) +
         fifth * (-3 * quadratic - 3 * node.trace.cast<double>().dot(away) + 15 * inverse * cubic);
}

double WindingNumber::at(const Vec3& point) const {
  if (nodes_.empty()) return 0;
  double farSum = 0, nearSum = 0;
  Index stack[8 * kLevels];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Vec3 away = node.center.cast<double>() - point;
    const double reach = accuracy_ * node.radius;
    if (away.squaredNorm() > reach * reach) {
      farSum += far(node, away);
    } else if (node.childCount > 0) {
      for (Index c = 0; c < node.childCount; ++c) stack[depth++] = node.firstChild + c;
    } else {
      for (Index i = node.begin; i < node.end; ++i) {
        const auto& c = triangles_[i].corners;
        nearSum +=
            halfSolidAngle(c[0].cast<double>() - point, c[1].cast<double>() - point, c[2].cast<double>() - point);
      }
    }
  }
  return farSum / (4 * kPi) + nearSum / (2 * kPi);
}

double WindingNumber::exactAt(const Vec3& point) const {
  double sum = 0;
  for (const Corners& t : triangles_) {
    const auto& c = t.corners;
    sum += halfSolidAngle(c[0].cast<double>() - point, c[1].cast<double>() - point, c[2].cast<double>() - point);
  }
  return sum / (2 * kPi);
}

std::vector<bool> areInside(const TriMesh& mesh, std::span<const Vec3> points) {
  constexpr double kFar = 10;  // times the longer of two sides: there an area vector is right within half a percent
  constexpr std::size_t kRange = 65536;
  const std::size_t ranges = (mesh.triangles.size() + kRange - 1) / kRange;
  std::vector<double> angles(ranges * points.size(), 0);
  parallelFor(ranges, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t range = begin; range < end; ++range) {
      double* const sums = angles.data() + range * points.size();
      for (std::size_t t = range * kRange; t < std::min(mesh.triangles.size(), (range + 1) * kRange); ++t) {
        const Triangle& corners = mesh.triangles[t];
        const Vec3 a = mesh.position(corners[0]), b = mesh.position(corners[1]), c = mesh.position(corners[2]);
        const Vec3 middle = (a + b + c) / 3, area = 0.5 * (b - a).cross(c - a);
        const double far = kFar * kFar * std::max((b - a).squaredNorm(), (c - a).squaredNorm());
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Vec3 away = middle - points[i];
          const double squared = away.squaredNorm();
          sums[i] += squared > far ? 0.5 * away.dot(area) / (squared * std::sqrt(squared))
                                   : halfSolidAngle(a - points[i], b - points[i], c - points[i]);
        }
      }
    }
  });
  std::vector<bool> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double sum = 0;
    for (std::size_t range = 0; range < ranges; ++range) sum += angles[range * points.size() + i];
    result.push_back(std::abs(sum) > kPi);
  }
  return result;
}

}  // namespace limber
