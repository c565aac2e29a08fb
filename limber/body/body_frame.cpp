#include "limber/body/body_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber {

namespace {

constexpr double kSymmetric = 0.25;    // most asymmetry of a body that counts as symmetric
constexpr double kPlaneSearch = 0.15;  // part of the width that the plane may lie off the middle of the box
constexpr int kPlaneSteps = 30;        // to each side

// How much deeper or less deep the mirror images of the medial spheres lie than they do themselves.
double asymmetryOf(const BodyFrame& frame, const BodyVolume& body) {
  double difference = 0, whole = 0;
  for (const MedialSphere& sphere : body.spheres) {
    const double depth = -body.distance->at(frame.mirrored(sphere.center));
    difference += std::min(std::abs(depth - sphere.radius), 1.5 * sphere.radius);
    whole += sphere.radius;
  }
  return whole > 0 ? difference / whole : 1;
}

}  // namespace

bool BodyFrame::symmetric() const {
  return asymmetry < kSymmetric;
}

Vec3 BodyFrame::mirrored(const Vec3& point) const {
  const Vec3 left = axes.row(0).transpose();
  return point - 2 * left.dot(point - origin) * left;
}

BodyFrame frameAlong(const TriMesh& mesh, const BodyVolume& body, const Vec3& up, const Vec3& front) {
  BodyFrame frame;
  frame.axes.row(0) = up.cross(front).transpose();
  frame.axes.row(1) = up.transpose();
  frame.axes.row(2) = front.transpose();
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) box.add(frame.axes * mesh.position(v));
  }
  frame.height = std::max(box.size().y(), 1e-6);
  const Vec3 bottom(box.center().x(), box.min.y(), box.center().z());
  BodyFrame best = frame;
  best.asymmetry = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= 2 * kPlaneSteps; ++step) {
    // From the middle outwards, so that of equals the one nearest to the middle stays.
    const int side = step % 2 == 0 ? step / 2 : -(step + 1) / 2;
    const double offset = kPlaneSearch * box.size().x() * side / kPlaneSteps;
    frame.origin = frame.axes.transpose() * (bottom + offset * Vec3::UnitX());
    frame.asymmetry = asymmetryOf(frame, body) + 0.3 * std::abs(offset) / box.size().x();
    if (frame.asymmetry < best.asymmetry) best = frame;
  }
  return best;
}

std::vector<BodyFrame> possibleFrames(const TriMesh& mesh, const BodyVolume& body, const std::optional<Vec3>& up,
                                      const std::optional<Vec3>& front) {
  std::vector<Vec3> ups, fronts;
  if (up) {
    ups = {*up};
  } else {
    ups = {Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ(), -Vec3::UnitY(), Vec3::UnitX(), -Vec3::UnitX()};
  }
  if (front) {
    fronts = {*front};
  } else {
    fronts = {Vec3::UnitZ(), -Vec3::UnitZ(), -Vec3::UnitY(), Vec3::UnitY(), Vec3::UnitX(), -Vec3::UnitX()};
  }
  std::vector<BodyFrame> frames;
  for (const Vec3& u : ups) {
    for (const Vec3& f : fronts) {
      if (std::abs(u.dot(f)) < 0.5) frames.push_back(frameAlong(mesh, body, u, f));
    }
  }
  return frames;
}

}  // namespace limber
