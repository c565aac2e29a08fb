#include "limber/geometry/mesh/face_orientation.h"

#include <utility>

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/geometry/mesh/enclosed_volume.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

// So thin that its centroid hardly tells inside from outside.
TriMesh thinTube() {
  return testing::moved(testing::tube(12, 40, true), Vec3f(4, 0.4f, 0.4f), Vec3f(1, 2, 3));
}

void reverseFraction(TriMesh& mesh, double fraction, std::uint64_t seed = 1) {
  Random random(seed);
  for (Triangle& t : mesh.triangles) {
    if (random.uniform(0, 1) < fraction) std::swap(t[0], t[2]);
  }
}

// Of the cones from the middle of the tube, whose ends need not be closed.
double volumeOf(const TriMesh& mesh) {
  TriMesh centred = mesh;
  for (Vec3f& p : centred.positions) p -= Vec3f(1, 2, 3);
  return enclosedVolume(centred.positions, centred.triangles);
}

TEST(MendFaces, AnyShareOfReversedFacesIsMended) {
  const TriMesh clean = thinTube();
  for (const double fraction : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    TriMesh mesh = clean;
    reverseFraction(mesh, fraction);
    TriMesh beside = mesh;  // a bit far away, as broken vertices make
    const auto first = beside.vertexCount();
    for (const Vec3f& p : {Vec3f(4e5f, 0, 0), Vec3f(4e5f, 0.1f, 0), Vec3f(4e5f, 0, 0.1f)})
      beside.positions.push_back(p);
    beside.triangles.push_back({first, first + 1, first + 2});
    mendFaces(mesh);
    EXPECT_NEAR(volumeOf(mesh), volumeOf(clean), 1e-6) << fraction;
    mendFaces(beside);
    beside.triangles.pop_back();
    EXPECT_EQ(beside.triangles, mesh.triangles);
  }
}

TEST(MendFaces, HalfOfABodyIsMended) {
  const TriMesh clean = thinTube();
  TriMesh mesh = clean;
  for (Triangle& t : mesh.triangles) {
    if (mesh.positions[t[0]].x() > 0.7f) std::swap(t[0], t[2]);
  }
  const MendedFaces mended = mendFaces(mesh);
  EXPECT_GT(mended.reversed, 0u);
  EXPECT_EQ(mended.repeated, 0u);
  EXPECT_NEAR(volumeOf(mesh), volumeOf(clean), 1e-6);
}

TEST(MendFaces, RaysTellTheOutsideOfOpenPatches) {
  TriMesh clean = testing::moved(testing::tube(12, 40, false), Vec3f(4, 0.4f, 0.4f), Vec3f(1, 2, 3));
  for (const double fraction : {0.3, 0.8}) {
    TriMesh mesh = clean;
    reverseFraction(mesh, fraction);
    mendFaces(mesh);
    EXPECT_NEAR(volumeOf(mesh), volumeOf(clean), 1e-6) << fraction;
  }
}

TEST(MendFaces, FacesThatAreThereTwiceCountOnce) {
  const TriMesh clean = testing::icosphere(2);
  for (const bool isReversed : {false, true}) {
    TriMesh mesh = clean;
    for (Triangle t : clean.triangles) {
      if (isReversed) std::swap(t[1], t[2]);
      mesh.triangles.push_back({t[1], t[2], t[0]});
    }
    const MendedFaces mended = mendFaces(mesh);
    EXPECT_EQ(mended.repeated, clean.triangleCount());
    EXPECT_EQ(mended.reversed, 0u);
    EXPECT_EQ(mesh.triangles, clean.triangles);
  }
}

TEST(MendFaces, PartlyDoubledAndReversedFacesAreMended) {
  TriMesh clean = thinTube(), mesh = clean;
  for (std::size_t t = 0; t < clean.triangles.size(); t += 3) {
    Triangle twin = clean.triangles[t];
    std::swap(twin[0], twin[1]);
    mesh.triangles.push_back(twin);
  }
  reverseFraction(mesh, 0.6);
  mendFaces(mesh);
  EXPECT_EQ(mesh.triangleCount(), clean.triangleCount());
  EXPECT_NEAR(volumeOf(mesh), volumeOf(clean), 1e-6);
}

class MendFacesCatalogue : public ::testing::TestWithParam<testing::NamedMesh> {};

TEST_P(MendFacesCatalogue, AreMendedOnce) {
  TriMesh mesh = GetParam().mesh;
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  mendFaces(mesh);
  TriMesh again = mesh;
  EXPECT_EQ(mendFaces(again).repeated, 0u);
  EXPECT_EQ(again.triangleCount(), mesh.triangleCount());
}

INSTANTIATE_TEST_SUITE_P(, MendFacesCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST(MendFaces, AgreeingMeshesKeepTheirBytes) {
  for (const bool insideOut : {false, true}) {
    TriMesh mesh = testing::join(testing::icosphere(1), testing::flatGrid(3, 3));
    if (insideOut) reverseFraction(mesh, 1);
    const std::vector<Triangle> before = mesh.triangles;
    const MendedFaces mended = mendFaces(mesh);
    EXPECT_EQ(mended.repeated + mended.reversed, 0u);
    EXPECT_EQ(mesh.triangles, before);
  }
}

}  // namespace
}  // namespace limber
