// Which bones hold a vertex and how strongly, against distances and sight worked out one by one.
#include "limber/rigging/weights/heat_sources.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

HeatSourceOptions plain() {
  HeatSourceOptions options;
  options.heat = 1;
  options.facing = false;
  return options;
}

std::vector<Bone> randomBones(Index count, double radius) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5);
  std::vector<Bone> bones;
  for (Index joint = 0; joint < count; ++joint) {
    const Vec3 a(coordinate(random), coordinate(random), coordinate(random));
    const Vec3 along(coordinate(random), coordinate(random), coordinate(random));
    bones.push_back({joint, a, radius > 0 ? a : Vec3(a + 0.4 * along), radius * (0.5 + coordinate(random))});
  }
  return bones;
}

double axisDistance(const Bone& bone, const Vec3& p) {
  const Vec3 along = bone.b - bone.a;
  const double s = along.squaredNorm() > 0 ? std::clamp((p - bone.a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
  return (bone.a + s * along - p).norm();
}

TEST(HeatSources, NearestOfManyBones) {
  for (const double radius : {0.0, 0.1}) {
    const std::vector<Bone> bones = randomBones(80, radius);
    for (const TriMesh& mesh : {testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero()),
                                testing::soup(400, 300, 2)}) {  // neighbours in order, and not
      const HeatSources sources = findHeatSources(mesh, bones, nullptr, plain());
      for (Index v = 0; v < mesh.vertexCount(); ++v) {
        const Bone* nearest = &bones[0];
        const auto surface = [&](const Bone& bone) { return axisDistance(bone, mesh.position(v)) - bone.radius; };
        for (const Bone& bone : bones) {
          if (surface(bone) < surface(*nearest)) nearest = &bone;
        }
        const auto joints = sources.jointsOf(v);
        ASSERT_TRUE(std::find(joints.begin(), joints.end(), nearest->joint) != joints.end());
        if (joints.size() > 1) continue;  // a tie
        const double distance = axisDistance(*nearest, mesh.position(v));
        EXPECT_NEAR(sources.pull[v] * distance * distance, 1, 1e-9);
      }
    }
  }
}

TEST(HeatSources, EquallyNearBonesShareAndOthersDoNot) {
  const TriMesh mesh{{{0, 0, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}}, {{0, 1, 2}}};
  const Bone bones[] = {{3, {-0.5, 0.1, 0.2}, {0, 0, 0.2}, 0},
                        {1, {0, 0, 0.2}, {-0.5, -0.1, 0.2}, 0},
                        {2, {0, 0, 0.2001}, {0, 0, 0.4}, 0}};
  const HeatSources sources = findHeatSources(mesh, bones, nullptr, plain());
  ASSERT_EQ(sources.jointsOf(0).size(), 2u);
  EXPECT_EQ(sources.jointsOf(0)[0], 1u);
  EXPECT_EQ(sources.jointsOf(0)[1], 3u);
  EXPECT_NEAR(sources.pull[0], 25, 1e-9);
}

TEST(HeatSources, AVertexWhoseNearestBoneIsHiddenSeesNone) {
  TriMesh mesh{{{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}}, {{0, 1, 2}}};
  mesh.positions.insert(mesh.positions.end(), {{-1, -1, 0.1f}, {1, -1, 0.1f}, {0, 1, 0.1f}});  // a roof
  mesh.triangles.push_back({3, 4, 5});
  const Bvh bvh(mesh);
  const Bone bones[] = {{0, {0, 0, 0.15}, {0, 0, 0.3}, 0}, {1, {0, 0, -0.5}, {0, 0, -0.6}, 0}};
  const HeatSources sources = findHeatSources(mesh, bones, &bvh, plain());
  EXPECT_TRUE(sources.jointsOf(0).empty());
  EXPECT_EQ(sources.pull[0], 0);
}

TEST(HeatSources, PullIsBoundedOnTheBoneItself) {
  const TriMesh mesh{{{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}}, {{0, 1, 2}}};
  const Bone bones[] = {{0, {0, 0, 0}, {0.1, 0, 0}, 0}};
  HeatSourceOptions options = plain();
  options.minDistance = 0.01;
  EXPECT_NEAR(findHeatSources(mesh, bones, nullptr, options).pull[0], 1e4, 1e-6);
}

TEST(HeatSources, TheJointOfTheRegionIsInSightAndComesBeforeWhatIsHalfAsFar) {
  const TriMesh wall{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0.5, -1}, {3, 0.5, -1}, {1, 0.5, 3}},
                     {{0, 1, 2}, {3, 4, 5}}};  // the second hides what is above it from the first two vertices
  const Bvh bvh(wall);
  const Bone bones[] = {{0, {0, 1, 0.2}, {0, 1, 0.2}, 0}, {1, {0, -0.8, 0.2}, {0, -0.8, 0.2}, 0}};
  const auto jointAt = [&](Index region) {
    const std::vector<Index> jointOf(wall.positions.size(), region);
    const HeatSources sources = findHeatSources(wall, bones, &bvh, plain(), jointOf);
    return sources.jointsOf(0).empty() ? kNoIndex : sources.jointsOf(0)[0];
  };
  EXPECT_EQ(jointAt(0), 0u) << "hidden, but of its region";
  EXPECT_EQ(jointAt(1), 1u);
  const Bone near[] = {bones[0], {1, {0, -0.4, 0.2}, {0, -0.4, 0.2}, 0}};
  const std::vector<Index> jointOf(wall.positions.size(), 0);
  EXPECT_EQ(findHeatSources(wall, near, &bvh, plain(), jointOf).jointsOf(0)[0], 1u) << "less than half as far";
}

TEST(HeatSources, ABoneInFrontOfTheSurfaceCountsAsFarther) {
  const TriMesh ball = testing::moved(testing::icosphere(2), Vec3f::Constant(0.5f), Vec3f::Zero());
  const Bone bones[] = {{0, {0, 0.62, 0}, {0, 0.7, 0}, 0}, {1, {0, 0.2, 0}, {0, 0.1, 0}, 0}};
  Index top = 0;
  for (Index v = 0; v < ball.vertexCount(); ++v) {
    if (ball.positions[v].y() > ball.positions[top].y()) top = v;
  }
  HeatSourceOptions options = plain();
  EXPECT_EQ(findHeatSources(ball, bones, nullptr, options).jointsOf(top)[0], 0u);
  options.facing = true;
  EXPECT_EQ(findHeatSources(ball, bones, nullptr, options).jointsOf(top)[0], 1u);
}

}  // namespace
}  // namespace limber
