#include "limber/preview/shapes.h"

#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr int kSphereRings = 16;
constexpr int kAround = 32;
constexpr double kBoneWidth = 0.075;  // of its length
constexpr double kWidestAt = 0.14;    // of its length from the joint

Index addVertex(ShapeMesh& mesh, const Vec3& position, const Vec3& normal, const Vec3f& color) {
  mesh.positions.push_back(position.cast<float>());
  mesh.normals.push_back(normal.cast<float>());
  mesh.colors.push_back(color);
  return static_cast<Index>(mesh.positions.size() - 1);
}

struct Frame {
  Vec3 along, u, v;
};

Frame frameAlong(const Vec3& direction) {
  Frame frame;
  frame.along = direction.normalized();
  const Vec3 helper = std::abs(frame.along.y()) < 0.8 ? Vec3::UnitY() : Vec3::UnitZ();
  frame.u = helper.cross(frame.along).normalized();
  frame.v = frame.along.cross(frame.u);
  return frame;
}

void addFlatTriangle(ShapeMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3f& color) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Index first = addVertex(mesh, a, normal, color);
  addVertex(mesh, b, normal, color);
  addVertex(mesh, c, normal, color);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

void addSphere(ShapeMesh& mesh, const Vec3& center, double radius, const Vec3f& color) {
  const Index first = static_cast<Index>(mesh.positions.size());
  for (int ring = 0; ring <= kSphereRings; ++ring) {
    const double polar = kPi * ring / kSphereRings;
    for (int i = 0; i < kAround; ++i) {
      const double turn = 2 * kPi * i / kAround;
      const Vec3 normal(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
      addVertex(mesh, center + radius * normal, normal, color);
    }
  }
  for (Index ring = 0; ring < kSphereRings; ++ring) {
    for (Index i = 0; i < kAround; ++i) {
      const Index j = (i + 1) % kAround;
      const Index a = first + ring * kAround + i, b = first + ring * kAround + j;
      if (ring > 0) mesh.triangles.push_back({a, b, b + kAround});
      if (ring + 1 < kSphereRings) mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
}

void addTaperedLink(ShapeMesh& mesh, const Vec3& a, const Vec3& b, double ra, double rb, const Vec3f& color) {
  if (a == b) return;
  const Frame frame = frameAlong(b - a);
  const Index first = static_cast<Index>(mesh.positions.size());
  for (int i = 0; i < kAround; ++i) {
    const double turn = 2 * kPi * i / kAround;
    const Vec3 out = std::cos(turn) * frame.u + std::sin(turn) * frame.v;
    addVertex(mesh, a + ra * out, out, color);
    addVertex(mesh, b + rb * out, out, color);
  }
  for (Index i = 0; i < kAround; ++i) {
    const Index p = first + 2 * i, q = first + 2 * ((i + 1) % kAround);
    mesh.triangles.push_back({p, q, q + 1});
    mesh.triangles.push_back({p, q + 1, p + 1});
  }
}

void addOctahedralBone(ShapeMesh& mesh, const Vec3& a, const Vec3& b, const Vec3f& color) {
  if (a == b) return;
  const Frame frame = frameAlong(b - a);
  const double length = (b - a).norm(), half = kBoneWidth * length;
  const Vec3 middle = a + kWidestAt * (b - a);
  const std::array<Vec3, 4> belt = {middle + half * (frame.u + frame.v), middle + half * (frame.v - frame.u),
                                    middle - half * (frame.u + frame.v), middle + half * (frame.u - frame.v)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &p = belt[i], &q = belt[(i + 1) % 4];
    addFlatTriangle(mesh, b, p, q, color);
    addFlatTriangle(mesh, a, q, p, color);
  }
}

}  // namespace limber
