#include "limber/actions/parts/part_caps.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

PartCaps cap(const TriMesh& mesh, std::span<const Index> partOf, Index partCount) {
  Progress progress;
  return capParts(mesh, partOf, partCount, progress);
}

// A part with its caps as one mesh; middles of fans are new vertices.
TriMesh cappedPart(const TriMesh& mesh, std::span<const Index> partOf, Index part, const PartCaps& caps) {
  TriMesh result;
  result.positions = mesh.positions;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    if (partOf[t] == part) result.triangles.push_back(mesh.triangles[t]);
  }
  for (const PartCap& cap : caps.capsOf[part]) {
    Vec3f middle = Vec3f::Zero();
    for (const Index v : cap.loop) middle += mesh.positions[v] / static_cast<float>(cap.loop.size());
    const Index added = result.vertexCount();
    if (cap.hasMiddle) result.positions.push_back(middle);
    for (const Triangle& t : cap.triangles) {
      Triangle made;
      for (std::size_t c = 0; c < 3; ++c) made[c] = t[c] < cap.loop.size() ? cap.loop[t[c]] : added;
      result.triangles.push_back(made);
    }
  }
  return result;
}

// Counts of edges by how many triangles they have, and whether as many run in one direction as in the other.
struct Closedness {
  std::size_t unbalanced = 0, crowded = 0;
};

Closedness closedness(const TriMesh& mesh) {
  std::map<std::pair<Index, Index>, std::pair<int, int>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = t[c], b = t[(c + 1) % 3];
      auto& [sum, count] = edges[std::minmax(a, b)];
      sum += a < b ? 1 : -1;
      ++count;
    }
  }
  Closedness result;
  for (const auto& [edge, at] : edges) {
    result.unbalanced += at.first != 0;
    result.crowded += at.second > 2;
  }
  return result;
}

double volume(const TriMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    sum += mesh.position(t[0]).dot(mesh.position(t[1]).cross(mesh.position(t[2]))) / 6;
  }
  return sum;
}

TEST(PartCaps, ATubeCutAcrossHasTwoFlatCaps) {
  const TriMesh mesh = testing::revolved(4, 5, 12, [](double) { return 1.0; });
  std::vector<Index> partOf;
  for (Index t = 0; t < mesh.triangleCount(); ++t) partOf.push_back(testing::middleX(mesh, t) < 2 ? 0 : 1);
  const PartCaps caps = cap(mesh, partOf, 2);
  EXPECT_EQ(caps.openEdges, 0u);
  double volumes = 0;
  for (const Index part : {0u, 1u}) {
    ASSERT_EQ(caps.capsOf[part].size(), 1u);
    const PartCap& cap = caps.capsOf[part][0];
    EXPECT_EQ(cap.loop.size(), 12u);
    EXPECT_EQ(cap.triangles.size(), 10u);
    EXPECT_FALSE(cap.hasMiddle);
    EXPECT_NEAR(cap.normal.x(), part == 0 ? 1 : -1, 1e-6);
    const TriMesh whole = cappedPart(mesh, partOf, part, caps);
    EXPECT_EQ(closedness(whole).unbalanced, 0u);
    EXPECT_EQ(closedness(whole).crowded, 0u);
    EXPECT_NEAR(volume(whole), volume(mesh) / 2, 1e-5);
    volumes += volume(whole);
  }
  EXPECT_NEAR(volumes, volume(mesh), 1e-5);
}

TEST(PartCaps, PartsOfClosedSurfacesAreClosedHoweverTheyAreCut) {
  Random random(5);
  const std::vector<TriMesh> meshes = {testing::icosphere(2), testing::tube(12, 15, true), testing::blockPerson().mesh,
                                       testing::dumbbell(15, 9)};
  for (const TriMesh& mesh : meshes) {
    for (int trial = 0; trial < 6; ++trial) {
      // Regions round random triangles; one trial gives each triangle any part at all.
      std::vector<Vec3> centers;
      for (int p = 0; p < 4; ++p) {
        centers.push_back(mesh.position(mesh.triangles[random.below(mesh.triangles.size())][0]));
      }
      std::vector<Index> partOf;
      for (const Triangle& t : mesh.triangles) {
        Index nearest = 0;
        for (Index p = 1; p < 4; ++p) {
          const Vec3 at = mesh.position(t[0]);
          if ((at - centers[p]).norm() < (at - centers[nearest]).norm()) nearest = p;
        }
        partOf.push_back(trial == 0 ? static_cast<Index>(random.below(4)) : nearest);
      }
      const PartCaps caps = cap(mesh, partOf, 4);
      EXPECT_EQ(caps.openEdges, 0u);
      for (Index part = 0; part < 4; ++part) {
        const TriMesh whole = cappedPart(mesh, partOf, part, caps);
        EXPECT_EQ(closedness(whole).unbalanced, 0u) << trial << " " << part;
        if (trial > 0) {
          EXPECT_EQ(closedness(whole).crowded, 0u) << trial << " " << part;
        }
      }
    }
  }
}

TEST(PartCaps, LoopsThatAreNotConvexAreFilledWithinTheirOutline) {
  // The U-shaped section of a channel: a prism over it, cut in the middle.
  const std::vector<Eigen::Vector2f> outline = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  TriMesh mesh;
  const auto count = static_cast<Index>(outline.size());
  for (const float x : {0.0f, 1.0f, 2.0f}) {
    for (const Eigen::Vector2f& p : outline) mesh.positions.push_back({x, p.x(), p.y()});
  }
  std::vector<Index> partOf;
  for (Index ring = 0; ring < 2; ++ring) {
    for (Index i = 0; i < count; ++i) {
      const Index a = ring * count + i, b = ring * count + (i + 1) % count;
      mesh.triangles.push_back({a, b, a + count});
      mesh.triangles.push_back({b, b + count, a + count});
      partOf.insert(partOf.end(), 2, ring);
    }
  }
  const PartCaps caps = cap(mesh, partOf, 2);
  ASSERT_EQ(caps.capsOf[0].size(), 1u);
  EXPECT_FALSE(caps.capsOf[0][0].hasMiddle);
  double area = 0;
  for (const Triangle& t : caps.capsOf[0][0].triangles) {
    const auto at = [&](Index i) { return mesh.position(caps.capsOf[0][0].loop[i]); };
    const double part = 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).dot(caps.capsOf[0][0].normal);
    EXPECT_GE(part, 0);
    area += part;
  }
  EXPECT_NEAR(area, 7, 1e-6);
}

TEST(PartCaps, JaggedLoopsOfThousandsOfEdgesAreFilledWithoutAMiddle) {
  // A prism over a star with teeth of random depth.
  constexpr Index kCount = 3000;
  Random random(11);
  std::vector<double> radii;
  for (Index i = 0; i < kCount; ++i) radii.push_back(i % 2 == 0 ? 1 : random.uniform(0.7, 0.95));
  TriMesh mesh;
  for (const float x : {0.0f, 1.0f, 2.0f}) {
    for (Index i = 0; i < kCount; ++i) {
      const double angle = 2 * kPi * i / kCount;
      mesh.positions.push_back(
          {x, static_cast<float>(radii[i] * std::cos(angle)), static_cast<float>(radii[i] * std::sin(angle))});
    }
  }
  std::vector<Index> partOf;
  for (Index ring = 0; ring < 2; ++ring) {
    for (Index i = 0; i < kCount; ++i) {
      const Index a = ring * kCount + i, b = ring * kCount + (i + 1) % kCount;
      mesh.triangles.push_back({a, b, a + kCount});
      mesh.triangles.push_back({b, b + kCount, a + kCount});
      partOf.insert(partOf.end(), 2, ring);
    }
  }
  const PartCaps caps = cap(mesh, partOf, 2);
  for (const Index part : {0u, 1u}) {
    ASSERT_EQ(caps.capsOf[part].size(), 1u);
    const PartCap& found = caps.capsOf[part][0];
    EXPECT_FALSE(found.hasMiddle);
    double outline = 0, filled = 0;
    const auto at = [&](Index i) { return mesh.position(found.loop[i % kCount]); };
    for (Index i = 0; i < kCount; ++i) outline += 0.5 * at(i).cross(at(i + 1)).dot(found.normal);
    for (const Triangle& t : found.triangles) {
      const double area = 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).dot(found.normal);
      EXPECT_GE(area, 0);
      filled += area;
    }
    EXPECT_NEAR(filled, outline, 1e-6);
  }
}

TEST(PartCaps, StopWhenCancelled) {
  const TriMesh mesh = testing::icosphere(1);
  std::vector<Index> partOf;
  for (Index t = 0; t < mesh.triangleCount(); ++t) partOf.push_back(testing::middleX(mesh, t) < 0 ? 0 : 1);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(capParts(mesh, partOf, 2, progress), Error);
}

TEST(PartCaps, CutsThatEndAtAnOpenEdgeAreCountedAndLeftOpen) {
  const TriMesh mesh = testing::flatGrid(4, 3);
  std::vector<Index> partOf;
  for (Index t = 0; t < mesh.triangleCount(); ++t) partOf.push_back(testing::middleX(mesh, t) < 0.5 ? 0 : 1);
  const PartCaps caps = cap(mesh, partOf, 2);
  EXPECT_TRUE(caps.capsOf[0].empty());
  EXPECT_EQ(caps.openEdges, 6u);  // three of each part
}

class PartCapsOf : public ::testing::TestWithParam<testing::NamedMesh> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, PartCapsOf, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST_P(PartCapsOf, CapsAreWholeLoopsOnAnySurface) {
  TriMesh mesh = GetParam().mesh;
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  std::vector<Index> partOf;
  for (Index t = 0; t < mesh.triangleCount(); ++t) partOf.push_back(t % 3);
  const PartCaps caps = cap(mesh, partOf, 3);
  for (const std::vector<PartCap>& list : caps.capsOf) {
    for (const PartCap& cap : list) {
      ASSERT_GE(cap.loop.size(), 3u);
      EXPECT_EQ(cap.triangles.size(), cap.hasMiddle ? cap.loop.size() : cap.loop.size() - 2);
      EXPECT_TRUE(cap.normal.allFinite());
    }
  }
}

}  // namespace
}  // namespace limber
