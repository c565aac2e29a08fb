#include "limber/actions/parts/face_graph.h"

#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

class FaceGraphOf : public ::testing::TestWithParam<testing::NamedMesh> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, FaceGraphOf, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

// Shortest paths by relaxing all arcs until nothing changes (Bellman, Ford).
std::vector<double> relaxed(const FaceGraph& graph, Index from) {
  std::vector<double> distances(graph.faceCount(), 1e300);
  distances[from] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const FaceArc& arc : graph.arcs) {
      for (const auto& [a, b] : {std::pair(arc.a, arc.b), std::pair(arc.b, arc.a)}) {
        if (!(distances[a] + arc.distance < distances[b])) continue;
        distances[b] = distances[a] + arc.distance;
        changed = true;
      }
    }
  }
  return distances;
}

TEST_P(FaceGraphOf, IsConnectedAndShortestWaysAreBellmansAndFords) {
  const TriMesh mesh = prepareMesh(GetParam().mesh.positions, GetParam().mesh.triangles).mesh;
  const FaceGraph graph = faceGraph(mesh);
  const Index count = graph.faceCount();
  ASSERT_EQ(count, mesh.triangleCount());
  std::size_t ends = 0;
  for (Index t = 0; t < count; ++t) {
    for (const Index a : graph.arcsAt.of(t)) EXPECT_NE(graph.across(a, t), t);
    ends += graph.arcsAt.of(t).size();
  }
  EXPECT_EQ(ends, 2 * graph.arcs.size());
  for (const FaceArc& arc : graph.arcs) {
    EXPECT_GE(arc.distance, 0);
    EXPECT_GE(arc.capacity, 0);
    EXPECT_TRUE(std::isfinite(arc.distance) && std::isfinite(arc.capacity));
  }
  for (const Index from : {Index{0}, count / 2, count - 1}) {
    const std::vector<double> distances = distancesFrom(graph, from), expected = relaxed(graph, from);
    for (Index t = 0; t < count; ++t) {
      ASSERT_LT(distances[t], 1e200);
      EXPECT_NEAR(distances[t], expected[t], 1e-9 * (1 + expected[t]));
    }
  }
}

// Three strips of the plane in a row, bent by `first` and then by `second` degrees, up or down.
TriMesh bentStrip(double first, double second) {
  TriMesh mesh;
  Vec3 at = Vec3::Zero();
  double direction = 0;
  for (const double bend : {0.0, first, second, 0.0}) {
    mesh.positions.push_back(at.cast<float>());
    mesh.positions.push_back((at + Vec3::UnitZ()).cast<float>());
    direction += bend * kPi / 180;
    at += Vec3(std::cos(direction), std::sin(direction), 0);
  }
  for (Index i = 0; i < 3; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
    mesh.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
  }
  return mesh;
}

TEST(FaceGraph, ConcaveEdgesAreFartherThanConvexOnesAndCheaperToCut) {
  const testing::BlockPerson person = testing::blockPerson();
  const FaceGraph graph = faceGraph(person.mesh);
  double concave = 1e300, convex = 0, flat = 0, cheapest = 1e300;
  for (const FaceArc& arc : graph.arcs) {
    const bool within = person.partOf[arc.a] == person.partOf[arc.b];
    const auto normal = [&](Index t) {
      const Triangle& v = person.mesh.triangles[t];
      return Vec3((person.mesh.position(v[1]) - person.mesh.position(v[0]))
                      .cross(person.mesh.position(v[2]) - person.mesh.position(v[0]))
                      .normalized());
    };
    const bool bent = normal(arc.a).dot(normal(arc.b)) < 0.5;
    if (!within && bent) concave = std::min(concave, arc.distance);
    if (within && bent) convex = std::max(convex, arc.distance);
    if (!bent) flat = std::max(flat, arc.distance);
    if (!bent && within) cheapest = std::min(cheapest, arc.capacity);
    if (!within && bent) {
      EXPECT_LT(arc.capacity, 0.5 * arc.length / 0.1);
    }
  }
  EXPECT_GT(concave, 3 * convex);
  EXPECT_GT(convex, flat);
}

TEST(FaceGraph, FacesThatAreTurnedOverChangeNothing) {
  testing::BlockPerson person = testing::blockPerson();
  const FaceGraph before = faceGraph(person.mesh);
  for (std::size_t t = 0; t < person.mesh.triangles.size(); t += 3) {
    std::swap(person.mesh.triangles[t][0], person.mesh.triangles[t][1]);
  }
  const FaceGraph after = faceGraph(person.mesh);
  ASSERT_EQ(before.arcs.size(), after.arcs.size());
  for (std::size_t a = 0; a < before.arcs.size(); ++a) {
    EXPECT_NEAR(before.arcs[a].distance, after.arcs[a].distance, 1e-6);
    EXPECT_NEAR(before.arcs[a].capacity, after.arcs[a].capacity, 1e-6);
  }
}

TEST(FaceGraph, WaysOverAnEdgeAreStraightOnceUnfolded) {
  // Flat and bent alike, the centroids of a strip's first and second triangle are as far along the surface.
  for (const double bend : {0.0, 30.0, 90.0}) {
    const TriMesh mesh = bentStrip(bend, 0);
    const FaceGraph graph = faceGraph(mesh);
    std::vector<double> distances;
    for (const FaceArc& arc : graph.arcs) {
      if (arc.length > 1.2) distances.push_back(arc.distance);  // the diagonals, which are flat
    }
    ASSERT_EQ(distances.size(), 3u);
    EXPECT_NEAR(distances[0], distances[1], 1e-6);
    EXPECT_NEAR(distances[1], distances[2], 1e-6);
  }
}

}  // namespace
}  // namespace limber
