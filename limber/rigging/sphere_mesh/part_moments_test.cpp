#include "limber/rigging/sphere_mesh/part_moments.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

using testing::TestRandom;

struct WeightedPoint {
  Vec3 point;
  double weight;
};

std::vector<WeightedPoint> randomWeightedPoints(int count, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<WeightedPoint> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({{random.unit(), 0.3 * random.unit() + 1, 2 * random.unit()}, 0.1 + random.unit()});
  }
  return points;
}

PartMoments momentsOf(const std::vector<WeightedPoint>& points) {
  PartMoments moments;
  for (const auto& [point, weight] : points) moments.addPoint(point, weight);
  return moments;
}

TEST(PartMoments, SumSquaredDistances) {
  const std::vector<WeightedPoint> points = randomWeightedPoints(9, 1);
  const Vec3 center(0.3, -2, 0.7);
  double sum = 0;
  for (const auto& [point, weight] : points) sum += weight * (point - center).squaredNorm();
  EXPECT_NEAR(momentsOf(points).squaredDistances(center), sum, 1e-12);
}

TEST(PartMoments, MirrorWithTheirPoints) {
  std::vector<WeightedPoint> points = randomWeightedPoints(9, 2);
  const PartMoments moments = momentsOf(points), mirrored = moments.mirrored(), both = moments.withMirrorImage();
  for (WeightedPoint& p : points) p.point.x() *= -1;
  PartMoments sum = momentsOf(points);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mirrored.first[i], sum.first[i], 1e-12);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(mirrored.second[i], sum.second[i], 1e-12);
  sum += moments;
  EXPECT_EQ(both.weight, sum.weight);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(both.first[i], sum.first[i], 1e-12);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(both.second[i], sum.second[i], 1e-12);
}

TEST(PartMoments, TheBoundComesFromTheLeastVariance) {
  for (std::uint64_t seed = 1; seed < 80; ++seed) {
    const std::vector<WeightedPoint> points = randomWeightedPoints(2 + static_cast<int>(seed % 12), seed);
    const PartMoments moments = momentsOf(points);
    Vec3 mean = Vec3::Zero();
    for (const auto& [point, weight] : points) mean += weight / moments.weight * point;
    Mat3 covariance = Mat3::Zero();
    for (const auto& [point, weight] : points) {
      covariance += weight / moments.weight * (point - mean) * (point - mean).transpose();
    }
    const double least = std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvalues()[0]);
    EXPECT_NEAR(moments.radiusBound(), 1.5 * std::sqrt(3 * least), 1e-6 + 1e-4 * std::sqrt(least)) << seed;
  }
}

TEST(PartMoments, BoundsOfKnownShapes) {
  PartMoments sphere, hemisphere, flat, point;
  for (const Vec3f& p : testing::ball(4).positions) {
    sphere.addPoint(2 * p.cast<double>(), 1);
    if (p.y() > 0) hemisphere.addPoint(2 * p.cast<double>(), 1);
  }
  for (const Vec3f& p : testing::flatGrid(5, 3).positions) flat.addPoint(p.cast<double>(), 1);
  point.addPoint({1, 2, 3}, 1);
  EXPECT_NEAR(sphere.radiusBound(), 3, 0.02);
  EXPECT_NEAR(hemisphere.radiusBound(), 1.5, 0.05);
  EXPECT_NEAR(flat.radiusBound(), 0, 1e-6);
  EXPECT_NEAR(point.radiusBound(), 0, 1e-6);
  EXPECT_EQ(PartMoments{}.radiusBound(), 0);
}

}  // namespace

}  // namespace limber
