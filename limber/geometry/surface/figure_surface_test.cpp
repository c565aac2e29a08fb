#include "limber/geometry/surface/figure_surface.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/dressed_figure.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

// 12 wide, 11 high from y = -1 on, 2 deep.
TriMesh blockBody() {
  TriMesh mesh = testing::blockBiped(1);
  for (Vec3f& p : mesh.positions) p.z() *= 2;
  return mesh;
}

TriMesh ballMesh(float radius, const Vec3f& center) {
  TriMesh mesh = testing::ball(3);
  for (Vec3f& p : mesh.positions) p = radius * p + center;
  return mesh;
}

TriMesh boxMesh(const Vec3f& size, const Vec3f& center) {
  TriMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f sign(corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f);
    mesh.positions.push_back(center + sign.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriMesh floorMesh(float width) {
  TriMesh mesh;
  const float half = width / 2;
  mesh.positions = {{-half, -1, -half}, {half, -1, -half}, {half, -1, half}, {-half, -1, half}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

FigureSurface surfaceOf(const TriMesh& mesh) {
  return figureSurface(mesh.positions, mesh.triangles);
}

std::size_t countOf(const FigureSurface& surface, std::string_view kind) {
  for (const Warning& warning : surface.prepared.warnings.items()) {
    if (warning.kind == kind) return warning.count;
  }
  return 0;
}

// The figure as if what was added to it were not there.
void expectBodyAlone(const FigureSurface& surface, const TriMesh& body) {
  const FigureSurface alone = surfaceOf(body);
  EXPECT_EQ(surface.prepared.mesh.triangles, alone.prepared.mesh.triangles);
  EXPECT_EQ(surface.prepared.frame.scale, alone.prepared.frame.scale);
  EXPECT_EQ(surface.prepared.frame.offset, alone.prepared.frame.offset);
}

TEST(FigureSurface, CleanModelIsAsPrepared) {
  const TriMesh body = blockBody();
  const FigureSurface surface = surfaceOf(body);
  const PreparedMesh prepared = prepareMesh(body.positions, body.triangles);
  EXPECT_EQ(surface.prepared.mesh.triangles, prepared.mesh.triangles);
  EXPECT_EQ(surface.prepared.mesh.positions, prepared.mesh.positions);
  EXPECT_TRUE(surface.prepared.warnings.empty());
  EXPECT_TRUE(surface.innerShell.empty());
  EXPECT_TRUE(surface.surroundings.empty());
}

TEST(FigureSurface, FacesAreMendedAndCounted) {
  const TriMesh body = blockBody();
  TriMesh mesh = body;
  for (std::size_t t = 0; t < 40; ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  for (std::size_t t = 100; t < 130; ++t) mesh.triangles.push_back(body.triangles[t]);
  const FigureSurface surface = surfaceOf(mesh);
  EXPECT_EQ(countOf(surface, "reversed-faces"), 40u);
  EXPECT_EQ(countOf(surface, "repeated-faces"), 30u);
  expectBodyAlone(surface, body);
}

TEST(FigureSurface, FloorIsNoPartOfTheFigure) {
  const TriMesh body = blockBody();
  for (const float width : {20.0f, 60.0f, 500.0f}) {
    const FigureSurface surface = surfaceOf(testing::joined(body, floorMesh(width)));
    EXPECT_EQ(surface.surroundings.size(), 4u) << width;
    EXPECT_EQ(countOf(surface, "surroundings"), 2u) << width;
    expectBodyAlone(surface, body);
  }
}

TEST(FigureSurface, FloorIsFoundBesideASpeck) {
  const TriMesh body = blockBody();
  TriMesh mesh = testing::joined(body, floorMesh(40));
  mesh = testing::joined(mesh, boxMesh({0.05f, 0.05f, 0.05f}, {24, -1.5f, 0}));
  const FigureSurface surface = surfaceOf(mesh);
  EXPECT_EQ(surface.surroundings.size(), 4u);
  EXPECT_EQ(countOf(surfaceOf(testing::joined(body, floorMesh(500))), "far-vertices"), 0u);
}

TEST(FigureSurface, SlabAndWallAreNoPartOfTheFigure) {
  const TriMesh body = blockBody();
  TriMesh mesh = testing::joined(body, boxMesh({40, 1, 40}, {0, -1.5f, 0}));
  mesh = testing::joined(mesh, boxMesh({40, 30, 0.5f}, {0, 14, -4}));
  const FigureSurface surface = surfaceOf(mesh);
  EXPECT_EQ(surface.surroundings.size(), 16u);
  expectBodyAlone(surface, body);
}

TEST(FigureSurface, PedestalBelowFeetIsNoPartOfTheFigure) {
  const TriMesh body = blockBody(), pedestal = boxMesh({8, 2, 5}, {0, -2.03f, 0});
  const FigureSurface surface = surfaceOf(testing::joined(body, pedestal));
  EXPECT_EQ(surface.surroundings.size(), 8u);
  expectBodyAlone(surface, body);
  const FigureSurface stepped = surfaceOf(
      testing::joined(testing::joined(body, boxMesh({9, 1, 6}, {0, -1.53f, 0})), boxMesh({12, 1, 8}, {0, -2.53f, 0})));
  EXPECT_EQ(stepped.surroundings.size(), 16u);
  expectBodyAlone(stepped, body);
  // The lamp rests on its foot with one pole.
  const TriMesh lamp = testing::joined(boxMesh({1, 9, 1}, {0, 3.5f, 0}), boxMesh({9, 1, 1}, {0, 8.5f, 0}));
  EXPECT_TRUE(surfaceOf(testing::joined(lamp, pedestal)).surroundings.empty());
}

TEST(FigureSurface, BoxRoundTheFigureIsNoPartOfIt) {
  const TriMesh body = blockBody();
  const FigureSurface surface = surfaceOf(testing::joined(body, boxMesh({12.6f, 11.6f, 2.3f}, {0, 4.5f, 0})));
  EXPECT_EQ(surface.surroundings.size(), 8u);
  expectBodyAlone(surface, body);
}

TEST(FigureSurface, PartsOfAModelAreNoSurroundings) {
  // A table, a panel with knobs, a ball with eyes, a block within a block.
  TriMesh table = boxMesh({2, 0.05f, 2}, {0, 1, 0});
  for (const float x : {-0.9f, 0.9f}) {
    for (const float z : {-0.9f, 0.9f}) table = testing::joined(table, boxMesh({0.1f, 0.97f, 0.1f}, {x, 0.485f, z}));
  }
  TriMesh panel = floorMesh(40), ball = ballMesh(1, {0, 0, 0});
  for (const float x : {-0.3f, 0.3f}) {
    panel = testing::joined(panel, ballMesh(1, {30 * x, -1, 0}));
    ball = testing::joined(ball, ballMesh(0.1f, {x, 0.2f, 0.9f}));
  }
  const TriMesh slime = testing::joined(boxMesh({1, 1, 1}, {0, 0, 0}), boxMesh({0.7f, 0.7f, 0.7f}, {0, 0, 0}));
  for (const TriMesh& mesh : {table, panel, ball, slime}) EXPECT_TRUE(surfaceOf(mesh).surroundings.empty());
}

TEST(FigureSurface, CopyWithinTheSurfaceIsLeftOut) {
  const TriMesh body = ballMesh(1, {0, 0, 0});
  TriMesh inner = ballMesh(0.95f, {0, 0, 0});
  for (const bool facesInwards : {false, true}) {
    if (facesInwards) {
      for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
    }
    const FigureSurface surface = surfaceOf(testing::joined(body, inner));
    EXPECT_EQ(surface.innerShell.size(), inner.positions.size());
    EXPECT_EQ(countOf(surface, "inner-shell"), inner.triangles.size());
    expectBodyAlone(surface, body);
  }
}

// A copy may come out of thin parts, and hardly be left of small ones.
TEST(FigureSurface, RoughCopiesOfManyPartsAreLeftOut) {
  TriMesh body = ballMesh(1, {0, 0, 0}), copy = ballMesh(0.97f, {0, 0, 0});
  for (Vec3f& p : copy.positions) {
    if (p.y() > 0.95f) p.y() += 0.06f;
  }
  const TriMesh button = boxMesh({0.1f, 0.1f, 0.1f}, {0, 0, 1.02f}),
                within = boxMesh({0.03f, 0.03f, 0.03f}, {0, 0, 0.9f});
  const TriMesh whole = testing::joined(body, button);
  const FigureSurface surface = surfaceOf(testing::joined(whole, testing::joined(copy, within)));
  EXPECT_EQ(surface.innerShell.size(), copy.positions.size() + within.positions.size());
  expectBodyAlone(surface, whole);
}

TEST(FigureSurface, CopiesOfOpenPartsAreLeftOut) {
  const TriMesh figure = testing::openFigure();
  const FigureSurface surface = surfaceOf(testing::joined(figure, testing::movedInwards(figure, 0.1f)));
  EXPECT_EQ(countOf(surface, "inner-shell"), figure.triangles.size());
  ASSERT_EQ(surface.innerShell.size(), figure.positions.size());
  ASSERT_EQ(surface.innerShellOuter.size(), surface.innerShell.size());
  for (Index i = 0; i < surface.innerShell.size(); ++i) {
    EXPECT_EQ(surface.innerShell[i], surface.innerShellOuter[i] + figure.vertexCount());
  }
  expectBodyAlone(surface, figure);
}

TEST(FigureSurface, WhatIsWithinAModelAndNoCopyStays) {
  EXPECT_TRUE(surfaceOf(testing::joined(ballMesh(1, {0, 0, 0}), ballMesh(0.6f, {0, 0, 0}))).innerShell.empty());
}

}  // namespace
}  // namespace limber
