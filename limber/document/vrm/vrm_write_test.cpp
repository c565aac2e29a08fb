#include "limber/document/vrm/vrm_write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/turn_scene.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/write.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::avatarOf;
using testing::bonePosition;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::mixamoPerson;
using testing::warningKinds;

const Json& vrmOf(const Asset& asset) {
  return *extensionOf(asset.document, "VRMC_vrm");
}

void expectTPose(const Asset& asset) {
  for (const auto& [side, sign] : {std::pair<std::string, double>("left", 1.0), {"right", -1.0}}) {
    const Vec3 shoulder = bonePosition(asset, side + "UpperArm"), hand = bonePosition(asset, side + "Hand");
    EXPECT_NEAR((hand - shoulder).normalized().x(), sign, 1e-6) << side;
    EXPECT_NEAR((hand - shoulder).norm(), 0.51, 1e-6) << side;  // as long as it was
    const Vec3 hip = bonePosition(asset, side + "UpperLeg"), foot = bonePosition(asset, side + "Foot");
    EXPECT_NEAR((foot - hip).normalized().y(), -1, 1e-6) << side;
    EXPECT_GT(bonePosition(asset, side + "Toes").z(), foot.z()) << side;
  }
}

TEST(MakeVrm, APersonStandsInTPoseOnTheGroundAndItsBonesAreNamed) {
  Asset asset = avatarOf(mixamoPerson());
  makeVrm(asset);
  checkAsset(asset);
  expectTPose(asset);
  EXPECT_EQ(vrmOf(asset)["specVersion"], "1.0");
  EXPECT_EQ(vrmOf(asset)["humanoid"]["humanBones"].size(), 22u);
  EXPECT_THAT(asset.document.extensionsUsed, ElementsAre("VRMC_vrm"));
  // The lowest triangle of a foot is that at its toes' end.
  const SceneGraph graph = readSceneGraph(asset.document);
  double lowest = 1;
  for (const Affine& node : graph.world) lowest = std::min(lowest, node.translation().y());
  EXPECT_NEAR(lowest, 0, 1e-6);
}

TEST(MakeVrm, OneWhoFacesElsewhereIsTurned) {
  Skeleton person = mixamoPerson();
  for (Joint& joint : person.joints) {
    if (!joint.parent) joint.rest = decompose(Affine(testing::turn(Vec3::UnitY(), 90)) * joint.rest.toAffine());
  }
  Asset asset = avatarOf(person);
  makeVrm(asset);
  expectTPose(asset);
}

TEST(MakeVrm, ClipsShowWhatTheyDid) {
  Motion motion;
  motion.name = "hero";
  motion.skeleton = mixamoPerson();
  Clip clip;
  clip.name = "wave";
  const Index arm = motion.skeleton.find("mixamorig:LeftForeArm").value();
  clip.rotations.push_back(
      {arm,
       Interpolation::kLinear,
       {0, 1},
       {Eigen::Quaternionf::Identity(), Eigen::Quaternionf(Eigen::AngleAxisf(1.0f, Vec3f::UnitY()))}});
  motion.clips.push_back(clip);
  Asset asset = avatarOf(motion);
  makeVrm(asset);
  const AssetSkeleton rig = readSkeleton(asset);
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, rig, warnings);
  ASSERT_EQ(clips.size(), 1u);
  for (const double seconds : {0.0, 0.5, 1.0}) {
    Pose before = restPose(motion.skeleton), after = readNodePose(asset, rig);
    sampleClip(clip, seconds, before);
    sampleClip(clips[0], seconds, after);
    const std::vector<Vec3> expected = posePositions(motion.skeleton, before);
    const std::vector<Vec3> shown = posePositions(rig.skeleton, after);
    for (Index j = 0; j < expected.size(); ++j) {
      const Index same = rig.skeleton.find(motion.skeleton.joints[j].name).value();
      EXPECT_LT((expected[j] - shown[same]).norm(), 1e-6) << motion.skeleton.joints[j].name << " at " << seconds;
    }
  }
}

// Legs and feet of a rig for inverse kinematics: on a root of their own, and moved there. Its locals are centimetres.
TEST(MakeVrm, LegsThatHangBesideTheBodyHangOnIt) {
  Motion motion;
  motion.name = "hero";
  const Skeleton whole = mixamoPerson();
  const std::vector<Affine> globals = restGlobals(whole);
  Joint root;
  root.name = "Root";
  root.rest.scale = Vec3::Constant(100);
  motion.skeleton.joints.push_back(root);
  for (Index j = 0; j < whole.jointCount(); ++j) {
    Joint joint = whole.joints[j];
    const bool isBeside = joint.name.ends_with("UpLeg") || !joint.parent;
    joint.parent = isBeside ? 0 : *joint.parent + 1;
    if (isBeside) joint.rest = decompose(globals[j]);
    joint.rest.translation /= 100;
    motion.skeleton.joints.push_back(joint);
  }
  Clip clip;
  clip.name = "squat";
  const Index hips = motion.skeleton.find("mixamorig:Hips").value(),
              leg = motion.skeleton.find("mixamorig:LeftUpLeg").value();
  const Vec3f position = motion.skeleton.joints[leg].rest.translation.cast<float>();
  clip.rotations.push_back({hips,
                            Interpolation::kLinear,
                            {0, 1},
                            {Eigen::Quaternionf::Identity(), testing::turn(Vec3(1, 2, 0), 170).cast<float>()}});
  clip.translations.push_back({hips, Interpolation::kLinear, {0, 1}, {Vec3f(0, 0.0095f, 0), Vec3f(0, 0.005f, 0.001f)}});
  clip.translations.push_back({leg, Interpolation::kLinear, {0, 1}, {position, position - Vec3f(0, 0.0045f, 0)}});
  motion.clips.push_back(clip);
  Asset asset = avatarOf(motion);
  makeVrm(asset);
  checkAsset(asset);
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("vrm-meta", "vrm-moved-bones"));
  expectTPose(asset);
  const AssetSkeleton rig = readSkeleton(asset);
  EXPECT_EQ(rig.skeleton.joints[rig.skeleton.find("mixamorig:LeftUpLeg").value()].parent,
            rig.skeleton.find("mixamorig:Hips"));
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, rig, warnings);
  for (const double seconds : {0.0, 0.2917, 0.5, 0.5083, 0.8417, 1.0}) {
    Pose before = restPose(motion.skeleton), after = readNodePose(asset, rig);
    sampleClip(clip, seconds, before);
    sampleClip(clips[0], seconds, after);
    const std::vector<Vec3> expected = posePositions(motion.skeleton, before);
    const std::vector<Vec3> shown = posePositions(rig.skeleton, after);
    for (const Joint& joint : whole.joints) {
      const Index a = motion.skeleton.find(joint.name).value(), b = rig.skeleton.find(joint.name).value();
      EXPECT_LT((expected[a] - shown[b]).norm(), 2e-5) << joint.name << " at " << seconds;
    }
  }
}

TEST(MakeVrm, WhatIsMissingIsNamed) {
  Asset animal = avatarOf(testing::dog().skeleton);
  try {
    makeVrm(animal);
    FAIL() << "a dog is no VRM";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("leftUpperArm"), HasSubstr("an animal"), Not(HasSubstr("limber rig"))));
  }
  const Skeleton whole = mixamoPerson();
  Skeleton handless;
  for (Joint joint : whole.joints) {
    if (joint.name.ends_with("Hand")) continue;
    if (joint.parent) joint.parent = handless.find(whole.joints[*joint.parent].name);
    handless.joints.push_back(joint);
  }
  Asset person = avatarOf(handless);
  try {
    makeVrm(person);
    FAIL() << "hands are missing";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("have: leftHand, rightHand ("), HasSubstr("--replace-rig")));
  }
  Asset bare;
  bare.document.nodes.emplace_back();
  EXPECT_THROW(makeVrm(bare), Error);
}

TEST(MakeVrm, MetaIsMarkedAndNarrow) {
  Asset asset = avatarOf(mixamoPerson());
  makeVrm(asset);
  const Json& meta = vrmOf(asset)["meta"];
  EXPECT_EQ(meta["name"], "hero");
  EXPECT_EQ(meta["authors"], Json::array({"(to be filled in)"}));
  EXPECT_EQ(meta["avatarPermission"], "onlyAuthor");
  EXPECT_EQ(meta["commercialUsage"], "personalNonProfit");
  EXPECT_EQ(meta["modification"], "prohibited");
  EXPECT_EQ(meta["creditNotation"], "required");
  for (const char* flag : {"allowExcessivelyViolentUsage", "allowExcessivelySexualUsage", "allowAntisocialOrHateUsage",
                           "allowPoliticalOrReligiousUsage", "allowRedistribution"}) {
    EXPECT_EQ(meta[flag], false) << flag;
  }
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("vrm-meta"));
}

TEST(MakeVrm, SecondTimeNothingChanges) {
  Asset asset = avatarOf(mixamoPerson());
  VrmMeta meta;
  meta.name = "Hero";
  meta.authors = {"Ada", "Grace"};
  meta.allowed = {"everyone"};
  makeVrm(asset, meta);
  EXPECT_TRUE(asset.warnings.empty());
  const Bytes once = writeGlb(asset);
  makeVrm(asset);
  EXPECT_EQ(writeGlb(asset), once);
  EXPECT_EQ(vrmOf(asset)["meta"]["authors"], Json::array({"Ada", "Grace"}));
  EXPECT_THROW(makeVrm(asset, meta), Error);  // which would allow what the model denies
}

// Lifts a leg, bends an elbow.
void poseAvatar(Asset& asset) {
  const AssetSkeleton rig = readSkeleton(asset);
  Pose pose = readNodePose(asset, rig);
  for (const char* joint : {"mixamorig:RightUpLeg", "mixamorig:LeftForeArm"}) {
    Quat& rotation = pose.locals[rig.skeleton.find(joint).value()].rotation;
    rotation = rotation * testing::turn(Vec3(1, 1, 0).normalized(), 50);
  }
  writeNodePose(asset, rig, pose);
}

TEST(MakeVrm, APosedOneStandsInTPoseAgainAndSaysSo) {
  for (const double degrees : {0.0, 90.0}) {
    Skeleton person = mixamoPerson();
    person.joints[0].rest = decompose(Affine(testing::turn(Vec3::UnitY(), degrees)) * person.joints[0].rest.toAffine());
    Asset asset = avatarOf(person);
    makeVrm(asset);
    const std::vector<Affine> before = readSceneGraph(asset.document).world;
    poseAvatar(asset);
    asset.warnings = {};
    makeVrm(asset);
    expectTPose(asset);
    const std::vector<Affine> after = readSceneGraph(asset.document).world;
    for (std::size_t n = 0; n < before.size(); ++n) {
      EXPECT_LT((after[n].translation() - before[n].translation()).norm(), 1e-6) << asset.document.nodes[n].name;
    }
    EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("vrm-pose"));
  }
}

TEST(MakeVrm, AHeadThatLooksAsideLooksAheadAgain) {
  Asset asset = avatarOf(mixamoPerson());
  makeVrm(asset);
  const AssetSkeleton rig = readSkeleton(asset);
  const Index head = rig.skeleton.find("mixamorig:Head").value();
  const Pose before = readNodePose(asset, rig);
  Pose aside = before;
  aside.locals[head].rotation = before.locals[head].rotation * testing::turn(Vec3::UnitY(), 50);
  writeNodePose(asset, rig, aside);
  asset.warnings = {};
  makeVrm(asset);
  EXPECT_LT(angleBetween(readNodePose(asset, rig).locals[head].rotation, before.locals[head].rotation), 1e-6);
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("vrm-pose"));
}

TEST(MakeVrm, TellsThatItTurnsClipsOfAModelThatFacesElsewhere) {
  Asset asset = avatarOf(testing::inRestPose(mixamoPerson(), {{"mixamorig:Hips", testing::turn(Vec3::UnitY(), 90)}}));
  asset.document.animations.emplace_back();
  makeVrm(asset);
  const auto turned = std::find_if(asset.warnings.items().begin(), asset.warnings.items().end(),
                                   [](const Warning& warning) { return warning.kind == "vrm-turned"; });
  ASSERT_NE(turned, asset.warnings.items().end());
  EXPECT_THAT(turned->message, HasSubstr("by 90 degrees"));
}

TEST(MakeVrm, TellsOfThePoseOfAModelThatNoClipShows) {
  Asset asset = avatarOf(mixamoPerson());
  poseAvatar(asset);
  Asset shown = asset.clone();
  makeVrm(asset);
  expectTPose(asset);
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("vrm-meta", "vrm-pose"));
  Index head = 0;
  while (shown.document.nodes[head].name != "mixamorig:Head") ++head;
  const std::vector<float> still = {0, 0, 0, 1, 0, 0, 0, 1};
  gltf::Animation& clip = shown.document.animations.emplace_back();
  const Index input = addFloatAccessor(shown, std::vector<float>{0, 1}, 1, 0, true);
  clip.samplers.push_back({{}, input, addFloatAccessor(shown, still, 4)});
  clip.channels.push_back({{}, 0, {{}, head, "rotation"}});
  makeVrm(shown);
  EXPECT_THAT(warningKinds(shown.warnings), ElementsAre("vrm-meta"));
}

TEST(MakeVrm, AnewRiggedOneKeepsItsMetaAndGetsNewBones) {
  Asset asset = avatarOf(mixamoPerson());
  changeExtension(asset.document, "VRMC_vrm") = {
      {"meta", {{"name", "Hero"}, {"authors", {"Ada"}}, {"avatarPermission", "everyone"}}},
      {"humanoid", {{"humanBones", Json::object()}}}};
  makeVrm(asset);
  expectTPose(asset);
  EXPECT_EQ(vrmOf(asset)["meta"]["avatarPermission"], "everyone");
}

TEST(MakeVrm, BlendShapesCalledAsExpressionsBecomeSuch) {
  Asset asset = avatarOf(mixamoPerson());
  testing::nameShapes(asset, 0, {"smile", "happy", "Aa", "blinkLeft"});
  makeVrm(asset);
  const Json& preset = vrmOf(asset)["expressions"]["preset"];
  EXPECT_EQ(preset.size(), 2u);
  EXPECT_EQ(preset["happy"]["morphTargetBinds"][0]["index"], 1);
  EXPECT_EQ(preset["blinkLeft"]["morphTargetBinds"][0]["index"], 3);
  const Index node = preset["happy"]["morphTargetBinds"][0]["node"].get<Index>();
  EXPECT_EQ(asset.document.nodes[node].name, "body");
}

}  // namespace
}  // namespace limber
