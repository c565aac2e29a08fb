#include "limber/actions/rig/stand_upright.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/actions/motion/retarget_asset.h"
#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/testing/document_json.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

const std::vector<Vec3> kAxes = {Vec3::UnitX(), -Vec3::UnitX(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()};

// A person whose up axis in rest pose is `up`.
Skeleton personAlong(const Vec3& up) {
  Skeleton person = practiceHumanoid();
  Transform& root = person.joints[0].rest;
  const Quat turn = shortestRotation(Vec3::UnitY(), up);
  root.rotation = turn * root.rotation;
  root.translation = turn * root.translation;
  return person;
}

// A second of rest, upright along +Y, whatever the rest pose is.
Clip standingStill() {
  const Transform root = practiceHumanoid().joints[0].rest;
  Clip clip;
  clip.name = "still";
  clip.rotations.push_back(
      {0, Interpolation::kLinear, {0, 1}, std::vector(2, Eigen::Quaternionf(root.rotation.cast<float>()))});
  clip.translations.push_back(
      {0, Interpolation::kLinear, {0, 1}, std::vector(2, Vec3f(root.translation.cast<float>()))});
  return clip;
}

Asset document(const Skeleton& skeleton, std::vector<Clip> clips = {}) {
  Motion motion;
  motion.name = "still";
  motion.skeleton = skeleton;
  motion.clips = std::move(clips);
  return motionAsset(motion);
}

std::vector<std::string> kindsOf(const Warnings& warnings) {
  std::vector<std::string> kinds;
  for (const Warning& warning : warnings.items()) kinds.push_back(warning.kind);
  return kinds;
}

std::optional<Vec3> upOf(const Asset& asset, double seconds = -1) {
  const Motion motion = motionOf(asset);
  Pose pose = restPose(motion.skeleton);
  if (seconds >= 0) sampleClip(motion.clips.back(), seconds, pose);
  return uprightAxis(motion.skeleton, pose);
}

TEST(UprightAxis, PeopleTellTheirUp) {
  for (const Vec3& up : kAxes) {
    const Skeleton person = personAlong(up);
    const std::optional<Vec3> found = uprightAxis(person, restPose(person));
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->isApprox(up, 1e-9)) << found->transpose();
  }
  const Skeleton chain = straightChain(5, 1);
  EXPECT_FALSE(uprightAxis(chain, restPose(chain)));
}

TEST(StandUpright, OneWhoStandsIsLeftAlone) {
  Asset asset = document(practiceHumanoid());
  const Json before = testing::documentJson(asset);
  Warnings warnings;
  EXPECT_TRUE(standUpright(asset, warnings).turn.isApprox(Quat::Identity()));
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(testing::documentJson(asset), before);
}

TEST(StandUpright, DocumentsAreTurned) {
  for (const Vec3& up : kAxes) {
    Asset asset = document(personAlong(up));
    Warnings warnings;
    EXPECT_TRUE(standUpright(asset, warnings).turn.isApprox(Quat::Identity()));
    EXPECT_THAT(kindsOf(warnings), ElementsAre("turned-upright"));
    EXPECT_TRUE(upOf(asset)->isApprox(Vec3::UnitY(), 1e-9)) << up.transpose();
  }
}

TEST(StandUpright, NewClipsStandAsThoseThatAreThere) {
  const Motion motion = motionOf(document(practiceHumanoid(), {standingStill()}));
  for (const Vec3& up : kAxes) {
    Asset asset = document(personAlong(up), {standingStill()});
    const Json before = testing::documentJson(asset);
    Warnings warnings;
    RetargetAssetOptions options;
    options.turn = standUpright(asset, warnings).turn;
    EXPECT_THAT(kindsOf(warnings), ElementsAre("turned-upright"));
    EXPECT_EQ(testing::documentJson(asset), before);
    retargetOnto(asset, Character(asset), motion, options);
    EXPECT_TRUE(upOf(asset)->isApprox(up, 1e-6));
    EXPECT_TRUE(upOf(asset, 0.5)->isApprox(Vec3::UnitY(), 1e-6)) << up.transpose();
  }
}

TEST(StandUpright, SourcesThatLieAtRestMoveOthersUpright) {
  for (const Vec3& up : kAxes) {
    Asset asset = document(practiceHumanoid());
    retargetOnto(asset, Character(asset), motionOf(document(personAlong(up), {standingStill()})), {});
    EXPECT_TRUE(upOf(asset, 0.5)->isApprox(Vec3::UnitY(), 1e-6)) << up.transpose();
  }
}

TEST(StandUpright, TellsWhatMayLie) {
  Warnings warnings;
  warnMaybeLies(Vec3(0.1, 0.99, 0), 0.6, warnings);
  EXPECT_TRUE(warnings.items().empty());
  warnMaybeLies(Vec3::UnitZ(), 0.6, warnings);
  ASSERT_THAT(kindsOf(warnings), ElementsAre("maybe-not-upright"));
  EXPECT_EQ(warnings.items()[0].message, "the model may stand along +Z and lie where +Y is up (60 % sure)");
}

TEST(StandUpright, OnlyWarnsWhereItMayNotTurn) {
  Asset asset = document(personAlong(Vec3::UnitZ()));
  const Json before = testing::documentJson(asset);
  Warnings warnings;
  standUpright(asset, Vec3::UnitZ(), false, warnings);
  ASSERT_THAT(kindsOf(warnings), ElementsAre("not-upright"));
  EXPECT_EQ(warnings.items()[0].message, "the model stands along +Z and lies where +Y is up");
  EXPECT_EQ(testing::documentJson(asset), before);
}

}  // namespace
}  // namespace limber
