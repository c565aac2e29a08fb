#include "limber/rigging/sphere_mesh/sphere_mesh.h"

#include <array>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/surface/border_lengths.h"
#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/testing/sphere_mesh_of.h"

namespace limber {

namespace {

using testing::sphereMeshOf;

void expectConnected(const SphereMeshLevel& level) {
  std::vector<std::vector<Index>> neighbors(level.spheres.size());
  for (const auto& [a, b] : level.edges) {
    ASSERT_LT(a, b);
    ASSERT_LT(b, level.spheres.size());
    neighbors[a].push_back(b);
    neighbors[b].push_back(a);
  }
  std::set<Index> seen = {0};
  std::vector<Index> stack = {0};
  while (!stack.empty()) {
    const Index h = stack.back();
    stack.pop_back();
    for (const Index next : neighbors[h]) {
      if (seen.insert(next).second) stack.push_back(next);
    }
  }
  EXPECT_EQ(seen.size(), level.spheres.size());
}

void expectSound(const TriMesh& mesh, const SphereMesh& spheres, Index count) {
  const SphereMeshLevel level = spheres.level(count);
  ASSERT_EQ(level.spheres.size(), count);
  ASSERT_EQ(level.weights.size(), count);
  Box box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
  double weight = 0;
  for (std::size_t h = 0; h < count; ++h) {
    const Sphere& sphere = level.spheres[h];
    EXPECT_TRUE(sphere.center.allFinite());
    EXPECT_GE(sphere.radius, 0);
    EXPECT_LE(sphere.radius, box.diagonal());
    EXPECT_LE((sphere.center - box.center()).norm(), 1.5 * box.diagonal());
    weight += level.weights[h];
  }
  EXPECT_NEAR(weight, 1, 1e-5);
  expectConnected(level);
  const std::vector<Index> handles = spheres.vertexHandles(count);
  ASSERT_EQ(handles.size(), mesh.positions.size());
  const std::set<Index> used(handles.begin(), handles.end());
  EXPECT_EQ(used.size(), count);
  EXPECT_LT(*used.rbegin(), count);
}

// Exactly: to the last bit of a coordinate for planes x = 0 or z = 0.
void expectMirrored(const SphereMesh& spheres, Index count) {
  ASSERT_TRUE(spheres.mirror());
  const MirrorPlane plane = *spheres.mirror();
  const SphereMeshLevel level = spheres.level(count);
  ASSERT_EQ(level.images.size(), count);
  for (Index h = 0; h < count; ++h) {
    const Index image = level.images[h];
    ASSERT_LT(image, count);
    EXPECT_EQ(level.images[image], h);
    const Vec3 c = level.spheres[h].center;
    const Vec3 reflected = c - 2 * (plane.normal.dot(c) - plane.offset) * plane.normal;
    EXPECT_EQ((reflected - level.spheres[image].center).norm(), 0) << "handle " << h << " of " << count;
    EXPECT_EQ(level.spheres[h].radius, level.spheres[image].radius);
    EXPECT_TRUE(image <= h || plane.normal.dot(c) >= plane.offset);
  }
  std::set<VertexPair> edges(level.edges.begin(), level.edges.end());
  for (const auto& [a, b] : level.edges) {
    const Index x = level.images[a], y = level.images[b];
    EXPECT_TRUE(edges.count({std::min(x, y), std::max(x, y)}));
  }
}

TEST(SphereMesh, ExactlyAsManySpheresAsAskedForOnEveryKindOfMesh) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    const SphereMesh spheres = sphereMeshOf(mesh);
    ASSERT_EQ(spheres.maxSpheres(), mesh.vertexCount());
    const Index step = std::max<Index>(1, mesh.vertexCount() / 120);
    for (Index count = 1; count <= mesh.vertexCount(); count += count < 60 ? 1 : step)
      expectSound(mesh, spheres, count);
    expectSound(mesh, spheres, mesh.vertexCount());
  }
}

TEST(SphereMesh, SymmetricModelsHaveMirroredSpheresAtEveryCount) {
  for (const TriMesh& mesh : {testing::shuffled(testing::blockBiped(1)), testing::ball(2)}) {
    const SphereMesh spheres = sphereMeshOf(mesh);
    for (Index count = 1; count <= std::min<Index>(mesh.vertexCount(), 210); ++count) expectMirrored(spheres, count);
    expectMirrored(spheres, mesh.vertexCount());
  }
}

TEST(SphereMesh, TwoSidesThatTouchNowhereAreMirroredAtEveryCount) {
  const TriMesh half = testing::jittered(testing::ball(2), 0.1f);
  TriMesh image = half;
  for (Vec3f& p : image.positions) p.x() = -p.x() - 6;
  for (Triangle& t : image.triangles) std::swap(t[1], t[2]);
  TriMesh both = testing::joined(half, image);
  for (Vec3f& p : both.positions) p.x() += 3;
  const SphereMesh spheres = sphereMeshOf(both);
  for (Index count = 1; count <= both.vertexCount(); ++count) expectMirrored(spheres, count);
}

TEST(SphereMesh, NearVerticesOfALargeModelAreOneFromTheStart) {
  TriMesh cross = testing::cubes({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 2, 0}});
  for (int i = 0; i < 4; ++i) cross = testing::subdivided(cross);
  Progress progress;
  const SphereMesh whole = SphereMesh::build(cross, progress), joined = SphereMesh::build(cross, progress, 1000);
  EXPECT_EQ(whole.maxSpheres(), cross.vertexCount());
  EXPECT_LE(joined.maxSpheres(), 2000u);  // in pairs
  EXPECT_GT(joined.maxSpheres(), 500u);
  for (const Index count : {1u, 2u, 17u, 100u, joined.maxSpheres()}) {
    expectSound(cross, joined, count);
    expectMirrored(joined, count);
  }
}

TEST(SphereMesh, JoiningNearVerticesCostsLittle) {
  TriMesh hills = testing::ball(6);
  for (Vec3f& p : hills.positions) {
    p *= 1 + 0.3f * std::sin(3 * p.x() + 1) * std::sin(4 * p.y()) + 0.2f * std::sin(5 * p.z() + p.x());
    p.z() *= 0.5f;
  }
  Progress progress;
  const SphereMesh whole = SphereMesh::build(hills, progress), joined = SphereMesh::build(hills, progress, 4000);
  EXPECT_LE(joined.maxSpheres(), 4000u);
  const std::vector<double> expected = whole.errors(50), errors = joined.errors(50);
  double sum = 0, expectedSum = 0;
  for (Index count = 1; count <= 50; ++count) {
    EXPECT_LT(errors[count], 1.5 * expected[count]) << count;  // the cheapest merge is another now and then
    sum += errors[count];
    expectedSum += expected[count];
  }
  EXPECT_LT(sum, 1.1 * expectedSum);
}

TEST(SphereMesh, HoldingTogetherByOneVertexIsMirroredAtEveryCount) {
  // Two fans that share a vertex on the plane: no edge lies in the plane or crosses it.
  TriMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (const float side : {1.0f, -1.0f}) {
    const Index first = mesh.vertexCount();
    for (int i = 0; i < 9; ++i) mesh.positions.push_back({side * (1 + 0.1f * i * i), 0.3f * i, 0.05f * i * (i - 4)});
    for (Index i = 0; i < 8; ++i) mesh.triangles.push_back({0, first + i, first + i + 1});
  }
  const SphereMesh spheres = sphereMeshOf(mesh);
  for (Index count = 1; count <= mesh.vertexCount(); ++count) {
    expectMirrored(spheres, count);
    expectConnected(spheres.level(count));
  }
}

TEST(SphereMesh, AFewVerticesWithoutAnImageDoNotBreakSymmetry) {
  TriMesh mesh = testing::blockBiped(2);
  for (int i = 0; i < 3; ++i) mesh.positions[static_cast<std::size_t>(40 * i + 7)] += Vec3f(0.1f, 0.2f, 0.05f);
  const SphereMesh spheres = sphereMeshOf(mesh);
  ASSERT_TRUE(spheres.mirror());
  const Index matched = spheres.sequence().initialCount;
  ASSERT_LT(matched, mesh.vertexCount());
  for (const Index count : {1u, 2u, 7u, 20u, 21u, 100u, matched}) expectMirrored(spheres, count);
  for (Index count = matched - 1; count <= mesh.vertexCount(); ++count) expectSound(mesh, spheres, count);
}

TEST(SphereMesh, AllVerticesAreTheirOwnSpheresAtTheFullCount) {
  const TriMesh mesh = testing::shuffled(testing::blockBiped());
  const SphereMesh spheres = sphereMeshOf(mesh);
  const SphereMeshLevel level = spheres.level(mesh.vertexCount());
  const std::vector<Index> handles = spheres.vertexHandles(mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((level.spheres[handles[v]].center - mesh.position(v)).norm(), 1e-5);
    EXPECT_EQ(level.spheres[handles[v]].radius, 0);
  }
}

TEST(SphereMesh, ABallIsOneSphere) {
  TriMesh mesh = testing::ball(3);
  for (Vec3f& p : mesh.positions) p = 2 * p + Vec3f(5, 6, 7);
  const SphereMeshLevel level = sphereMeshOf(mesh).level(1);
  EXPECT_LT((level.spheres[0].center - Vec3(5, 6, 7)).norm(), 1e-5);
  EXPECT_NEAR(level.spheres[0].radius, 2, 0.05);
  EXPECT_TRUE(level.edges.empty());
}

TEST(SphereMesh, SpheresLieInTheLimbs) {
  const TriMesh mesh = testing::blockBiped(2);
  const SphereMesh spheres = sphereMeshOf(mesh);
  const SphereMeshLevel level = spheres.level(14);
  std::set<int> limbs;
  for (const Sphere& s : level.spheres) {
    const Vec3 c = s.center;
    EXPECT_LT(std::abs(c.z()), 0.5);
    const bool trunk = std::abs(c.x()) < 2 && c.y() > 4 && c.y() < 8,
               head = std::abs(c.x()) < 1 && c.y() >= 8 && c.y() < 10;
    const bool arm = std::abs(c.x()) >= 2 && std::abs(c.x()) < 6 && c.y() > 7 && c.y() < 8;
    const bool leg = std::abs(c.x()) > 1 && std::abs(c.x()) < 2 && c.y() <= 4 && c.y() > -1;
    EXPECT_TRUE(trunk || head || arm || leg) << c.transpose();
    limbs.insert((trunk ? 0 : head ? 1 : arm ? 2 : 3) * (c.x() < 0 ? -1 : 1));
  }
  for (const int limb : {2, -2, 3, -3}) EXPECT_TRUE(limbs.count(limb)) << limb;
}

// A body on the plane of symmetry, and three pairs of legs that go out and then up.
TriMesh blockSpider() {
  std::set<std::array<int, 3>> cells;
  for (int x = -1; x <= 1; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int z = 0; z < 5; ++z) cells.insert({x, y, z});
    }
  }
  for (const int side : {-1, 1}) {
    for (const int z : {0, 2, 4}) {
      for (int x = 2; x < 5; ++x) cells.insert({side * x, 1, z});
      for (int y = 2; y < 8; ++y) cells.insert({side * 4, y, z});
    }
  }
  return testing::subdivided(testing::cubes(cells));
}

// Where two legs go at once, the count between keeps the others apart: no sphere is in the air between two legs.
TEST(SphereMesh, CountsBetweenPairsLeaveLegsApart) {
  const TriMesh mesh = blockSpider();
  const SphereMesh spheres = sphereMeshOf(mesh);
  ASSERT_TRUE(spheres.mirror());
  Index between = 0;
  for (Index count = 3; count <= 24; ++count) {
    SCOPED_TRACE(count);
    expectSound(mesh, spheres, count);
    const SphereMeshLevel level = spheres.level(count);
    for (Index h = 0; h < count; ++h) {
      EXPECT_TRUE(level.images[h] != h || level.spheres[h].center.y() < 2);
    }
  }
  for (const Merge& m : spheres.sequence().merges) between += m.countAfter < 24 && m.between != kNoIndex ? 1 : 0;
  EXPECT_GT(between, 3);
}

TEST(SphereMesh, SpecksAboutAModelTakeNoHandles) {
  const TriMesh body = testing::jittered(testing::blockBiped(1), 0.02f);
  Box box;
  for (Index v = 0; v < body.vertexCount(); ++v) box.add(body.position(v));
  TriMesh speck = testing::octahedron();
  for (Vec3f& p : speck.positions) p *= static_cast<float>(0.005 * box.longestSide());
  TriMesh mesh = body;
  for (int i = 0; i < 16; ++i) {
    const Vec3 away(1 + 0.1 * (i % 4), 0, 0.3 * (i % 5) - 0.6);
    mesh = testing::joined(mesh, speck, (box.min + box.longestSide() * away).cast<float>());
  }
  const SphereMesh spheres = sphereMeshOf(mesh);
  for (const Index count : {3u, 6u, 12u, 20u}) {
    const std::vector<Index> handles = spheres.vertexHandles(count);
    const std::set<Index> ofBody(handles.begin(), handles.begin() + body.vertexCount());
    EXPECT_EQ(ofBody.size(), count);
  }
  expectSound(mesh, spheres, mesh.vertexCount());
}

TEST(SphereMesh, FlippedTrianglesMakeNoDifference) {
  TriMesh mesh = testing::blockBiped(1);
  const SphereMeshLevel level = sphereMeshOf(mesh).level(20);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const SphereMeshLevel flipped = sphereMeshOf(mesh).level(20);
  for (std::size_t h = 0; h < 20; ++h) {
    EXPECT_LT((level.spheres[h].center - flipped.spheres[h].center).norm(), 1e-5);
    EXPECT_NEAR(level.spheres[h].radius, flipped.spheres[h].radius, 1e-5);
  }
}

TEST(SphereMesh, ScaleAndPlaceMakeNoDifference) {
  const TriMesh mesh = testing::jittered(testing::ball(2), 0.1f);
  const SphereMeshLevel level = sphereMeshOf(mesh).level(12);
  TriMesh moved = mesh;
  for (Vec3f& p : moved.positions) p = 1024 * p;
  const SphereMeshLevel large = sphereMeshOf(moved).level(12);
  for (std::size_t h = 0; h < 12; ++h) {
    EXPECT_LT((1024 * level.spheres[h].center - large.spheres[h].center).norm(), 1e-3);
  }
}

TEST(SphereMesh, TheNumberOfThreadsMakesNoDifference) {
  const TriMesh mesh = testing::jittered(testing::ball(5), 0.02f);
  setThreadCount(1);
  const SphereMesh one = sphereMeshOf(mesh);
  setThreadCount(4);
  const SphereMesh four = sphereMeshOf(mesh);
  setThreadCount(0);
  ASSERT_EQ(one.sequence().merges.size(), four.sequence().merges.size());
  for (std::size_t i = 0; i < one.sequence().merges.size(); ++i) {
    const Merge &a = one.sequence().merges[i], &b = four.sequence().merges[i];
    ASSERT_TRUE(a.kept == b.kept && a.gone == b.gone && a.center == b.center && a.radius == b.radius);
  }
}

TEST(SphereMesh, EveryVertexBelongsToTheSphereThatItMergedInto) {
  const TriMesh mesh = testing::blockBiped(1);
  const SphereMesh spheres = sphereMeshOf(mesh);
  for (Index count = 2; count < 26; ++count) {
    const SphereMeshLevel level = spheres.level(count);
    const std::vector<Index> handles = spheres.vertexHandles(count);
    std::vector<double> areas(count, 0);
    double total = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.position(t[0]), b = mesh.position(t[1]), c = mesh.position(t[2]);
      const double third = (b - a).cross(c - a).norm() / 6;
      for (const Index v : t) areas[handles[v]] += third;
      total += 3 * third;
    }
    // The areas of a pair are averaged over both sides.
    for (Index h = 0; h < count; ++h) {
      EXPECT_NEAR(level.weights[h], 0.5 * (areas[h] + areas[level.images[h]]) / total, 1e-5) << h << " of " << count;
    }
  }
}

TEST(SphereMesh, ErrorsFallFromOneSphereToNone) {
  const TriMesh mesh = testing::blockBiped(1);
  const SphereMesh spheres = sphereMeshOf(mesh);
  const std::vector<double> errors = spheres.errors(mesh.vertexCount());
  ASSERT_EQ(errors.size(), mesh.vertexCount() + 1);
  EXPECT_EQ(errors.back(), 0);
  for (const double e : std::vector<double>(errors.begin() + 1, errors.end())) EXPECT_TRUE(std::isfinite(e));
  EXPECT_LT(errors[40], errors[5]);
  EXPECT_LT(errors[5], errors[1]);
  // One sphere: the distance of the planes of all triangles from it.
  const Sphere sphere = spheres.level(1).spheres[0];
  double sum = 0, area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.position(t[0]);
    const Vec3 normal = (mesh.position(t[1]) - a).cross(mesh.position(t[2]) - a);
    const double distance = normal.normalized().dot(a - sphere.center) - sphere.radius;
    sum += normal.norm() * distance * distance;
    area += normal.norm();
  }
  EXPECT_NEAR(errors[1], std::sqrt(sum / area), 1e-4 * errors[1]);
}

TEST(SphereMesh, RefusesCountsThatItCannotGive) {
  const SphereMesh spheres = sphereMeshOf(testing::octahedron());
  for (const Index count : {0u, 7u, 1000u}) {
    try {
      spheres.level(count);
      FAIL() << count;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
      EXPECT_NE(std::string(error.what()).find("1 to 6"), std::string::npos);
    }
    EXPECT_THROW(spheres.vertexHandles(count), Error);
  }
  EXPECT_THROW(sphereMeshOf(TriMesh{}), Error);
}

// Between every two handles: the borders of all edges of the mesh between their vertices, however it was collapsed.
TEST(SphereMesh, BordersAreThoseOfTheHandlesVertices) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    const SphereMesh spheres = sphereMeshOf(mesh);
    const std::vector<VertexPair> edges = surfaceEdges(mesh).edges;
    const std::vector<double> lengths = borderLengths(mesh.positions, mesh.triangles, edges);
    for (const Index count : {2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 20u, 41u}) {
      if (count > spheres.sequence().initialCount) break;
      const SphereMeshLevel level = spheres.level(count);
      const std::vector<Index> handles = spheres.vertexHandles(count);
      std::map<VertexPair, double> borders;
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b] = std::minmax(handles[edges[e][0]], handles[edges[e][1]]);
        if (a != b) borders[{a, b}] += lengths[e];
      }
      Box box;
      for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
      const double rounding = 2e-6 * static_cast<double>(edges.size()) * box.longestSide();
      ASSERT_EQ(level.borders.size(), level.edges.size());
      for (std::size_t e = 0; e < level.edges.size(); ++e) {
        const auto [a, b] = level.edges[e];
        double expected = borders[{a, b}];
        if (!level.images.empty()) {  // where an edge of the mesh has no image, half of its border is there
          const auto [x, y] = std::minmax(level.images[a], level.images[b]);
          expected = (expected + borders[{x, y}]) / 2;
        }
        EXPECT_NEAR(level.borders[e], expected, rounding) << count;
      }
    }
  }
}

}  // namespace

}  // namespace limber
