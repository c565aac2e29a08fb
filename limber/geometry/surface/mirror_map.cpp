#include "limber/geometry/surface/mirror_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/surface/point_tree.h"

namespace limber {

namespace {

constexpr double kTolerance = 3e-3;  // of the longest side, between a mirrored vertex and its image
constexpr double kEnough = 0.98;     // of vertices and of area
constexpr double kMinWidth = 0.01;   // mean distance from the plane, of the longest side: less is a sheet in the plane
constexpr std::size_t kSamples = 400;

class MirrorFinder {
 public:
  MirrorFinder(const TriMesh& mesh, const Box& box, const Progress* progress)
      : mesh_(mesh),
        progress_(progress),
        side_(box.longestSide()),
        middle_(box.center()),
        reach_(static_cast<float>(kTolerance * side_)),
        tree_(mesh.positions) {
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
    return tree_.nearest(reflect(plane, mesh_.positions[v]), widen * reach_);
  }
  bool isCancelled() const { return progress_ && progress_->cancelled(); }
  double sampleFit(const MirrorPlane& plane) const;
  MirrorPlane straightened(MirrorPlane plane) const;
  MirrorPlane refined(const MirrorPlane& plane) const;
  std::optional<MirrorMap> matched(const MirrorPlane& plane) const;
  void matchLeft(const std::vector<Index>& left, MirrorMap& map) const;
  bool enough(const MirrorMap& map) const;
  void measureSurface();

  const TriMesh& mesh_;
  const Progress* progress_;
  double side_;
  Vec3 middle_;
  float reach_;  // kTolerance in units of the mesh
  PointTree tree_;
  std::vector<Index> samples_;
  Vec3 centroid_ = Vec3::Zero();  // of the surface
  Mat3 principal_ = Mat3::Identity();
};

// The fraction of sampled vertices that have an image.
double MirrorFinder::sampleFit(const MirrorPlane& plane) const {
  std::size_t found = 0;
  for (const Index v : samples_) found += imageOf(plane, v) != kNoIndex ? 1 : 0;
  return static_cast<double>(found) / static_cast<double>(samples_.size());
}

// The plane moved to the median of the midpoints of vertices and images, if that is a noticeable distance away.
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
         width >= kMinWidth * side_ * count;
}

// Vertices that are not each other's nearest, one after the other, take what is left within reach.
void MirrorFinder::matchLeft(const std::vector<Index>& left, MirrorMap& map) const {
  std::vector<Vec3f> points;
  for (const Index v : left) points.push_back(mesh_.positions[v]);
  PointTree others(points);
  for (Index i = 0; i < left.size() && !isCancelled(); ++i) {
    const Index v = left[i];
    if (map.image[v] != kNoIndex) continue;
    const Index found = others.nearest(reflect(map.plane, points[i]), reach_);
    if (found == kNoIndex) continue;
    map.image[v] = left[found];
    map.image[left[found]] = v;
    others.takeOut(i);
    if (found != i) others.takeOut(found);
  }
}

std::optional<MirrorMap> MirrorFinder::matched(const MirrorPlane& plane) const {
  const Index count = mesh_.vertexCount();
  std::vector<Index> nearest(count);
  parallelFor(count, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !isCancelled(); ++i) {
      const Index v = tree_.order()[i];  // along the curve: images follow each other in memory, too
      nearest[v] = imageOf(plane, v);
    }
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
  matchLeft(left, map);
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
      if (isCancelled()) return std::nullopt;
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

std::optional<MirrorMap> findMirror(const TriMesh& mesh, const Progress* progress) {
  const Box box = modelBox(mesh);
  if (!(box.longestSide() > 0)) return std::nullopt;
  std::optional<MirrorMap> map = MirrorFinder(mesh, box, progress).run();
  if (progress && progress->cancelled()) return std::nullopt;
  return map;
}

}  // namespace limber
