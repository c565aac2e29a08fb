#include "limber/samples/half_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limber/core/text/numbers.h"

namespace limber {
namespace {

Sculpture ball(double radius) {
  Sculpture s;
  s.add(ellipsoid({0, 0, 0}, {radius, radius, radius}), 0.01);
  return s;
}

// A body with two thin arms, so that there is something to lose.
Sculpture figure() {
  Sculpture s;
  s.add(ellipsoid({0, 0, 0}, {0.3, 0.4, 0.25}), 0.05);
  s.add(roundCone({0.2, 0.1, 0}, 0.06, {0.8, 0.3, 0.1}, 0.02), 0.05);
  return s;
}

// #V - #E + #F, where each edge has two triangles; fails the test where one has not.
long eulerNumber(const SymmetricMesh& mesh) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) ++edges[std::minmax(t[c], t[(c + 1) % 3])];
  }
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 2);
  return long(mesh.positions.size()) - long(edges.size()) + long(mesh.triangles.size());
}

double area(const SymmetricMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3f& a = mesh.positions[t[0]];
    sum += 0.5 * double((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm());
  }
  return sum;
}

TEST(Polygonize, ABallIsClosedAndOfItsSize) {
  const Sculpture s = ball(0.5);
  const SymmetricMesh mesh = mirrorHalf(polygonize(s, 0.05), s);
  EXPECT_EQ(eulerNumber(mesh), 2);
  EXPECT_NEAR(area(mesh), kPi, 0.03);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_NEAR(mesh.positions[v].norm(), 0.5, 2e-4);
    EXPECT_GT(mesh.normals[v].dot(mesh.positions[v].normalized()), 0.999);
  }
}

TEST(Polygonize, APinchedPlaceStaysManifold) {
  // Two balls that touch along a diagonal of the grid, at many offsets.
  for (int i = 0; i < 8; ++i) {
    const double gap = 0.1 + 0.004 * i;
    Sculpture s;
    s.add(ellipsoid({0, 0, 0}, {0.1, 0.1, 0.1}), 0.001);
    s.add(ellipsoid({0, 1.41421356 * gap, 1.41421356 * gap}, {0.1, 0.1, 0.1}), 0.001);
    eulerNumber(mirrorHalf(polygonize(s, 0.023), s));
  }
}

TEST(Remesh, EdgesComeCloseToTheWantedLengthAndNothingIsLost) {
  const Sculpture s = figure();
  HalfMesh half = polygonize(s, 0.02);
  remesh(half, s, 0.05, {});
  const SymmetricMesh mesh = mirrorHalf(half, s);
  EXPECT_EQ(eulerNumber(mesh), 2);
  double longest = 0, reach = 0;
  int thin = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f p = mesh.positions[t[c]];
      const Vec3f u = (mesh.positions[t[(c + 1) % 3]] - p), v = (mesh.positions[t[(c + 2) % 3]] - p);
      longest = std::max(longest, double(u.norm()));
      reach = std::max(reach, double(p.x()));
      if (u.normalized().dot(v.normalized()) > std::cos(20 * kDegree)) ++thin;
    }
  }
  EXPECT_LT(longest, 0.09);
  EXPECT_NEAR(reach, 0.82, 0.006);  // the tip of the arm, but for the sag of edges
  EXPECT_LT(thin, int(mesh.triangles.size()) / 100);
}

TEST(Remesh, RegionsAreFiner) {
  const Sculpture s = ball(0.5);
  HalfMesh plain = polygonize(s, 0.05), fine = plain;
  remesh(plain, s, 0.1, {});
  remesh(fine, s, 0.1, {{ellipsoid({0, 0.5, 0}, {0.1, 0.1, 0.1}), 0.02}});
  const auto countNear = [](const HalfMesh& mesh) {
    return std::count_if(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& p) { return p.y() > 0.49; });
  };
  EXPECT_GT(countNear(fine), 5 * countNear(plain));
}

TEST(Paint, TheBorderIsSharp) {
  const Sculpture s = ball(0.5);
  HalfMesh half = polygonize(s, 0.05);
  const Solid cap = ellipsoid({0, 0.6, 0}, {0.4, 0.4, 0.4});
  paint(half, s, cap, 3);
  EXPECT_EQ(eulerNumber(mirrorHalf(half, s)), 2);
  // Vertices of both materials lie on the border, all others on their own side of it.
  std::vector<int> seen(half.positions.size(), 0);
  for (std::size_t t = 0; t < half.triangles.size(); ++t) {
    for (const Index v : half.triangles[t]) seen[v] |= half.materials[t] == 3 ? 1 : 2;
  }
  EXPECT_GT(std::count(seen.begin(), seen.end(), 3), 10);
  for (std::size_t v = 0; v < seen.size(); ++v) {
    const double level = cap.distance(half.positions[v]);
    if (seen[v] == 3) {
      EXPECT_NEAR(level, 0, 0.004);
    }
    if (seen[v] == 1) {
      EXPECT_LT(level, 0.004);
    }
    if (seen[v] == 2) {
      EXPECT_GT(level, -0.004);
    }
  }
}

TEST(MirrorHalf, EveryVertexHasItsTwin) {
  const Sculpture s = figure();
  const SymmetricMesh mesh = mirrorHalf(polygonize(s, 0.04), s);
  const auto key = [](const Vec3f& p) { return std::array<float, 3>{p.x() == 0 ? 0.0f : p.x(), p.y(), p.z()}; };
  std::map<std::array<float, 3>, int> count;
  for (const Vec3f& p : mesh.positions) ++count[key(p)];
  for (const Vec3f& p : mesh.positions) EXPECT_EQ(count.count(key({-p.x(), p.y(), p.z()})), 1u);
}

}  // namespace
}  // namespace limber
