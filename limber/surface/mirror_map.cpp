#include "limber/surface/mirror_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr double kTolerance = 3e-3;   // of the longest side, between a mirrored vertex and its image
constexpr double kEnough = 0.98;      // of vertices and of area
constexpr double kLeastWidth = 0.01;  // mean distance from the plane, of the longest side: less is a sheet in the plane
constexpr std::size_t kSamples = 400;

// Points hashed by cubic cells, to find the nearest one within a small radius. Those of a cell are sorted along one
// axis, since the cells of long thin models, and of rows of many pieces, hold thousands.
class CellHash {
 public:
  CellHash(const std::vector<Vec3f>& points, float cellSize, int axis)
      : points_(points), inverseCell_(1 / cellSize), axis_(axis), mask_(std::bit_ceil(points.size() + 1) - 1) {
    begin_.assign(mask_ + 3, 0);
    std::vector<Index> bucket(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      bucket[i] = bucketOf(cellOf(points[i].x()), cellOf(points[i].y()), cellOf(points[i].z()));
      ++begin_[bucket[i] + 2];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    items_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) items_[begin_[bucket[i] + 1]++] = static_cast<Index>(i);
    for (std::size_t b = 0; b + 2 < begin_.size(); ++b) {
      std::sort(items_.begin() + begin_[b], items_.begin() + begin_[b + 1],
                [&](Index i, Index j) { return points_[i][axis_] < points_[j][axis_]; });
    }
  }

  // The nearest accepted point within `radius` of p, ties by index; kNoIndex if there is none.
  template <typename Accept>
  Index nearest(const Vec3f& p, float radius, const Accept& accept) const {
    Index best = kNoIndex;
    float bestDistance = radius * radius;
    const auto take = [&](Index item) {
      const float distance = (points_[item] - p).squaredNorm();
      if (distance > bestDistance || (distance == bestDistance && item > best) || !accept(item)) return;
      best = item;
      bestDistance = distance;
    };
    const auto isBeyond = [&](Index i) {
      const float along = points_[items_[i]][axis_] - p[axis_];
      return along * along > bestDistance;
    };
    const std::array<int, 6> range = {cellOf(p.x() - radius), cellOf(p.x() + radius), cellOf(p.y() - radius),
                                      cellOf(p.y() + radius), cellOf(p.z() - radius), cellOf(p.z() + radius)};
    for (int x = range[0]; x <= range[1]; ++x) {
      for (int y = range[2]; y <= range[3]; ++y) {
        for (int z = range[4]; z <= range[5]; ++z) {
          const Index bucket = bucketOf(x, y, z), begin = begin_[bucket], end = begin_[bucket + 1];
          const Index middle = firstFrom(begin, end, p[axis_]);
          for (Index i = middle; i < end && !isBeyond(i); ++i) take(items_[i]);
          for (Index i = middle; i > begin && !isBeyond(i - 1); --i) take(items_[i - 1]);
        }
      }
    }
    return best;
  }

 private:
  // The first of a cell's items whose place along the axis is `least` or more.
  Index firstFrom(Index begin, Index end, float least) const {
    const auto found = std::lower_bound(items_.begin() + begin, items_.begin() + end, least,
                                        [&](Index item, float value) { return points_[item][axis_] < value; });
    return static_cast<Index>(found - items_.begin());
  }
  int cellOf(float x) const { return static_cast<int>(std::floor(x * inverseCell_)); }
  Index bucketOf(int x, int y, int z) const {
    std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9e3779b97f4a7c15u;
    h ^= static_cast<std::uint32_t>(y) * 0xc2b2ae3d27d4eb4fu;
    h ^= static_cast<std::uint32_t>(z) * 0x165667b19e3779f9u;
    return static_cast<Index>((h ^ h >> 29) & mask_);
  }

  const std::vector<Vec3f>& points_;
  float inverseCell_;
  int axis_;
  std::size_t mask_;
  std::vector<Index> begin_, items_;
};

int longestAxis(const Box& box) {
  int axis = 0;
  box.size().maxCoeff(&axis);
  return axis;
}

class MirrorFinder {
 public:
  MirrorFinder(const TriMesh& mesh, const Box& box)
      : mesh_(mesh),
        side_(box.longestSide()),
        middle_(box.center()),
        reach_(static_cast<float>(kTolerance * side_)),
        cells_(mesh.positions,
               static_cast<float>(side_ * std::max(4 * kTolerance, 1 / std::sqrt(mesh.positions.size() + 1.0))),
               longestAxis(box)) {
    const std::size_t step = std::max<std::size_t>(1, mesh.positions.size() / kSamples);
    for (std::size_t i = 0; i < mesh.positions.size(); i += step) samples_.push_back(static_cast<Index>(i));
  }

  std::optional<MirrorMap> run();

 private:
  Vec3f reflect(const MirrorPlane& plane, const Vec3f& p) const {
    const Vec3 q = p.cast<double>();
    return (q - 2 * (plane.normal.dot(q) - plane.offset) * plane.normal).cast<float>();
  }
  Index imageOf(const MirrorPlane& plane, Index v, float widen = 1) const {
    return cells_.nearest(reflect(plane, mesh_.positions[v]), widen * reach_, [](Index) { return true; });
  }
  double sampleFit(const MirrorPlane& plane) const;
  MirrorPlane straightened(MirrorPlane plane) const;
  MirrorPlane refined(const MirrorPlane& plane) const;
  std::optional<MirrorMap> matched(const MirrorPlane& plane) const;
  bool enough(const MirrorMap& map) const;
  void measureSurface();

  const TriMesh& mesh_;
  double side_;
  Vec3 middle_;
  float reach_;  // kTolerance in units of the mesh
  CellHash cells_;
  std::vector<Index> samples_;
  Vec3 centroid_ = Vec3::Zero();  // of the surface
  Mat3 principal_ = Mat3::Identity();
};

// The share of sampled vertices that have an image.
double MirrorFinder::sampleFit(const MirrorPlane& plane) const {
  std::size_t found = 0;
  for (const Index v : samples_) found += imageOf(plane, v) != kNoIndex ? 1 : 0;
  return static_cast<double>(found) / static_cast<double>(samples_.size());
}

// The plane moved to the median of the middles between vertices and images, if that is a noticeable way.
MirrorPlane MirrorFinder::refined(const MirrorPlane& plane) const {
  std::vector<double> middles;
  for (const Index v : samples_) {
    const Index image = imageOf(plane, v);
    if (image != kNoIndex) middles.push_back(0.5 * plane.normal.dot(mesh_.position(v) + mesh_.position(image)));
  }
  if (middles.empty()) return plane;
  const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
  std::nth_element(middles.begin(), median, middles.end());
  return std::abs(*median - plane.offset) < 0.02 * kTolerance * side_ ? plane : MirrorPlane{plane.normal, *median};
}

// A plane turned and moved so that it lies across and halfway between vertices and images, looked for ever closer.
MirrorPlane MirrorFinder::straightened(MirrorPlane plane) const {
  for (const float widen : {8.0f, 3.0f}) {
    Vec3 across = Vec3::Zero(), middle = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < samples_.size(); i += 4) {
      const Index v = samples_[i], image = imageOf(plane, v, widen);
      if (image == kNoIndex) continue;
      const Vec3 p = mesh_.position(v), q = mesh_.position(image);
      across += plane.normal.dot(p - q) > 0 ? p - q : q - p;
      middle += 0.5 * (p + q);
      ++count;
    }
    if (count == 0 || !(across.norm() > 0)) return plane;
    plane.normal = across.normalized();
    plane.offset = plane.normal.dot(middle) / count;
  }
  return plane;
}

bool MirrorFinder::enough(const MirrorMap& map) const {
  double area = 0, matchedArea = 0, width = 0;
  std::size_t matchedCount = 0;
  for (Index v = 0; v < map.image.size(); ++v) {
    if (map.image[v] == kNoIndex) continue;
    ++matchedCount;
    width += std::abs(map.plane.normal.dot(mesh_.position(v)) - map.plane.offset);
  }
  for (const Triangle& t : mesh_.triangles) {
    const Vec3 a = mesh_.position(t[0]), b = mesh_.position(t[1]), c = mesh_.position(t[2]);
    const double triangleArea = (b - a).cross(c - a).norm();
    area += triangleArea;
    const bool whole = map.image[t[0]] != kNoIndex && map.image[t[1]] != kNoIndex && map.image[t[2]] != kNoIndex;
    if (whole) matchedArea += triangleArea;
  }
  const double count = static_cast<double>(map.image.size());
  return static_cast<double>(matchedCount) >= kEnough * count && matchedArea >= kEnough * area &&
         width >= kLeastWidth * side_ * count;
}

std::optional<MirrorMap> MirrorFinder::matched(const MirrorPlane& plane) const {
  const Index count = mesh_.vertexCount();
  std::vector<Index> nearest(count);
  parallelFor(count, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) nearest[v] = imageOf(plane, static_cast<Index>(v));
  });
  MirrorMap map{plane, std::vector<Index>(count, kNoIndex)};
  std::vector<Index> left;
  for (Index v = 0; v < count; ++v) {
    if (nearest[v] != kNoIndex && nearest[nearest[v]] == v) {
      map.image[v] = nearest[v];
    } else {
      left.push_back(v);
    }
  }
  if (left.size() > count / 4) return std::nullopt;
  // Those that are not each other's nearest take what is left within reach.
  for (const Index v : left) {
    if (map.image[v] != kNoIndex) continue;
    const Index image = cells_.nearest(reflect(plane, mesh_.positions[v]), reach_,
                                       [&](Index other) { return map.image[other] == kNoIndex; });
    if (image == kNoIndex) continue;
    map.image[v] = image;
    map.image[image] = v;
  }
  if (!enough(map)) return std::nullopt;
  return map;
}

// Centroid and principal axes of the surface.
void MirrorFinder::measureSurface() {
  double weight = 0;
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : mesh_.triangles) {
    const Vec3 a = mesh_.position(t[0]), b = mesh_.position(t[1]), c = mesh_.position(t[2]);
    const Vec3 p = a - middle_, q = b - middle_, r = c - middle_, sum = p + q + r;
    const double area = (b - a).cross(c - a).norm();
    weight += area;
    centroid_ += area / 3 * sum;
    second += area / 12 * (p * p.transpose() + q * q.transpose() + r * r.transpose() + sum * sum.transpose());
  }
  if (!(weight > 0)) {
    centroid_ = middle_;
    return;
  }
  centroid_ /= weight;
  principal_ = Eigen::SelfAdjointEigenSolver<Mat3>(second / weight - centroid_ * centroid_.transpose()).eigenvectors();
  centroid_ += middle_;
}

std::optional<MirrorMap> MirrorFinder::run() {
  measureSurface();
  const Mat3& axes = principal_;
  const std::array<Vec3, 6> normals = {Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY(),
                                       axes.col(0),   axes.col(1),   axes.col(2)};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (const Vec3& center : {middle_, centroid_}) {
      if (i >= 3 && center == middle_) continue;  // the box says nothing about slanting planes
      MirrorPlane plane{normals[i], normals[i].dot(center)};
      if (i >= 3) plane = straightened(plane);
      if (sampleFit(plane) < 0.5) continue;
      plane = refined(plane);
      if (sampleFit(plane) < 0.95) continue;
      if (std::optional<MirrorMap> map = matched(plane)) return map;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<MirrorMap> findMirror(const TriMesh& mesh) {
  Box box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
  if (!(box.longestSide() > 0)) return std::nullopt;
  return MirrorFinder(mesh, box).run();
}

}  // namespace limber
