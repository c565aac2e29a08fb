// Every side in the group of its edge, against an ordered map.
#include "limber/geometry/mesh/edge_groups.h"

#include <map>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

class EdgeGroupsCatalogue : public ::testing::TestWithParam<testing::NamedMesh> {};

TEST_P(EdgeGroupsCatalogue, SameGroupsAsAMap) {
  const TriMesh& mesh = GetParam().mesh;
  std::map<std::pair<Index, Index>, std::vector<Index>> expected;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    for (Index k = 0; k < 3; ++k) {
      expected[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(3 * t + k);
    }
  }
  auto next = expected.begin();
  const EdgeGroups edges(mesh.triangles, mesh.vertexCount());
  edges.forEachEdge([&](std::span<const Index> sides) {
    ASSERT_NE(next, expected.end());
    EXPECT_EQ(std::vector<Index>(sides.begin(), sides.end()), next->second);
    EXPECT_EQ(edges.low(sides[0]), next->first.first);
    EXPECT_EQ(edges.high(sides[0]), next->first.second);
    ++next;
  });
  EXPECT_EQ(next, expected.end());
}

INSTANTIATE_TEST_SUITE_P(, EdgeGroupsCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST(EdgeGroups, AFanOfThousands) {
  TriMesh fan;
  fan.positions.resize(3002, Vec3f::Zero());
  for (Index i = 3000; i > 0; --i) fan.triangles.push_back({i + 1, 0, i});  // unsorted round vertex 0
  Index edges = 0;
  EdgeGroups(fan.triangles, fan.vertexCount()).forEachEdge([&](std::span<const Index> sides) {
    ++edges;
    EXPECT_LE(sides.size(), 2u);
  });
  EXPECT_EQ(edges, 6001u);
}

}  // namespace
}  // namespace limber
