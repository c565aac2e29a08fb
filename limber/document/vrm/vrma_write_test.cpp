#include "limber/document/vrm/vrma_write.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/document/read.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/vrm/vrm_bones.h"
#include "limber/document/write.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::mixamoPerson;
using testing::turn;

Track<Eigen::Quaternionf> turning(Index joint, const Quat& rest, const Vec3& axis) {
  Track<Eigen::Quaternionf> track;
  track.joint = joint;
  for (int k = 0; k <= 2; ++k) {
    track.times.push_back(static_cast<float>(k) / 2);
    track.values.push_back((rest * turn(axis, 35.0 * k)).cast<float>());
  }
  return track;
}

// A person in A-pose who swings an arm, nods and walks on.
Motion swinging() {
  Motion motion;
  motion.name = "hero";
  motion.skeleton = mixamoPerson();
  Clip clip;
  clip.name = "swing";
  for (const char* name : {"mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:Neck", "mixamorig:Hips"}) {
    const Index joint = motion.skeleton.find(name).value();
    clip.rotations.push_back(turning(joint, motion.skeleton.joints[joint].rest.rotation, Vec3(1, 2, 0.5).normalized()));
  }
  clip.translations.push_back({motion.skeleton.find("mixamorig:Hips").value(),
                               Interpolation::kLinear,
                               {0, 1},
                               {Vec3f(0, 0.95f, 0), Vec3f(0.2f, 0.9f, 1)}});
  motion.clips.push_back(clip);
  return motion;
}

// Whatever its nodes are called.
Motion readBack(Asset animation) {
  for (gltf::Node& node : animation.document.nodes) node.name = "J_" + node.name;
  return motionOf(readAsset(writeGlb(animation), "swing.vrma"));
}

// The joints of the motion for VRMs are where the person's are, as its bones are as long.
TEST(VrmAnimation, BonesAreWhereTheClipHasThem) {
  const Motion motion = swinging();
  Warnings warnings;
  const std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
  const TPose rest = vrmRestPose(motion, bones);
  const Motion back = readBack(vrmAnimation(motion.skeleton, motion.clips[0], rest, bones));
  ASSERT_EQ(back.clips.size(), 1u);
  EXPECT_EQ(back.clips[0].name, "swing");
  EXPECT_EQ(back.skeleton.jointCount(), bones.size());
  for (const double seconds : {0.0, 0.3, 0.5, 1.0}) {
    Pose clip = restPose(motion.skeleton), shown = restPose(back.skeleton);
    sampleClip(motion.clips[0], seconds, clip);
    sampleClip(back.clips[0], seconds, shown);
    const std::vector<Vec3> expected = posePositions(motion.skeleton, clip),
                            positions = posePositions(back.skeleton, shown);
    for (const HumanoidJoint& bone : bones) {
      const Index joint = back.skeleton.find(bone.bone).value();
      EXPECT_LT((positions[joint] - expected[bone.joint]).norm(), 1e-5) << bone.bone << " at " << seconds;
    }
  }
}

TEST(VrmAnimation, SaysHowFarJointsAreWhereLengthsAndScalesChange) {
  Warnings warnings;
  for (const bool isScaled : {false, true}) {
    Motion motion = swinging();
    const std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
    const TPose rest = vrmRestPose(motion, bones);
    EXPECT_TRUE(vrmAnimation(motion.skeleton, motion.clips[0], rest, bones).warnings.items().empty());
    const Index shin = motion.skeleton.find("mixamorig:LeftLeg").value(), hips = 0;
    const Vec3f knee = motion.skeleton.joints[shin].rest.translation.cast<float>();
    if (isScaled) {
      motion.clips[0].scales.push_back({hips, Interpolation::kLinear, {0, 1}, {Vec3f::Zero(), Vec3f::Ones()}});
    } else {
      motion.clips[0].translations.push_back({shin, Interpolation::kLinear, {0, 1}, {knee, knee + Vec3f(0.04f, 0, 0)}});
    }
    const Asset made = vrmAnimation(motion.skeleton, motion.clips[0], rest, bones);
    ASSERT_EQ(testing::warningKinds(made.warnings), std::vector<std::string>{"vrma-lengths"});
    const std::string& text = made.warnings.items()[0].message;
    EXPECT_NE(text.find(isScaled ? "at 0.00 s" : "0.04 m"), std::string::npos) << text;
    EXPECT_EQ(made.warnings.items()[0].where, "swing");
  }
}

TEST(VrmAnimation, RestsInTPoseWithoutRotations) {
  const Motion motion = swinging();
  Warnings warnings;
  const std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
  const Asset animation = vrmAnimation(motion.skeleton, motion.clips[0], vrmRestPose(motion, bones), bones);
  EXPECT_TRUE(animation.document.meshes.empty());
  for (const gltf::Node& node : animation.document.nodes) EXPECT_FALSE(node.rotation) << node.name;
  const Skeleton back = readBack(animation.clone()).skeleton;
  const std::vector<Vec3> positions = restPositions(back);
  const auto at = [&](const char* bone) { return positions[back.find(bone).value()]; };
  EXPECT_NEAR((at("leftHand") - at("leftUpperArm")).normalized().x(), 1, 1e-6);
  EXPECT_NEAR((at("rightFoot") - at("rightUpperLeg")).normalized().y(), -1, 1e-6);
}

TEST(VrmAnimation, LeavesGazeOutAndSaysSo) {
  Motion motion = swinging();
  Joint eye;
  eye.name = "LeftEye";
  eye.parent = motion.skeleton.find("mixamorig:Head");
  eye.rest.translation = {0.03, 0.05, 0.08};
  motion.skeleton.joints.push_back(eye);
  Warnings warnings;
  std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
  std::erase_if(bones, [](const HumanoidJoint& bone) { return bone.bone == "leftEye"; });
  const std::size_t others = bones.size();
  bones.push_back({"leftEye", motion.skeleton.jointCount() - 1});
  motion.clips[0].rotations.push_back(turning(motion.skeleton.jointCount() - 1, Quat::Identity(), Vec3::UnitY()));
  const Track<float> weight{0, Interpolation::kLinear, {0, 1}, {0, 1}};
  const std::vector<ExpressionTrack> expressions = {{"lookUp", true, weight}, {"lookout", false, weight}};
  const Asset made = vrmAnimation(motion.skeleton, motion.clips[0], vrmRestPose(motion, bones), bones, expressions);
  const Json& said = *extensionOf(made.document, "VRMC_vrm_animation");
  EXPECT_EQ(said["humanoid"]["humanBones"].size(), others);
  EXPECT_FALSE(said["humanoid"]["humanBones"].contains("leftEye"));
  EXPECT_FALSE(said["expressions"].contains("preset"));
  EXPECT_TRUE(said["expressions"]["custom"].contains("lookout"));
  ASSERT_EQ(made.warnings.items().size(), 1u);
  EXPECT_EQ(made.warnings.items()[0].kind, "vrma-gaze");
  EXPECT_EQ(made.warnings.items()[0].count, 2u);
}

// What lies between two bones counts with the lower one.
TEST(VrmAnimation, TwistJointsArePartOfTheirBones) {
  Motion motion = swinging();
  motion.skeleton = testing::withJointBefore(motion.skeleton, "mixamorig:LeftForeArm", "LeftArmTwist");
  Clip clip;
  clip.name = "twist";
  const Index twist = motion.skeleton.find("LeftArmTwist").value(),
              hand = motion.skeleton.find("mixamorig:LeftHand").value();
  clip.rotations.push_back(turning(twist, Quat::Identity(), Vec3::UnitY()));
  motion.clips = {clip};
  Warnings warnings;
  const std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
  const Motion back = readBack(vrmAnimation(motion.skeleton, clip, vrmRestPose(motion, bones), bones));
  EXPECT_FALSE(back.skeleton.find("LeftArmTwist"));
  Pose expected = restPose(motion.skeleton), shown = restPose(back.skeleton);
  sampleClip(clip, 1, expected);
  sampleClip(back.clips[0], 1, shown);
  const Index shownHand = back.skeleton.find("leftHand").value(), elbow = back.skeleton.find("leftLowerArm").value();
  const std::vector<Vec3> from = posePositions(motion.skeleton, expected), to = posePositions(back.skeleton, shown);
  const Index forearm = motion.skeleton.find("mixamorig:LeftForeArm").value();
  EXPECT_LT(((from[hand] - from[forearm]) - (to[shownHand] - to[elbow])).norm(), 1e-5);
}

TEST(VrmAnimation, ExpressionsAreReadOffShapesThatMoveAsOne) {
  Asset asset = testing::avatarOf(swinging());
  testing::nameShapes(asset, 0, {"happy", "other", "sad"});
  const std::vector<float> times = {0, 1}, weights = {0, 0.5f, 1, 1, 0.25f, 0};
  gltf::Animation& animation = asset.document.animations[0];
  const Index input = addFloatAccessor(asset, times, 1, 0, true), output = addFloatAccessor(asset, weights, 1);
  Index body = 0;
  for (Index n = 0; n < asset.document.nodeCount(); ++n) body = asset.document.nodes[n].mesh ? n : body;
  const Index sampler = addElement(animation.samplers, {{}, input, output});
  animation.channels.push_back({{}, sampler, {{}, body, "weights"}});
  const std::vector<ExpressionTrack> tracks = expressionTracks(asset, 0);
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].name, "happy");
  EXPECT_THAT(tracks[0].weight.values, ::testing::ElementsAre(0, 1));
  EXPECT_THAT(tracks[1].weight.values, ::testing::ElementsAre(1, 0));

  const Motion motion = swinging();
  Warnings warnings;
  const std::vector<HumanoidJoint> bones = vrmBones(motion.skeleton, motion.name, warnings);
  const Asset made = vrmAnimation(motion.skeleton, motion.clips[0], vrmRestPose(motion, bones), bones, tracks);
  const Json& expressions = extensionOf(made.document, "VRMC_vrm_animation")->at("expressions").at("preset");
  EXPECT_EQ(made.document.nodes[expressions["sad"]["node"].get<Index>()].name, "sad");
  EXPECT_EQ(readBack(made.clone()).skeleton.jointCount(), bones.size());  // they are no joints
}

}  // namespace
}  // namespace limber
