#include "limber/preview/studio_light.h"

#include <gtest/gtest.h>

#include <vector>

namespace limber {
namespace {

// A square of that half side at that height, facing up.
void addTable(std::vector<Vec3f>& positions, std::vector<Triangle>& triangles, float half, float height) {
  const Index n = static_cast<Index>(positions.size());
  for (const auto& [x, z] : {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
    positions.push_back({x, height, z});
  triangles.push_back({n, n + 2, n + 1});
  triangles.push_back({n, n + 3, n + 2});
}

TEST(StudioLight, ItIsDarkUnderATable) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  addTable(positions, triangles, 1, 1);
  addTable(positions, triangles, 3, 0);
  const StudioLight light(positions, triangles, 0, 0);
  const Vec3 up(0, 1, 0), viewer = Vec3(0, 1, 1).normalized();
  const double under = light.shade({0, 0, 0}, up, viewer).diffuse.mean();
  const double open = light.shade({2.5, 0, -2.5}, up, viewer).diffuse.mean();
  const double top = light.shade({0, 1, 0}, up, viewer).diffuse.mean();
  EXPECT_LT(under, 0.6 * open);
  EXPECT_NEAR(top, light.shadeUnshadowed(up, viewer).diffuse.mean(), 0.02 * top);
  EXPECT_LE(open, top + 1e-9);
}

TEST(StudioLight, TheGroundIsDarkestBelowTheModelAndBrightFarAway) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  addTable(positions, triangles, 1, 0.5f);
  addTable(positions, triangles, 0.05f, 0);
  const StudioLight light(positions, triangles, 35, 0);
  EXPECT_EQ(light.groundHeight(), 0);
  EXPECT_LT(light.groundLight({0, 0, 0}), 0.5);
  EXPECT_GT(light.groundLight({2.5, 0, 2.5}), 0.9);
  EXPECT_EQ(light.groundLight({1e6, 0, 0}), 1);
}

TEST(StudioLight, AFaceTurnedAwayFromTheLampsIsDarker) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  addTable(positions, triangles, 1, 0);
  const StudioLight light(positions, triangles, 0, 0);
  const Vec3 viewer(0, 0, 1);
  EXPECT_GT(light.shadeUnshadowed(Vec3(-0.5, 0.6, 0.6).normalized(), viewer).diffuse.mean(),
            3 * light.shadeUnshadowed({0, -1, 0}, viewer).diffuse.mean());
}

}  // namespace
}  // namespace limber
