#include "limber/rigging/body/plinth.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

void addBox(TriMesh& mesh, const Vec3& low, const Vec3& high) {
  const Index first = mesh.vertexCount();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 position(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                        corner & 4 ? high.z() : low.z());
    mesh.positions.push_back(position.cast<float>());
  }
  constexpr Index kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& side : kSides) {
    mesh.triangles.push_back({first + side[0], first + side[1], first + side[2]});
    mesh.triangles.push_back({first + side[0], first + side[2], first + side[3]});
  }
}

// Of a slab with a post on it, both square.
std::optional<double> topOf(double slabHalf, double postHalf) {
  TriMesh mesh;
  addBox(mesh, {-slabHalf, 0, -slabHalf}, {slabHalf, 0.15, slabHalf});
  addBox(mesh, {-postHalf, 0.1, -postHalf}, {postHalf, 1, postHalf});
  return plinthTop(measureBody(mesh), Vec3::UnitY());
}

}  // namespace

TEST(Plinth, EndsWhereTheBodyOnItBegins) {
  const std::optional<double> top = topOf(0.3, 0.1);
  ASSERT_TRUE(top);
  EXPECT_NEAR(*top, 0.15, 0.015);
}

TEST(Plinth, IsNoneWhereTheBodyIsAsWide) {
  EXPECT_FALSE(topOf(0.3, 0.28));
  EXPECT_FALSE(topOf(0.1, 0.3)) << "far less wide than what stands on it";
}

TEST(Plinth, IsNoPairOfFeet) {
  EXPECT_FALSE(plinthTop(testing::measuredPerson().body, Vec3::UnitY()));
}

}  // namespace limber
