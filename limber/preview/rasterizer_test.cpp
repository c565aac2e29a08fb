#include "limber/preview/rasterizer.h"

#include <gtest/gtest.h>

#include <vector>

namespace limber {
namespace {

// Looks along -z from (0, 0, 10); the square |x|, |y| <= 1 at z = 0 fills a picture of one tile.
Camera squareCamera() {
  Camera camera;
  camera.eye = {0, 0, 10};
  camera.width = camera.height = kTileSize;
  camera.focal = 10 * kTileSize / 2;
  return camera;
}

TEST(Rasterizer, NeighbouringTrianglesLeaveNoGap) {
  // A fan round an odd point inside a square that covers the tile.
  const std::vector<Vec3f> positions = {
      {-1.5f, -1.5f, 0}, {1.5f, -1.5f, 0}, {1.5f, 1.5f, 0}, {-1.5f, 1.5f, 0}, {0.123f, -0.217f, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const ProjectedMesh mesh(positions, triangles, squareCamera());
  TileSamples samples;
  rasterizeTile(mesh, 0, 0, samples);
  std::vector<int> count(4, 0);
  for (const Index t : samples.triangle) {
    ASSERT_NE(t, kNoIndex);
    ++count[t];
  }
  for (const int c : count) EXPECT_GT(c, 500);
}

TEST(Rasterizer, TheNearestWinsWhateverTheOrder) {
  const std::vector<Vec3f> positions = {{-3, -3, 0}, {3, -3, 0}, {0, 5, 0}, {-3, -3, 1}, {3, -3, 1}, {0, 5, 1}};
  for (const std::vector<Triangle>& triangles :
       {std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}, std::vector<Triangle>{{5, 4, 3}, {2, 1, 0}}}) {
    const ProjectedMesh mesh(positions, triangles, squareCamera());
    TileSamples samples;
    rasterizeTile(mesh, 0, 0, samples);
    const Index seen = samples.triangle[(kTileSize / 2 * kTileSize + kTileSize / 2) * kSamplesPerPixel];
    ASSERT_NE(seen, kNoIndex);
    EXPECT_EQ(positions[triangles[seen][0]].z(), 1);
  }
}

TEST(Rasterizer, CoverageIsTheAreaOfTheTriangle) {
  const std::vector<Vec3f> positions = {{-0.9f, -0.9f, 0}, {0.9f, -0.8f, 0}, {0.1f, 0.7f, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const ProjectedMesh mesh(positions, triangles, squareCamera());
  TileSamples samples;
  rasterizeTile(mesh, 0, 0, samples);
  double covered = 0;
  for (const Index t : samples.triangle) covered += t == 0;
  const double area = 0.5 * (1.8 * 1.6 - 0.1 * 1.0) / 4;  // of the tile's area
  EXPECT_NEAR(covered / double(samples.triangle.size()), area, 0.004);
}

TEST(Rasterizer, WhatIsBehindTheCameraIsLeftOut) {
  const std::vector<Vec3f> positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 20}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  EXPECT_TRUE(ProjectedMesh(positions, triangles, squareCamera()).inTile(0, 0).empty());
}

TEST(Rasterizer, BarycentricWeightsAreThoseInSpace) {
  const std::vector<Vec3f> positions = {{-0.8f, -0.5f, 3}, {0.9f, -0.4f, -2}, {0, 0.8f, 1}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const Camera camera = squareCamera();
  const ProjectedMesh mesh(positions, triangles, camera);
  const Vec3 weights(0.2, 0.5, 0.3);
  Vec3 point = Vec3::Zero();
  for (std::size_t c = 0; c < 3; ++c) point += weights[static_cast<Eigen::Index>(c)] * positions[c].cast<double>();
  const Vec3 seen = camera.project(point);
  const Vec3 found =
      mesh.barycentric(0, std::int32_t(std::lround(seen.x() * 256)), std::int32_t(std::lround(seen.y() * 256)));
  EXPECT_LT((found - weights).norm(), 2e-3);
}

}  // namespace
}  // namespace limber
