#include "limber/geometry/surface/mirror_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/surface/point_tree.h"

namespace limber {

namespace {

constexpr double kEnough = 0.98;    // of vertices and of area
constexpr double kMinWidth = 0.01;  // mean distance from the plane, of the longest side: less is a sheet in the plane
constexpr std::size_t kSamples = 400;

// Of the longest side:
constexpr double kTolerance = 3e-3;           // between a mirrored vertex and its image
constexpr double kSurfaceTolerance = 1.5e-2;  // between a mirrored vertex and the surface, where the sides differ
constexpr double kMaxReach = 3e-2;            // between a mirrored vertex and its image there
constexpr double kEnoughPaired = 0.75;        // of the vertices there

// Of at least one; the upper of two.
double medianOf(std::vector<double>& values) {
  const auto median = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), median, values.end());
  return *median;
}

class MirrorFinder {
 public:
  MirrorFinder(const TriMesh& mesh, const Box& box, const Progress* progress)
      : mesh_(mesh), progress_(progress), side_(box.longestSide()), middle_(box.center()), tree_(mesh.positions) {
    const std::size_t step = std::max<std::size_t>(1, mesh.positions.size() / kSamples);
    for (std::size_t i = 0; i < mesh.positions.size(); i += step) samples_.push_back(static_cast<Index>(i));
  }

  std::optional<MirrorMap> run();

 private:
  // What counts as an image: a vertex where the sides are equal; where they only look equal a vertex that is no farther
  // away than the next one on its own side, and the surface near by.
  struct Sides {
    double reach = 0;   // of the longest side
    double enough = 0;  // of vertices and of area that have one
    bool onlyLookEqual = false;
  };
  std::optional<MirrorMap> find(const Sides& sides);
  double vertexSpacing() const;
  bool surfaceFits(const MirrorPlane& plane);
  Vec3f reflect(const MirrorPlane& plane, const Vec3f& p) const {
    const Vec3 q = p.cast<double>();
    return (q - 2 * (plane.normal.dot(q) - plane.offset) * plane.normal).cast<float>();
  }
  Index imageOf(const MirrorPlane& plane, Index v, float widen = 1) const {
    return tree_.nearest(reflect(plane, mesh_.positions[v]), widen * reach_);
  }
  bool isCancelled() const { return progress_ && progress_->cancelled(); }
  double sampleFit(const MirrorPlane& plane, std::size_t step = 1) const;
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
  Sides sides_;
  std::optional<Bvh> surface_;  // made when it is first needed
  float reach_ = 0;             // in units of the mesh
  PointTree tree_;
  std::vector<Index> samples_;
  Vec3 centroid_ = Vec3::Zero();  // of the surface
  Mat3 principal_ = Mat3::Identity();
};

// Of every step-th sampled vertex the fraction that has an image.
double MirrorFinder::sampleFit(const MirrorPlane& plane, std::size_t step) const {
  double found = 0, all = 0;
  for (std::size_t i = 0; i < samples_.size(); i += step, ++all) {
    if (imageOf(plane, samples_[i]) != kNoIndex) ++found;
  }
  return found / all;
}

// The plane moved to the median of the midpoints of vertices and images, if that is a noticeable distance away.
MirrorPlane MirrorFinder::refined(const MirrorPlane& plane) const {
  std::vector<double> middles;
  for (const Index v : samples_) {
    const Index image = imageOf(plane, v);
    if (image != kNoIndex) middles.push_back(0.5 * plane.normal.dot(mesh_.position(v) + mesh_.position(image)));
  }
  if (middles.empty()) return plane;
  const double median = medianOf(middles);
  return std::abs(median - plane.offset) < 0.02 * kTolerance * side_ ? plane : MirrorPlane{plane.normal, median};
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
  return static_cast<double>(matchedCount) >= sides_.enough * count && matchedArea >= sides_.enough * area &&
         width >= kMinWidth * side_ * static_cast<double>(matchedCount);
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
  if (left.size() > count / (sides_.onlyLookEqual ? 2 : 4)) return std::nullopt;
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
  for (int axis = 0; axis < 3; ++axis) {  // as the axis of space that it is nearest to
    Eigen::Index nearest = 0;
    principal_.col(axis).cwiseAbs().maxCoeff(&nearest);
    if (principal_(nearest, axis) < 0) principal_.col(axis) *= -1;
  }
  centroid_ += middle_;
}

// Whether nearly all of the surface, mirrored, lies on the surface.
bool MirrorFinder::surfaceFits(const MirrorPlane& plane) {
  if (!surface_) surface_.emplace(mesh_);
  double fits = 0, all = 0;
  const auto take = [&](const Vec3f& point, double weight) {
    all += weight;
    const double distance = surface_->nearestPoint(reflect(plane, point).cast<double>()).distance;
    if (distance <= kSurfaceTolerance * side_) fits += weight;
  };
  for (const Index v : samples_) take(mesh_.positions[v], 1);
  if (fits < kEnough * all) return false;
  fits = all = 0;
  const std::size_t step = std::max<std::size_t>(1, mesh_.triangles.size() / (4 * kSamples));
  for (std::size_t i = 0; i < mesh_.triangles.size(); i += step) {
    const Triangle& t = mesh_.triangles[i];
    const Vec3f a = mesh_.positions[t[0]], b = mesh_.positions[t[1]], c = mesh_.positions[t[2]];
    take((a + b + c) / 3, (b - a).cross(c - a).norm());
  }
  return fits >= kEnough * all;
}

// Median length of the edges of some triangles, in units of the mesh.
double MirrorFinder::vertexSpacing() const {
  std::vector<double> lengths;
  const std::size_t step = std::max<std::size_t>(1, mesh_.triangles.size() / kSamples);
  for (std::size_t i = 0; i < mesh_.triangles.size(); i += step) {
    const Triangle& t = mesh_.triangles[i];
    for (int k = 0; k < 3; ++k) lengths.push_back((mesh_.position(t[k]) - mesh_.position(t[(k + 1) % 3])).norm());
  }
  return medianOf(lengths);
}

std::optional<MirrorMap> MirrorFinder::run() {
  measureSurface();
  if (std::optional<MirrorMap> map = find({kTolerance, kEnough, false})) return map;
  if (mesh_.triangles.empty() || isCancelled()) return std::nullopt;
  const double reach = std::clamp(vertexSpacing() / side_, kSurfaceTolerance, kMaxReach);
  return find({reach, kEnoughPaired, true});
}

std::optional<MirrorMap> MirrorFinder::find(const Sides& sides) {
  sides_ = sides;
  reach_ = static_cast<float>(sides.reach * side_);
  const Mat3& axes = principal_;
  const std::array<Vec3, 6> normals = {Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY(),
                                       axes.col(0),   axes.col(1),   axes.col(2)};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (const Vec3& center : {middle_, centroid_}) {
      if (isCancelled()) return std::nullopt;
      if (i >= 3 && center == middle_) continue;  // the box says nothing about slanting planes
      MirrorPlane plane{normals[i], normals[i].dot(center)};
      const std::size_t step = sides.onlyLookEqual ? 8 : 1;  // within so large a reach the search is slow
      if (sides.onlyLookEqual && sampleFit(plane, step) < 0.3) continue;
      if (i >= 3) plane = straightened(plane);
      if (sampleFit(plane, step) < 0.5) continue;
      plane = refined(plane);
      if (sampleFit(plane) < (sides.onlyLookEqual ? kEnoughPaired : 0.95)) continue;
      if (sides.onlyLookEqual && !surfaceFits(plane)) continue;
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
