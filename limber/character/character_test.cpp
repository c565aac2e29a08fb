#include "limber/character/character.h"

#include <gtest/gtest.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/scene/shape_surface.h"
#include "limber/document/testing/two_bind_poses.h"
#include "limber/samples/samples.h"

namespace limber {
namespace {

const Asset& flying() {
  static const Asset kFlying = makeSample("flying");
  return kFlying;
}

TEST(Character, ReadsWhatTheDocumentHas) {
  const Asset& asset = flying();
  const Character character(asset);
  ASSERT_TRUE(character.hasRig());
  EXPECT_TRUE(SkeletonReading(readSkeleton(asset).skeleton).isOf(character.skeleton()));
  EXPECT_EQ(character.binding().jointNode, readSkeleton(asset).jointNode);
  EXPECT_EQ(character.moving().jointNode, animatedSkeleton(asset).jointNode);
  EXPECT_EQ(character.surface().positions.size(), collectGeometry(asset).positions.size());
  EXPECT_EQ(character.weights().weights, readWeights(asset, collectGeometry(asset), readSkeleton(asset)).weights);
  EXPECT_EQ(character.anatomy().parts.size(), readAnatomy(character.skeleton()).parts.size());
  EXPECT_FALSE(character.skin()->joints.empty());
}

TEST(Character, ReadsOnceAndSharesWithCopies) {
  const Character character(flying().clone());
  const Character copy = character;
  EXPECT_EQ(&character.surface(), &copy.surface());
  EXPECT_EQ(&character.binding(), &character.binding());
  EXPECT_EQ(&character.anatomy(), &copy.anatomy());
  EXPECT_EQ(character.skin(), copy.skin());
  EXPECT_EQ(character.sharedSurface().get(), &copy.surface());
}

TEST(Character, RenamedHasItsOwnNamesAndTheSameSurface) {
  const Character character(flying().clone());
  Asset other = character.document().clone();
  other.document.nodes[character.binding().jointNode[0]].name = "another";
  const Character renamed = character.renamed(std::move(other));
  EXPECT_EQ(renamed.skeleton().joints[0].name, "another");
  EXPECT_NE(character.skeleton().joints[0].name, "another");
  EXPECT_EQ(&renamed.surface(), &character.surface());
  EXPECT_EQ(&renamed.weights(), &character.weights());
}

TEST(Character, OfARigMovesAsItIsBound) {
  const Character character(flying());
  EXPECT_EQ(&character.moving(), &character.binding()) << "read once";
}

TEST(Character, ShapedSurfaceIsTheSameWithoutShapes) {
  const Character character(flying());
  EXPECT_EQ(&character.shapedSurface(), &character.surface());
  EXPECT_EQ(shapedGeometry(flying()).positions, character.surface().positions);
}

TEST(Character, InOneBindPoseIsTheSameOrThatOfTheJoinedDocument) {
  const Character one(flying());
  EXPECT_EQ(&one.inOneBindPose().document(), &flying());
  const Asset asset = testing::partsInTwoBindPoses({0, 5, 0});
  const Character two = asset;
  const Character joined = two.inOneBindPose();
  EXPECT_NE(&joined.document(), &asset);
  EXPECT_EQ(&two.inOneBindPose().surface(), &joined.surface()) << "made once";
  EXPECT_EQ(joined.surface().positions, collectGeometry(*withJoinedBinds(asset)).positions);
  EXPECT_NE(joined.surface().positions, two.surface().positions);
}

TEST(Character, OfADocumentThatGetsClips) {
  Asset asset = flying().clone();
  const Character character(asset);
  const std::size_t clips = asset.document.animations.size();
  Clip clip = readClips(asset, character.moving(), asset.warnings).front();
  addClips(asset, character.moving(), {&clip, 1});
  EXPECT_EQ(character.document().document.animations.size(), clips + 1);
}

TEST(Character, SaysThatNothingMovesWheneverItIsAsked) {
  const Character character(makeSample("biped"));
  EXPECT_FALSE(character.hasRig());
  for (int time = 0; time < 2; ++time) EXPECT_THROW(character.moving(), Error) << time;
  EXPECT_FALSE(character.surface().positions.empty());
}

}  // namespace
}  // namespace limber
