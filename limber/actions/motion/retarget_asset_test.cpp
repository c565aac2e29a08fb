#include "limber/actions/motion/retarget_asset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/document/clip/motion_io.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Two people two metres apart who walk, the joints of the second with "_2" behind their names.
Motion twoPeople() {
  const Skeleton person = practiceHumanoid();
  Motion motion;
  motion.name = "two";
  motion.skeleton = person;
  for (Joint joint : person.joints) {
    joint.name += "_2";
    if (joint.parent)
      joint.parent = *joint.parent + person.jointCount();
    else
      joint.rest.translation.x() += 2;
    motion.skeleton.joints.push_back(joint);
  }
  PoseSequence frames = limber::testing::walk(person, 30);
  for (Pose& pose : frames.poses) {
    const Pose one = pose;
    pose.locals.insert(pose.locals.end(), one.locals.begin(), one.locals.end());
    pose.locals[person.jointCount()].translation.x() += 2;
  }
  motion.clips.push_back(clipOf(motion.skeleton, frames, "walk"));
  return motion;
}

// Each on a skin of its own.
Asset inTwoSkins(const Motion& motion) {
  Asset asset = motionAsset(motion);
  gltf::Skin& first = asset.document.skins.front();
  first.inverseBindMatrices.reset();
  first.skeleton.reset();
  gltf::Skin second = first;
  const auto half = static_cast<std::ptrdiff_t>(first.joints.size() / 2);
  second.joints.erase(second.joints.begin(), second.joints.begin() + half);
  first.joints.erase(first.joints.begin() + half, first.joints.end());
  asset.document.skins.push_back(std::move(second));
  return asset;
}

TEST(RetargetAsset, AMotionInTwoSkinsIsOfTwoBodies) {
  const Motion motion = motionOf(inTwoSkins(twoPeople()));
  Motion hero;
  hero.skeleton = limber::testing::oddlyBuilt();
  Asset character = motionAsset(hero);
  try {
    retargetOnto(character, Character(character), motion, {});
    FAIL() << "which of both?";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("holds 2 bodies"), HasSubstr("'hips' and 'hips_2'")));
  }
  RetargetAssetOptions second;
  second.body = "hips_2";
  const std::vector<RetargetedClip> clips = retargetOnto(character, Character(character), motion, second);
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_TRUE(clips[0].map.isBiped());
  EXPECT_THAT(clips[0].mapJson, HasSubstr("hips_2"));
}

// By form alone nobody knows whether a finger's last joint is its tip; of the same body everything is known.
TEST(RetargetAsset, DoubtfulMatchesAreAWarning) {
  const Skeleton person = practiceHumanoid();
  Motion motion;
  motion.name = "walk";
  motion.clips.push_back(clipOf(person, limber::testing::walk(person, 30), "walk"));
  for (const bool isSame : {true, false}) {
    motion.skeleton = isSame ? person : limber::testing::nameless(person);
    Motion hero;
    hero.skeleton = isSame ? person : limber::testing::oddlyBuilt();
    Asset character = motionAsset(hero);
    const std::vector<RetargetedClip> clips = retargetOnto(character, Character(character), motion, {});
    ASSERT_EQ(clips.size(), 1u);
    EXPECT_EQ(clips[0].doubtful.empty(), isSame);
    std::size_t warned = 0;
    for (const Warning& warning : character.warnings.items()) {
      if (warning.kind == "doubtful-matches") warned += warning.count;
    }
    EXPECT_EQ(warned, clips[0].doubtful.size());
  }
}

// A track that holds the scale of the rest pose moves nothing.
TEST(RetargetAsset, ScalesThatMoveAreAWarning) {
  const Skeleton person = practiceHumanoid();
  for (const bool moves : {true, false}) {
    Motion motion;
    motion.name = "breathe";
    motion.skeleton = person;
    motion.clips.push_back(clipOf(person, limber::testing::walk(person, 30), "walk"));
    motion.clips[0].scales.clear();
    for (const char* joint : {"chest", "head"}) {
      Track<Vec3f> track;
      track.joint = person.find(joint).value();
      track.times = {0, 0.2f};
      track.values = {Vec3f::Ones(), moves ? Vec3f(1.2f, 1, 1) : Vec3f(1, 1, 1)};
      motion.clips[0].scales.push_back(track);
    }
    Motion hero;
    hero.skeleton = limber::testing::oddlyBuilt();
    Asset character = motionAsset(hero);
    const std::vector<RetargetedClip> clips = retargetOnto(character, Character(character), motion, {});
    ASSERT_EQ(clips.size(), 1u);
    EXPECT_EQ(limber::testing::countOf(character.warnings, "motion-scales"), moves ? 2u : 0u) << "joints";
    std::vector<std::string> locations;
    for (const Warning& warning : character.warnings.items()) {
      if (warning.kind == "motion-scales") locations.push_back(warning.where);
    }
    EXPECT_EQ(locations, moves ? std::vector<std::string>{"breathe: chest"} : std::vector<std::string>());
  }
}

}  // namespace
}  // namespace limber
