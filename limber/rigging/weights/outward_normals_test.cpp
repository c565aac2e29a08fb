#include "limber/rigging/weights/outward_normals.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

void flip(Triangle& t) {
  std::swap(t[0], t[2]);
}

void expectRadial(const TriMesh& sphere, double least) {
  const std::vector<Vec3> normals = outwardNormals(sphere);
  for (Index v = 0; v < sphere.vertexCount(); ++v) EXPECT_GT(normals[v].dot(sphere.position(v).normalized()), least);
}

TEST(OutwardNormals, OfASphereAreItsRadii) {
  expectRadial(testing::icosphere(2), 0.999);
}

TEST(OutwardNormals, SingleFlippedFacesAreOutvoted) {
  TriMesh sphere = testing::icosphere(2);
  for (std::size_t t = 0; t < sphere.triangles.size(); t += 3) flip(sphere.triangles[t]);
  expectRadial(sphere, 0.999);
}

TEST(OutwardNormals, ModelStoredInsideOutFacesOut) {
  TriMesh sphere = testing::icosphere(2);
  for (Triangle& t : sphere.triangles) flip(t);
  expectRadial(sphere, 0.999);
}

TEST(OutwardNormals, OpenBowlStoredInsideOutFacesOut) {
  TriMesh bowl = testing::icosphere(2);
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.positions[t[0]].y() > 0.5f || bowl.positions[t[1]].y() > 0.5f || bowl.positions[t[2]].y() > 0.5f;
  });
  TriMesh inside = bowl;
  for (Triangle& t : inside.triangles) flip(t);
  const std::vector<Vec3> expected = outwardNormals(bowl), turned = outwardNormals(inside);
  for (Index v = 0; v < bowl.vertexCount(); ++v) EXPECT_LT((expected[v] - turned[v]).norm(), 1e-12);
}

TEST(OutwardNormals, FlatSheetFacesTheWayItIsStored) {
  TriMesh sheet = testing::flatGrid(6, 6);
  const double stored = outwardNormals(sheet)[20].z();
  EXPECT_NEAR(std::abs(stored), 1, 1e-12);
  flip(sheet.triangles[7]);
  EXPECT_NEAR(outwardNormals(sheet)[20].z(), stored, 1e-12);
  for (Triangle& t : sheet.triangles) flip(t);
  EXPECT_NEAR(outwardNormals(sheet)[20].z(), -stored, 1e-12);
}

TEST(OutwardNormals, AreWeightedByAngleNotByHowACornerIsCut) {
  // A corner of a cube, one of its three squares cut in two there.
  TriMesh corner;
  corner.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  corner.triangles = {{0, 2, 4}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}};
  const Vec3 normal = outwardNormals(corner)[0];
  EXPECT_LT((normal - Vec3(-1, -1, -1).normalized()).norm(), 1e-7);
}

TEST(OutwardNormals, VertexWithoutATriangleHasNone) {
  TriMesh mesh = testing::icosphere(0);
  mesh.positions.emplace_back(3, 0, 0);
  mesh.triangles.push_back({0, 0, 1});
  const std::vector<Vec3> normals = outwardNormals(mesh);
  EXPECT_EQ(normals.back(), Vec3(Vec3::Zero()));
  EXPECT_TRUE(normals[0].allFinite());
}

class OutwardNormalsCatalogue : public ::testing::TestWithParam<testing::NamedMesh> {};

TEST_P(OutwardNormalsCatalogue, AreUnitOrZero) {
  for (const Vec3& normal : outwardNormals(GetParam().mesh)) {
    EXPECT_NEAR(normal.norm(), normal.isZero(0) ? 0 : 1, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(, OutwardNormalsCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

}  // namespace
}  // namespace limber
