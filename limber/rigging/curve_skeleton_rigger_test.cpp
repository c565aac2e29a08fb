#include "limber/rigging/curve_skeleton_rigger.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

AutoRig curveRigged(const TriMesh& mesh, std::optional<Index> handles, std::shared_ptr<RigMemory> memory = nullptr) {
  Progress progress;
  RigOptions options{handles};
  options.memory = std::move(memory);
  return rigWithCurveSkeleton(mesh, options, progress);
}

TEST(CurveSkeletonRigger, MakesASoundSkeletonOfTheCountAskedFor) {
  const TriMesh mesh = testing::blockBiped(1);
  const auto memory = std::make_shared<RigMemory>();
  for (const Index count : {1u, 2u, 3u, 6u, 20u, 100u, mesh.vertexCount()}) {
    const Skeleton skeleton = curveRigged(mesh, count, memory).skeleton;
    EXPECT_EQ(skeleton.jointCount(), count);
    EXPECT_NO_THROW(checkSkeleton(skeleton));
    std::set<std::string> names;
    for (const Joint& joint : skeleton.joints) names.insert(joint.name);
    EXPECT_EQ(names.size(), count);
  }
}

TEST(CurveSkeletonRigger, WhatIsRememberedGivesTheSame) {
  const TriMesh mesh = testing::blockBiped(1);
  const auto memory = std::make_shared<RigMemory>();
  for (const Index count : {20u, 7u, 33u}) {
    const Skeleton known = curveRigged(mesh, count, memory).skeleton, fresh = curveRigged(mesh, count).skeleton;
    ASSERT_EQ(known.jointCount(), fresh.jointCount());
    for (Index j = 0; j < known.jointCount(); ++j) {
      EXPECT_EQ(known.joints[j].name, fresh.joints[j].name);
      EXPECT_EQ(known.joints[j].rest.translation, fresh.joints[j].rest.translation);
    }
  }
  EXPECT_TRUE(memory->curves);
}

TEST(CurveSkeletonRigger, NamesTellTheSidesAndTheRootIsOnThePlane) {
  const Skeleton skeleton = curveRigged(testing::blockBiped(1), 16).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  EXPECT_EQ(skeleton.joints[0].name, "handle_00");
  EXPECT_EQ(globals[0].translation().x(), 0);
  std::size_t pairs = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::string& name = skeleton.joints[j].name;
    const Vec3 position = globals[j].translation();
    const std::string side = name.substr(9);
    EXPECT_EQ(side, position.x() > 0 ? ".L" : position.x() < 0 ? ".R" : "") << name;
    if (side != ".L") continue;
    ++pairs;
    const std::optional<Index> image = skeleton.find(name.substr(0, 9) + ".R");
    ASSERT_TRUE(image);
    EXPECT_LT((globals[*image].translation() - Vec3(-position.x(), position.y(), position.z())).norm(), 1e-12);
  }
  EXPECT_GE(pairs, 4u);
}

TEST(CurveSkeletonRigger, SuggestsCountsThatItCanGive) {
  const AutoRig rig = curveRigged(testing::blockBiped(1), std::nullopt);
  ASSERT_FALSE(rig.suggestions.empty());
  EXPECT_EQ(rig.skeleton.jointCount(), rig.suggestions[0].handles);
  for (const HandleSuggestion& suggestion : rig.suggestions) {
    EXPECT_GE(suggestion.score, 0);
    EXPECT_LE(suggestion.score, 1);
  }
}

TEST(CurveSkeletonRigger, RefusesWhatItCannotServe) {
  EXPECT_THROW(curveRigged(testing::octahedron(), 0), Error);
  EXPECT_THROW(curveRigged(testing::octahedron(), 7), Error);
  EXPECT_THROW(curveRigged(testing::flatGrid(5, 5), 3), Error);
  EXPECT_EQ(findRigger("curve-skeleton").name, "curve-skeleton");
}

}  // namespace

}  // namespace limber
