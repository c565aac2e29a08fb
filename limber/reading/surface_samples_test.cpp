#include "limber/reading/surface_samples.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/reading/pcg32.h"

namespace limber {
namespace {

// Corners at `low` and `low + size`, triangles counter-clockwise seen from outside.
TriMesh box(const Vec3f& low, const Vec3f& size) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(low + size.cwiseProduct(Vec3f(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                                                           static_cast<float>(i >> 2))));
  }
  for (const auto& [a, b, c, d] : std::array<std::array<Index, 4>, 6>{
           {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

TEST(Pcg32, GivesThePublishedNumbers) {
  Pcg32 random = {0, (54u << 1) | 1};  // seeded with 42 and sequence 54, as in the generator's own demonstration
  random.next();
  random.state += 42;
  random.next();
  for (const std::uint32_t number : {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu}) {
    EXPECT_EQ(random.next(), number);
  }
}

TEST(SurfaceSamples, FallOnFacesByArea) {
  const SurfaceSamples surface = sampleSurface(box({0, 0, 0}, {1, 2, 3}), kSurfacePoints);
  Vec3 along = Vec3::Zero();
  for (const SurfaceSample& sample : surface.samples) {
    const Vec3 axis = sample.normal.cwiseAbs();
    EXPECT_NEAR(axis.maxCoeff(), 1, 1e-12);
    along += axis;
    int faceAxis = 0;
    axis.maxCoeff(&faceAxis);
    EXPECT_NEAR(sample.position[faceAxis], sample.normal[faceAxis] > 0 ? faceAxis + 1 : 0, 1e-6);
    EXPECT_EQ(sample.componentFraction, 1);
  }
  along /= kSurfacePoints;  // by chance the fixed numbers are 0.03 off
  EXPECT_NEAR(along.x(), 6.0 / 11, 0.04);
  EXPECT_NEAR(along.y(), 3.0 / 11, 0.04);
  EXPECT_NEAR(along.z(), 2.0 / 11, 0.04);
  EXPECT_FALSE(surface.normalsFlipped);
}

TEST(SurfaceSamples, AreEachFarthestFromThoseBefore) {
  const TriMesh mesh = box({0, 0, 0}, {1, 2, 3});
  const SurfaceSamples all = sampleSurface(mesh, kSurfacePoints), few = sampleSurface(mesh, 12);
  Vec3 mean = Vec3::Zero();
  for (const SurfaceSample& sample : all.samples) mean += sample.position / kSurfacePoints;
  const auto distance = [&](const Vec3& point, std::size_t chosen) {
    double least = chosen == 0 ? (point - mean).norm() : 1e9;
    for (std::size_t i = 0; i < chosen; ++i) least = std::min(least, (point - few.samples[i].position).norm());
    return least;
  };
  for (std::size_t i = 0; i < few.samples.size(); ++i) {
    const double own = distance(few.samples[i].position, i);
    for (const SurfaceSample& other : all.samples) ASSERT_GE(own + 1e-9, distance(other.position, i));
    EXPECT_EQ(few.samples[i].position, all.samples[i].position);
  }
}

TEST(SurfaceSamples, HaveBallsOfTheSizeOfSpheres) {
  // Far from each other, so that the box does not bound the balls; fine, since normals are those of triangles.
  const TriMesh mesh =
      testing::join(testing::icosphere(5), testing::moved(testing::icosphere(5), {2, 2, 2}, {40, 0, 0}));
  for (const SurfaceSample& sample : sampleSurface(mesh).samples) {
    const bool large = sample.position.x() > 20;
    const double radius = large ? 2 : 1;
    EXPECT_NEAR(sample.innerRadius, radius, 0.08 * radius);
    EXPECT_NEAR(sample.componentFraction, large ? 0.8 : 0.2, 0.001);
    const Vec3 ball = sample.position - sample.innerRadius * sample.normal;
    EXPECT_NEAR((ball - Vec3(large ? 40 : 0, 0, 0)).norm(), 0, 0.1 * radius);
  }
}

TEST(SurfaceSamples, TurnNormalsOutwards) {
  TriMesh mesh = testing::moved(testing::icosphere(4), {1, 6, 1}, {0, 0, 0});
  const SurfaceSamples right = sampleSurface(mesh);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const SurfaceSamples flipped = sampleSurface(mesh);
  EXPECT_FALSE(right.normalsFlipped);
  EXPECT_TRUE(flipped.normalsFlipped);
  for (const SurfaceSample& sample : flipped.samples) EXPECT_GT(sample.normal.x() * sample.position.x() + 1e-3, 0);
}

TEST(SurfaceSamples, HaveTheNetworksFrame) {
  const SurfaceSamples surface = sampleSurface(box({5, 6, 7}, {1, 2, 3}));
  Vec3 sum = Vec3::Zero();
  double squares = 0;
  const FloatMatrix features = sampleFeatures(surface);
  ASSERT_EQ(features.columns, 29u);
  for (std::size_t i = 0; i < features.rows; ++i) {
    const float* f = features.row(i);
    const Vec3 position(f[0], f[1], f[2]), normal(f[3], f[4], f[5]), ball(f[6], f[7], f[8]);
    sum += position;
    squares += position.squaredNorm();
    EXPECT_NEAR((position - f[9] * normal - ball).norm(), 0, 1e-6);
    EXPECT_NEAR((surface.toMesh(position) - surface.samples[i].position).norm(), 0, 1e-6);
    for (int k = 0; k < 3; ++k) {
      const double frequency = std::array{1.5, 3.0, 6.0}[k];
      EXPECT_NEAR(f[11 + 6 * k], std::sin(frequency * f[0]), 1e-6);
      EXPECT_NEAR(f[15 + 6 * k], std::cos(frequency * f[1]), 1e-6);
    }
  }
  EXPECT_NEAR(sum.norm() / 512, 0, 1e-6);
  EXPECT_NEAR(squares / 512, 1, 1e-6);
}

TEST(SurfaceSamples, AreTheSameForAnyNumberOfThreads) {
  const TriMesh mesh = testing::icosphere(3);
  setThreadCount(1);
  const FloatMatrix one = sampleFeatures(sampleSurface(mesh));
  setThreadCount(4);
  const FloatMatrix four = sampleFeatures(sampleSurface(mesh));
  setThreadCount(0);
  EXPECT_EQ(one.values, four.values);
}

TEST(SurfaceSamples, RefuseWhatHasNoSurface) {
  TriMesh mesh;
  EXPECT_THROW(sampleSurface(mesh), Error);
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(sampleSurface(mesh), Error);
  mesh.positions[2] = {1, 1, 0};
  EXPECT_EQ(sampleSurface(mesh).samples.size(), 512u);
  EXPECT_THROW(sampleSurface(mesh, 0), Error);
  mesh.positions[2] = {1, std::nanf(""), 0};
  EXPECT_THROW(sampleSurface(mesh), Error);
}

}  // namespace
}  // namespace limber
