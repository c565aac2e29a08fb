#include "limber/session/drag/pick.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/session/testing/models.h"

namespace limber {
namespace {

TEST(PickHandle, TakesTheNearestThatTheRayMeets) {
  const std::array<Vec3, 3> centers = {Vec3(0, 0, -4), Vec3(0, 0.05, -2), Vec3(0, 0, 5)};
  const std::array<double, 3> radii = {1, 0.1, 0.5};
  const auto hit = pickHandle({{0, 0, 0}, {0, 0, -2}}, centers, radii, 0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->joint, 1u);
  EXPECT_TRUE(hit->onHandle);
  EXPECT_NEAR(hit->distance, 2 - std::sqrt(0.1 * 0.1 - 0.05 * 0.05), 1e-12);
  // Beside the small one, the large one behind it is met.
  EXPECT_EQ(pickHandle({{0.3, 0, 0}, {0, 0, -1}}, centers, radii, 0)->joint, 0u);
  EXPECT_FALSE(pickHandle({{3, 0, 0}, {0, 0, -1}}, centers, radii, 0));
}

TEST(PickHandle, SmallHandlesAreAsLargeAsAFinger) {
  const std::array<Vec3, 2> centers = {Vec3(0, 0, -10), Vec3(0.6, 0, -10)};
  const std::array<double, 2> radii = {0.01, 0.01};
  const Ray between{{0, 0, 0}, {0.25, 0, -10}};
  EXPECT_FALSE(pickHandle(between, centers, radii, 0.001));
  EXPECT_EQ(pickHandle(between, centers, radii, 0.04)->joint, 0u);
  EXPECT_EQ(pickHandle({{0, 0, 0}, {0.35, 0, -10}}, centers, radii, 0.04)->joint, 1u);
  // What is met outright comes before what is merely near, however near.
  const std::array<double, 2> unequal = {0.3, 0.01};
  EXPECT_EQ(
      pickHandle({{0, 0, 0}, {0.29, 0, -10}}, std::array<Vec3, 2>{Vec3(0, 0, -10), Vec3(0.3, 0, -10)}, unequal, 0.04)
          ->joint,
      0u);
  // Behind the camera nothing is near.
  EXPECT_FALSE(pickHandle({{0, 0, 0}, {0, 0, 1}}, centers, radii, 10));
}

TEST(PickSurface, FindsThePosedSurfaceAndTheJointThatHoldsIt) {
  const auto model = testing::rigBiped(8);
  Pose pose = model->home;
  const Vec3 aside(3, 0, 0);
  pose.locals[0].translation += aside;  // the whole model moves along

  int met = 0;
  for (std::size_t t = 0; t < model->geometry().triangles.size(); t += 11) {
    const Triangle& triangle = model->geometry().triangles[t];
    Vec3 point = aside;
    std::vector<double> weightByJoint(model->skeleton().joints.size());
    for (const Index v : triangle) {
      point += model->geometry().positions[v].cast<double>() / 3;
      for (Index k = 0; k < model->weights.slots; ++k) {
        weightByJoint[model->weights.jointsOf(v)[k]] += double{model->weights.weightsOf(v)[k]} / 3;
      }
    }
    const Vec3 displacement(0.1, -5, 0.2);
    const auto hit = pickSurface({point - displacement, displacement}, *model, pose);
    ASSERT_TRUE(hit);
    EXPECT_FALSE(hit->onHandle);
    EXPECT_GE((hit->inside - hit->position).dot(displacement), 0);
    EXPECT_LE(hit->distance, displacement.norm() + 1e-4);  // that triangle, or one before it
    EXPECT_LT((hit->position - (point - displacement + hit->distance * displacement.normalized())).norm(), 1e-4);
    if ((hit->position - point).norm() > 1e-4) continue;
    ++met;
    for (const double other : weightByJoint) EXPECT_GE(weightByJoint[hit->joint], other - 1e-4);
  }
  EXPECT_GT(met, 5);
  // Through the middle of the trunk from the front.
  const auto front = pickSurface({aside + Vec3(0, 1, 5), {0, 0, -1}}, *model, pose);
  const auto back = pickSurface({aside + Vec3(0, 1, -5), {0, 0, 1}}, *model, pose);
  ASSERT_TRUE(front && back);
  EXPECT_LT((front->inside - 0.5 * (front->position + back->position)).norm(), 1e-4);
  EXPECT_FALSE(pickSurface({{0, 5, 0}, {0, -1, 0}}, *model, pose));
}

}  // namespace
}  // namespace limber
