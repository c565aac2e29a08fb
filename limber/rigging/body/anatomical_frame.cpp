#include "limber/rigging/body/anatomical_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber {

namespace {

constexpr double kSymmetric = 0.25;         // most asymmetry of a body that counts as symmetric
constexpr double kClearlySymmetric = 0.12;  // below: no other plane is looked for
constexpr double kMoreSymmetric = 0.6;      // of the least asymmetry along the axes, that another plane's is at most
constexpr double kPlaneSearch = 0.15;       // part of the width that the plane may lie off the middle of the box
constexpr int kPlaneSteps = 30;             // to each side
constexpr int kNormals = 5;                 // of planes that are tried all around, from a face to an edge of a cube
constexpr double kCoarseTurn = 0.06, kFineTurn = 0.003;  // radians, about the best of these

// How much deeper or less deep the mirror images of the medial spheres lie than they do themselves.
double asymmetryOf(const AnatomicalFrame& frame, const BodyVolume& body) {
  double difference = 0, whole = 0;
  for (const MedialSphere& sphere : body.spheres) {
    const double depth = -body.distance->at(frame.mirrored(sphere.center));
    difference += std::min(std::abs(depth - sphere.radius), 1.5 * sphere.radius);
    whole += sphere.radius;
  }
  return whole > 0 ? difference / whole : 1;
}

// Directions all around, but for their opposites: a grid on half the faces of a cube. No sines: every compiler's
// differ.
std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  for (int i = -kNormals; i <= kNormals; ++i) {
    for (int j = -kNormals; j <= kNormals; ++j) {
      const double a = static_cast<double>(i) / kNormals, b = static_cast<double>(j) / kNormals;
      for (const Vec3& direction : {Vec3(1, a, b), Vec3(a, 1, b), Vec3(a, b, 1)}) all.push_back(direction.normalized());
    }
  }
  return all;
}

// Of the plane through the middle of the body's mass that the body is most symmetric to.
Vec3 maxSymmetricNormal(const BodyVolume& body) {
  AnatomicalFrame frame;
  double mass = 0;
  for (const MedialSphere& sphere : body.spheres) {
    const double weight = sphere.radius * sphere.radius * sphere.radius;
    frame.origin += weight * sphere.center;
    mass += weight;
  }
  if (mass > 0) frame.origin /= mass;
  Vec3 best = Vec3::UnitX();
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& normal) {
    frame.axes.row(0) = normal.transpose();
    const double asymmetry = asymmetryOf(frame, body);
    if (asymmetry < least) {
      least = asymmetry;
      best = normal;
      return true;
    }
    return false;
  };
  for (const Vec3& normal : directions()) look(normal);
  for (double turn = kCoarseTurn; turn > kFineTurn;) {
    const Vec3 one = best.unitOrthogonal(), other = best.cross(one), from = best;
    bool better = false;
    for (const Vec3& direction : {one, Vec3(-one), other, Vec3(-other)}) {
      better = look((from + turn * direction).normalized()) || better;
    }
    if (!better) turn /= 2;
  }
  return best;
}

// Of bodies that stand along no axis: those whose up is nearest to `ups`, with both fronts.
std::vector<AnatomicalFrame> slantingFrames(const TriMesh& mesh, const BodyVolume& body, const std::vector<Vec3>& ups) {
  const Vec3 left = maxSymmetricNormal(body);
  std::vector<AnatomicalFrame> frames;
  for (const Vec3& u : ups) {
    if (std::abs(u.dot(left)) > 0.5) continue;
    const Vec3 up = (u - u.dot(left) * left).normalized(), front = left.cross(up);
    for (const Vec3& f : {front, Vec3(-front)}) frames.push_back(frameAlong(mesh, body, up, f));
  }
  return frames;
}

double minAsymmetry(const std::vector<AnatomicalFrame>& frames) {
  double least = std::numeric_limits<double>::infinity();
  for (const AnatomicalFrame& frame : frames) least = std::min(least, frame.asymmetry);
  return least;
}

}  // namespace

bool AnatomicalFrame::symmetric() const {
  return asymmetry < kSymmetric;
}

Vec3 AnatomicalFrame::mirrored(const Vec3& point) const {
  const Vec3 left = axes.row(0).transpose();
  return point - 2 * left.dot(point - origin) * left;
}

AnatomicalFrame frameAlong(const TriMesh& mesh, const BodyVolume& body, const Vec3& up, const Vec3& front) {
  AnatomicalFrame frame;
  frame.axes.row(0) = up.cross(front).transpose();
  frame.axes.row(1) = up.transpose();
  frame.axes.row(2) = front.transpose();
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) box.add(frame.axes * mesh.position(v));
  }
  frame.height = std::max(box.size().y(), 1e-6);
  const Vec3 bottom(box.center().x(), box.min.y(), box.center().z());
  AnatomicalFrame best = frame;
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

std::vector<AnatomicalFrame> possibleFrames(const TriMesh& mesh, const BodyVolume& body, const std::optional<Vec3>& up,
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
  std::vector<AnatomicalFrame> frames;
  for (const Vec3& u : ups) {
    for (const Vec3& f : fronts) {
      if (std::abs(u.dot(f)) < 0.5) frames.push_back(frameAlong(mesh, body, u, f));
    }
  }
  const double along = minAsymmetry(frames);
  if (front || along < kClearlySymmetric) return frames;
  const std::vector<AnatomicalFrame> slanting = slantingFrames(mesh, body, ups);
  const double least = minAsymmetry(slanting);
  return least < std::min(kSymmetric, kMoreSymmetric * along) ? slanting : frames;
}

}  // namespace limber
