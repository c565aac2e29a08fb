#include "bench_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber::bench {

namespace {

// A sphere's grid of rows and columns with two poles: columns * (rows - 1) + 2 vertices.
TriMesh sphereGrid(Index rows, Index columns) {
  TriMesh mesh;
  mesh.positions.push_back({0, 1, 0});
  for (Index row = 1; row < rows; ++row) {
    const double polar = kPi * row / rows;
    for (Index column = 0; column < columns; ++column) {
      const double turn = 2 * kPi * column / columns;
      mesh.positions.push_back(
          Vec3(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)).cast<float>());
    }
  }
  mesh.positions.push_back({0, -1, 0});
  const auto at = [&](Index row, Index column) { return 1 + (row - 1) * columns + column % columns; };
  for (Index column = 0; column < columns; ++column) {
    mesh.triangles.push_back({0, at(1, column), at(1, column + 1)});
    for (Index row = 1; row + 1 < rows; ++row) {
      mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
      mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
    }
    mesh.triangles.push_back({at(rows - 1, column), mesh.vertexCount() - 1, at(rows - 1, column + 1)});
  }
  return mesh;
}

// How far the surface is from the middle in a direction: a body, limbs as steep hills, and small hills everywhere.
double radiusTowards(const Vec3& d, bool symmetric) {
  static const std::array<Vec3, 6> limbs = {Vec3(1, 0.4, 0.1),  Vec3(-1, 0.4, 0.1), Vec3(0.45, -1, 0),
                                            Vec3(-0.45, -1, 0), Vec3(0, 1, 0.2),    Vec3(0, -0.3, -1)};
  double radius = 0.35;
  for (const Vec3& limb : limbs) radius += 1.1 * std::exp(60 * (d.dot(limb.normalized()) - 1));
  radius += 0.01 * std::sin(11 * d.y()) * std::cos(13 * d.z()) * std::cos(9 * d.x());
  if (!symmetric) radius += 0.02 * std::sin(7 * d.x() + 5 * d.y() + 1) + 0.1 * d.x() * d.x() * d.x();
  return radius;
}

void fitInto(TriMesh& mesh, double side) {
  Box box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
  for (Vec3f& p : mesh.positions) {
    p = ((p.cast<double>() - box.center()) * (side / box.longestSide())).cast<float>();
  }
}

}  // namespace

TriMesh creature(Index vertexCount, bool symmetric) {
  const Index rows = std::max<Index>(4, static_cast<Index>(std::sqrt(vertexCount / 2.0)));
  Index columns = std::max<Index>(4, vertexCount / (rows - 1));
  columns += columns % 2;
  TriMesh mesh = sphereGrid(rows, columns);
  for (Vec3f& p : mesh.positions) {
    // The exact image of the other side, so that rounding does not hide the symmetry.
    Vec3 d = p.cast<double>().normalized();
    const double radius = radiusTowards(symmetric ? Vec3(std::abs(d.x()), d.y(), d.z()) : d, symmetric);
    p = (radius * d).cast<float>();
  }
  fitInto(mesh, 1);
  return mesh;
}

TriMesh swarm(Index vertexCount) {
  TriMesh one = creature(100);
  fitInto(one, 0.03);
  TriMesh mesh;
  std::uint32_t state = 1;
  const auto unit = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f;
  };
  while (mesh.vertexCount() < vertexCount) {
    const Vec3f position(unit(), unit(), unit());
    const Index first = mesh.vertexCount();
    for (const Vec3f& p : one.positions) mesh.positions.push_back(p + position);
    for (const Triangle& t : one.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return mesh;
}

}  // namespace limber::bench
