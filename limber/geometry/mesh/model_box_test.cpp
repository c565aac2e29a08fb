#include "limber/geometry/mesh/model_box.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// Its corners are position + 0, side * x and side * y.
void addTriangle(TriMesh& mesh, const Vec3f& position, float side = 1) {
  const Index first = mesh.vertexCount();
  for (const Vec3f& corner : {Vec3f(0, 0, 0), Vec3f(side, 0, 0), Vec3f(0, side, 0)}) {
    mesh.positions.push_back(position + corner);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

TriMesh rowOfTriangles() {
  TriMesh mesh;
  for (const float x : {0.f, 1.f, 2.f, 3.f}) addTriangle(mesh, {x, 0, 0});
  return mesh;
}

TEST(ModelBox, FarBitsAndLooseVerticesDoNotCount) {
  const Box plain = modelBox(rowOfTriangles());
  EXPECT_EQ(plain.min, Vec3(0, 0, 0));
  EXPECT_EQ(plain.max, Vec3(4, 1, 0));
  for (const float far : {14.f, 100.f, 1e10f}) {
    TriMesh mesh = rowOfTriangles();
    addTriangle(mesh, {0, far, 0}, 0.1f);
    mesh.positions.push_back({-far, 0, far});
    const Box box = modelBox(mesh);
    EXPECT_EQ(box.min, plain.min) << far;
    EXPECT_EQ(box.max, plain.max) << far;
  }
}

TEST(ModelBox, NearBitsAndLargePiecesCount) {
  TriMesh mesh = rowOfTriangles();
  addTriangle(mesh, {0, 4, 0}, 0.25f);
  EXPECT_EQ(modelBox(mesh).max, Vec3(4, 4.25, 0));
  mesh = rowOfTriangles();
  addTriangle(mesh, {0, 100, 0});
  EXPECT_EQ(modelBox(mesh).max, Vec3(4, 101, 0));
}

TEST(ModelBox, OfPointsAloneAndOfNoAreaItIsThatOfAll) {
  const TriMesh points{{{0, 0, 0}, {1, 2, 3}}, {}};
  EXPECT_EQ(modelBox(points).max, Vec3(1, 2, 3));
  EXPECT_TRUE(modelBox({}).empty());
  TriMesh mesh;
  addTriangle(mesh, {0, 0, 0}, 0);
  addTriangle(mesh, {9, 0, 0}, 0);
  EXPECT_EQ(modelBox(mesh).max, Vec3(9, 0, 0));
}

}  // namespace
}  // namespace limber
