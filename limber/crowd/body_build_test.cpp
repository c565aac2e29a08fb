#include "limber/crowd/body_build.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "limber/core/error.h"
#include "limber/crowd/testing/dragon.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"

namespace limber {
namespace {

double lengthBetween(const Asset& asset, std::string_view a, std::string_view b) {
  const Skeleton skeleton = readSkeleton(asset).skeleton;
  const std::vector<Vec3> at = restPositions(skeleton);
  return (at[*skeleton.find(a)] - at[*skeleton.find(b)]).norm();
}

// The names of a joint and its parent with a bone of some length between, deepest first.
std::pair<std::string, std::string> aBone(const Asset& asset) {
  const Skeleton skeleton = readSkeleton(asset).skeleton;
  for (Index j = skeleton.jointCount(); j-- > 0;) {
    const Joint& joint = skeleton.joints[j];
    if (joint.parent && joint.rest.translation.norm() > 0.05) return {joint.name, skeleton.joints[*joint.parent].name};
  }
  return {};
}

TEST(BodyBuild, OfEvenFactorsIsAScalingAboutTheGround) {
  Asset asset = dragon();
  const Geometry before = collectGeometry(asset);
  const auto [joint, parent] = aBone(asset);
  const double length = lengthBetween(asset, joint, parent);
  BodyBuild build;
  build.height = 1.5;
  changeBuild(asset, build);
  checkAsset(asset);
  EXPECT_NEAR(lengthBetween(asset, joint, parent), 1.5 * length, 1e-5);
  const Geometry after = collectGeometry(asset);
  const auto lower = [](const Vec3f& a, const Vec3f& b) { return a.y() < b.y(); };
  const float ground = std::min_element(before.positions.begin(), before.positions.end(), lower)->y();
  ASSERT_EQ(after.positions.size(), before.positions.size());
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    const Vec3f wanted = 1.5f * before.positions[v] - Vec3f(0, 0.5f * ground, 0);
    ASSERT_LT((after.positions[v] - wanted).norm(), 1e-4f) << v;
  }
}

TEST(BodyBuild, OfOnesChangesNoVertex) {
  Asset asset = dragon();
  const Geometry before = collectGeometry(asset);
  changeBuild(asset, {});
  const Geometry after = collectGeometry(asset);
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    ASSERT_LT((after.positions[v] - before.positions[v]).norm(), 1e-5f) << v;
  }
}

TEST(BodyBuild, OfASeedIsTheSameAndMirrored) {
  const BodyBuild one = randomBuild(7), again = randomBuild(7), other = randomBuild(8), none = randomBuild(7, 0);
  EXPECT_EQ(one.height, again.height);
  EXPECT_NE(one.height, other.height);
  EXPECT_EQ(none.girth, 1);
  Asset asset = dragon();
  changeBuild(asset, one);
  const Skeleton skeleton = readSkeleton(asset).skeleton;
  const std::vector<Vec3> at = restPositions(skeleton);
  // The sample is symmetric in x, so each joint has its mirror image still.
  for (const Vec3& joint : at) {
    double nearest = 1e9;
    for (const Vec3& partner : at)
      nearest = std::min(nearest, (Vec3(-joint.x(), joint.y(), joint.z()) - partner).norm());
    EXPECT_LT(nearest, 1e-4);
  }
}

TEST(BodyBuild, RefusesFactorsOfNothing) {
  Asset asset = dragon();
  BodyBuild build;
  build.girth = 0;
  EXPECT_THROW(changeBuild(asset, build), Error);
}

}  // namespace
}  // namespace limber
