#include "limber/actions/parts/model_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

SurfaceParts partsOf(const Asset& asset, const PartOptions& options) {
  Progress progress;
  return modelParts(asset, options, progress);
}

Asset riggedDumbbell() {
  Asset asset = testing::assetOf(testing::dumbbell(21, 12));
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton = testing::twoJoints(2.1);
  skeleton.joints[0].rest.translation = {1, 2, 3};
  attachRig(asset, geometry, skeleton, testing::twoJointWeights(geometry.positions, 2.1, 1, 1));
  return asset;
}

TEST(ModelParts, NamesThatAreNotKnownAreRefusedWithThoseThatAre) {
  EXPECT_EQ(parsePartMethod("shape"), PartMethod::kShape);
  EXPECT_EQ(parsePartDetail("joints"), PartDetail::kJoints);
  EXPECT_THROW(parsePartDetail("cells"), Error);
  try {
    parsePartMethod("colour");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("no segmentation method is called 'colour'"));
    EXPECT_THAT(error.remedy(), ::testing::HasSubstr("auto, weights, shape"));
  }
}

TEST(ModelParts, ByWeightsNeedsARig) {
  EXPECT_THROW(partsOf(testing::assetOf(testing::icosphere(1)), {PartMethod::kWeights, {}, {}}), Error);
}

TEST(ModelParts, ARiggedModelGoesByItsWeightsAndOthersByShape) {
  const SurfaceParts rigged = partsOf(riggedDumbbell(), {});
  EXPECT_THAT(rigged.names, ::testing::ElementsAre("lower", "upper"));  // no limbs: by joints
  const SurfaceParts byShape = partsOf(riggedDumbbell(), {PartMethod::kShape, {}, 2});
  EXPECT_THAT(byShape.names, ::testing::ElementsAre("part_01", "part_02"));
  const SurfaceParts still = partsOf(testing::assetOf(testing::dumbbell(21, 12)), {PartMethod::kAuto, {}, 2});
  EXPECT_EQ(still.partOf, byShape.partOf);
}

TEST(ModelParts, VerticesAtOnePlaceCountAsOne) {
  const TriMesh mesh = testing::dumbbell(21, 12);
  const PartOptions options = {PartMethod::kShape, {}, 2};
  EXPECT_EQ(partsOf(testing::assetOf(mesh, true), options).partOf, partsOf(testing::assetOf(mesh), options).partOf);
}

TEST(ModelParts, TrianglesWithoutAreaGoWithTheirNeighbours) {
  TriMesh mesh = testing::dumbbell(21, 12);
  mesh.triangles.push_back({0, 0, 1});
  const SurfaceParts parts = partsOf(testing::assetOf(mesh), {PartMethod::kShape, {}, 2});
  ASSERT_EQ(parts.partOf.size(), mesh.triangles.size());
  EXPECT_EQ(parts.partOf.back(), parts.partOf.front());
}

TEST(ModelParts, StopWhenCancelled) {
  for (const PartMethod method : {PartMethod::kWeights, PartMethod::kShape}) {
    const Asset asset = riggedDumbbell();
    Progress progress;
    progress.cancel();
    EXPECT_THROW(modelParts(asset, {method, {}, {}}, progress), Error);
  }
}

}  // namespace
}  // namespace limber
