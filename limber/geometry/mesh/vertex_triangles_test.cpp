#include "limber/geometry/mesh/vertex_triangles.h"

#include <gmock/gmock.h>

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(VertexTriangles, TwoThatShareAnEdge) {
  const std::vector<Triangle> triangles = {{4, 1, 2}, {2, 1, 0}};
  const Grouped<Index> at = trianglesAtVertices(triangles, 5);
  EXPECT_THAT(at.of(0), ElementsAre(1));
  EXPECT_THAT(at.of(1), ElementsAre(0, 1));
  EXPECT_THAT(at.of(3), IsEmpty());
  EXPECT_THAT(neighboursOf(1, triangles, at), ElementsAre(0, 2, 4));
  EXPECT_THAT(neighboursOf(4, triangles, at), ElementsAre(1, 2));
  EXPECT_THAT(neighboursOf(3, triangles, at), IsEmpty());
}

}  // namespace
}  // namespace limber
