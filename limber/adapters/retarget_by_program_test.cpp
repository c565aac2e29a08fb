// Programs of the tests' own that retarget, and get wrong what real ones do.
#include "limber/adapters/retarget_by_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "limber/adapters/handed_motion.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/write.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "temporary_folder.h"
#include "testing/made_body.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::putFile;
using testing::shellAdapter;

constexpr double kRate = 25;
constexpr Index kFrames = 12;

Joint jointOf(const char* name, std::optional<Index> parent, const Vec3& position, const Vec3& axis, double turn) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.rest.translation = position;
  joint.rest.rotation = Quat(Eigen::AngleAxisd(turn, axis.normalized()));
  return joint;
}

// Rest rotations in many joints, a name with a blank, a leaf that becomes an end site, a root of its own.
Skeleton puppet() {
  Skeleton skeleton;
  skeleton.joints = {
      jointOf("hips", {}, {0.1, 0.9, -0.2}, {1, 2, 3}, 0.7), jointOf("chest", 0, {0, 0.4, 0.05}, {0, 1, 0}, -0.4),
      jointOf("Left Arm", 1, {0.3, 0.1, 0}, {1, 0, 1}, 2),   jointOf("hand", 2, {0.25, -0.1, 0.02}, {0, 0, 1}, 1),
      jointOf("finger_end", 3, {0.1, 0, 0}, {1, 0, 0}, 0.3), jointOf("tail", 0, {0, -0.1, -0.3}, {1, 0, 0}, -1.2),
      jointOf("prop", {}, {1, 0, 0}, {0, 1, 0}, 0.2)};
  return skeleton;
}

// Everything but the end turns, the hips and the tail move, too.
Motion puppetMotion(const Skeleton& skeleton) {
  PoseSequence frames;
  frames.frameSeconds = 1 / kRate;
  for (Index f = 0; f < kFrames; ++f) {
    Pose pose = restPose(skeleton);
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (skeleton.joints[j].name == "finger_end") continue;
      const Vec3 axis = Vec3(1 + j, 2 - double(j), 0.5).normalized();
      pose.locals[j].rotation =
          pose.locals[j].rotation * Quat(Eigen::AngleAxisd(0.9 * std::sin(0.5 * (f + 1) + j), axis));
    }
    pose.locals[0].translation += Vec3(0.02 * f, 0.05 * std::sin(f), 0.1);
    if (skeleton.jointCount() > 5) pose.locals[5].translation += Vec3(0.03 * std::sin(f), 0, 0.01 * f);
    frames.poses.push_back(pose);
  }
  Motion motion;
  motion.name = "dance";
  motion.skeleton = skeleton;
  motion.framesPerSecond = kRate;
  motion.clips = {clipOf(skeleton, frames, "dance")};
  return motion;
}

Asset puppetAsset(const Skeleton& skeleton = puppet()) {
  Motion motion;
  motion.name = "puppet";
  motion.skeleton = skeleton;
  Asset asset = motionAsset(motion);
  asset.name = "puppet.glb";
  return asset;
}

Adapter retargetAdapter(const std::string& line) {
  Adapter adapter = shellAdapter(line, AdapterFormat::kBvh);
  adapter.kind = AdapterKind::kRetarget;
  adapter.inputFormat = AdapterFormat::kBvh;
  adapter.outputFile = "output/motion.bvh";
  adapter.steps[0].command = {"/bin/sh", "-c", line, "sh", "{motion}", "{output}", "{skeleton}"};
  return adapter;
}

// Poses of the document's last clip at each frame.
PoseSequence posesIn(const Asset& asset) {
  Warnings warnings;
  const AssetSkeleton skeleton = animatedSkeleton(asset);
  return sampleFrames(skeleton.skeleton, readClips(asset, skeleton, warnings).back(), kRate);
}

void expectSamePoses(const Skeleton& skeleton, const PoseSequence& a, const PoseSequence& b, double tolerance) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t f = 0; f < a.poses.size(); ++f) {
    const std::vector<Affine> one = poseGlobals(skeleton, a.poses[f]), other = poseGlobals(skeleton, b.poses[f]);
    for (std::size_t j = 0; j < one.size(); ++j) {
      EXPECT_LT((one[j].matrix() - other[j].matrix()).cwiseAbs().maxCoeff(), tolerance)
          << "frame " << f << ", " << skeleton.joints[j].name;
    }
  }
}

class RetargetByProgram : public ::testing::Test {
 protected:
  static ProgramClips retarget(Asset& asset, const Motion& motion, const Adapter& adapter,
                               const RetargetAssetOptions& options = {}) {
    Progress progress;
    return retargetByProgram(asset, Character(asset), motion, adapter, options, progress);
  }

  // Copies a prepared file to where the output is expected.
  Adapter copying(const std::string& text) {
    const fs::path file = folder_.path() / "prepared";
    putFile(file, text);
    return retargetAdapter(fmt::format("test -s \"$1\" && test -s \"$3\" && cp '{}' \"$2\"", file.string()));
  }

  // The puppet's own motion as a program would write it.
  static std::string goodText(const Motion& motion = puppetMotion(puppet())) {
    const Bytes bytes = handedMotion(motion, 0, kRate, retargetAdapter(""));
    return {bytes.begin(), bytes.end()};
  }
  static std::string changed(std::string text, const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
    return text;
  }

  static std::string problemOf(const Adapter& adapter) {
    Asset asset = puppetAsset();
    const Bytes before = writeGlb(asset);
    try {
      retarget(asset, puppetMotion(puppet()), adapter);
    } catch (const Error& error) {
      EXPECT_EQ(writeGlb(asset), before);
      const std::string what = error.what();
      EXPECT_THAT(what, ::testing::StartsWith("fake: "));
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what;
    }
    return "no error";
  }

  testing::TemporaryFolder folder_;
};

// A program that gives back the motion that it is given: what it means on the character that made it is known.
TEST_F(RetargetByProgram, ACharactersOwnMotionComesBackAsItWas) {
  Skeleton scaled = puppet();
  scaled.joints[0].rest.scale = Vec3::Constant(0.01);
  scaled.joints[2].rest.scale = Vec3::Constant(3);
  for (const Skeleton& skeleton : {puppet(), scaled}) {
    for (const AdapterUp up : {AdapterUp::kY, AdapterUp::kZ}) {
      for (const double unit : {1.0, 0.01}) {
        Adapter adapter = retargetAdapter("cp \"$1\" \"$2\"");
        adapter.inputUp = adapter.outputUp = up;
        adapter.inputMetresPerUnit = adapter.outputMetresPerUnit = unit;
        const Motion motion = puppetMotion(skeleton);
        Asset asset = puppetAsset(skeleton);
        const ProgramClips made = retarget(asset, motion, adapter);
        ASSERT_EQ(made.clips.size(), 1u);
        EXPECT_EQ(made.clips[0].name, "dance");
        EXPECT_EQ(made.clips[0].frames, kFrames);
        EXPECT_EQ(made.clips[0].framesPerSecond, kRate);
        EXPECT_TRUE(made.warnings.empty());
        expectSamePoses(skeleton, posesIn(asset), sampleFrames(skeleton, motion.clips[0], kRate), 2e-6);
      }
    }
  }
}

TEST_F(RetargetByProgram, ThatIsWhatLimbersOwnCopyGives) {
  Asset byProgram = puppetAsset(), byLimber = puppetAsset();
  retarget(byProgram, puppetMotion(puppet()), retargetAdapter("cp \"$1\" \"$2\""));
  RetargetAssetOptions options;
  options.method = "copy";
  retargetOnto(byLimber, Character(byLimber), puppetMotion(puppet()), options);
  const Skeleton skeleton = animatedSkeleton(byLimber).skeleton;
  PoseSequence own = posesIn(byLimber), programs = posesIn(byProgram);
  // Limber's takes rotations alone below the root.
  for (PoseSequence* frames : {&own, &programs}) {
    for (Pose& pose : frames->poses) pose.locals[5].translation = skeleton.joints[5].rest.translation;
  }
  expectSamePoses(skeleton, own, programs, 2e-6);
}

// The rest pose of a BVH has no rotations: a program that leaves all of them 0 leaves the character at rest.
TEST_F(RetargetByProgram, WithoutRotationsTheCharacterRests) {
  const Skeleton skeleton = puppet();
  Motion motion = puppetMotion(skeleton);
  Clip& clip = motion.clips[0];
  clip.rotations.clear();
  clip.translations.resize(1);
  ASSERT_EQ(clip.translations[0].joint, 0u);
  Asset asset = puppetAsset();
  retarget(asset, puppetMotion(skeleton), copying(goodText(motion)));
  PoseSequence still;
  still.poses.assign(kFrames, restPose(skeleton));
  PoseSequence got = posesIn(asset);
  for (Pose& pose : got.poses) pose.locals[0].translation = skeleton.joints[0].rest.translation;
  expectSamePoses(skeleton, got, still, 2e-6);
}

// A character that lies in rest pose is handed over upright, and so is the result.
TEST_F(RetargetByProgram, ACharacterThatLiesIsHandedOverStanding) {
  const Quat turn(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));
  RetargetAssetOptions options;
  options.turn = turn;
  const Skeleton skeleton = puppet();
  const Motion motion = puppetMotion(skeleton), stood = turnedMotion(motion, turn);
  const Bytes text = handedMotion(stood, 0, kRate, retargetAdapter(""));
  Asset asset = puppetAsset();
  retarget(asset, motion, copying({text.begin(), text.end()}), options);
  expectSamePoses(skeleton, posesIn(asset), sampleFrames(skeleton, stood.clips[0], kRate), 2e-6);
  Asset lying = puppetAsset();
  EXPECT_THROW(retarget(lying, motion, copying(goodText()), options), Error);
}

TEST_F(RetargetByProgram, TheSkeletonIsTheRestPoseInOneFrame) {
  const fs::path copy = folder_.path() / "skeleton.bvh";
  const Adapter adapter = retargetAdapter(fmt::format("cp \"$3\" '{}'; cp \"$1\" \"$2\"", copy.string()));
  Asset asset = puppetAsset();
  retarget(asset, puppetMotion(puppet()), adapter);
  const Motion skeleton = readMotion(copy);
  const std::vector<Vec3> got = restPositions(skeleton.skeleton), own = restPositions(puppet());
  for (const Joint& joint : plainlyNamed(puppet()).joints) {
    if (joint.name == "finger_end") continue;
    const auto j = skeleton.skeleton.find(joint.name);
    ASSERT_TRUE(j) << joint.name;
    EXPECT_LT((got[*j] - own[*plainlyNamed(puppet()).find(joint.name)]).norm(), 1e-6);
  }
  EXPECT_EQ(frameCount(skeleton.clips.at(0), kRate), 1u);
  for (const auto& track : skeleton.clips[0].rotations) EXPECT_LT(track.values[0].vec().norm(), 1e-6f);
}

TEST_F(RetargetByProgram, JointsMayComeInAnotherOrder) {
  const Skeleton skeleton = puppet();
  const Motion motion = puppetMotion(skeleton);
  // New numbers: the prop first, the tail before the chest.
  const std::vector<Index> order = {6, 0, 5, 1, 2, 3, 4};
  Motion other = motion;
  std::vector<Index> numberOf(order.size());
  for (Index n = 0; n < order.size(); ++n) numberOf[order[n]] = n;
  for (Index n = 0; n < order.size(); ++n) {
    other.skeleton.joints[n] = skeleton.joints[order[n]];
    if (auto& parent = other.skeleton.joints[n].parent) parent = numberOf[*parent];
  }
  for (auto& track : other.clips[0].rotations) track.joint = numberOf[track.joint];
  for (auto& track : other.clips[0].translations) track.joint = numberOf[track.joint];
  const std::string text = goodText(other);
  ASSERT_NE(text, goodText());
  Asset asset = puppetAsset();
  EXPECT_TRUE(retarget(asset, motion, copying(text)).warnings.empty());
  expectSamePoses(skeleton, posesIn(asset), sampleFrames(skeleton, motion.clips[0], kRate), 2e-6);
}

TEST_F(RetargetByProgram, AJointUnderAnotherNameStaysAtRestAndIsNamed) {
  const Skeleton skeleton = puppet();
  const Motion motion = puppetMotion(skeleton);
  Asset asset = puppetAsset();
  const ProgramClips made = retarget(asset, motion, copying(changed(goodText(), "JOINT hand", "JOINT paw")));
  ASSERT_EQ(made.warnings.items().size(), 2u);
  EXPECT_EQ(made.warnings.items()[0].kind, "missing-joints");
  EXPECT_EQ(made.warnings.items()[0].count, 1u);
  EXPECT_THAT(made.warnings.items()[0].message, HasSubstr("stay at rest: hand"));
  EXPECT_EQ(made.warnings.items()[1].kind, "unknown-joints");
  EXPECT_THAT(made.warnings.items()[1].message, HasSubstr("passed over: paw"));
  PoseSequence expected = sampleFrames(skeleton, motion.clips[0], kRate);
  for (Pose& pose : expected.poses) pose.locals[3] = skeleton.joints[3].rest;
  expectSamePoses(skeleton, posesIn(asset), expected, 2e-6);
}

// What hangs on a joint that is left out keeps its own direction.
TEST_F(RetargetByProgram, AJointThatIsPassedOverTakesNothingAlong) {
  const Skeleton skeleton = puppet();
  const Motion motion = puppetMotion(skeleton);
  Asset asset = puppetAsset();
  const ProgramClips made = retarget(asset, motion, copying(changed(goodText(), "JOINT chest", "JOINT spine")));
  EXPECT_EQ(made.warnings.items().size(), 2u);
  const PoseSequence got = posesIn(asset), expected = sampleFrames(skeleton, motion.clips[0], kRate);
  for (std::size_t f = 0; f < kFrames; ++f) {
    const Affine a = poseGlobals(skeleton, got.poses[f])[2], b = poseGlobals(skeleton, expected.poses[f])[2];
    EXPECT_LT((a.linear() - b.linear()).norm(), 1e-5);
  }
}

TEST_F(RetargetByProgram, OtherEndSitesAreNoMatter) {
  std::string text = goodText();
  const std::size_t end = text.find("End Site"), offset = text.find("OFFSET", end);
  text.replace(offset, text.find('\n', offset) - offset, "OFFSET 7 7 7");
  Asset asset = puppetAsset();
  EXPECT_TRUE(retarget(asset, puppetMotion(puppet()), copying(text)).warnings.empty());
}

TEST_F(RetargetByProgram, SwappedAxesAndOtherUnitsSaySo) {
  Adapter turned = retargetAdapter("cp \"$1\" \"$2\"");
  turned.inputUp = AdapterUp::kZ;
  EXPECT_THAT(problemOf(turned), AllOf(HasSubstr("the skeleton stands in swapped axes: the character's x, y, z are its "
                                                 "x, z, -y"),
                                       HasSubstr("set \"up\"")));
  Adapter larger = retargetAdapter("cp \"$1\" \"$2\"");
  larger.inputMetresPerUnit = 0.01;
  EXPECT_THAT(problemOf(larger), AllOf(HasSubstr("the skeleton is 100 times as large"), HasSubstr("metres_per_unit")));
  larger.inputUp = AdapterUp::kZ;
  EXPECT_THAT(problemOf(larger), HasSubstr("100 times as large as what was handed over, and in swapped axes"));
}

TEST_F(RetargetByProgram, AnotherSkeletonIsRefused) {
  const auto without = [](const Skeleton& skeleton) { return goodText(puppetMotion(skeleton)); };
  Skeleton longer = puppet();
  longer.joints[3].rest.translation *= 1.5;
  EXPECT_THAT(problemOf(copying(without(longer))), HasSubstr("the joint 'hand' has another offset: "));
  Skeleton hanging = puppet();
  hanging.joints[5].parent = 1;
  EXPECT_THAT(problemOf(copying(without(hanging))), HasSubstr("the joint 'tail' hangs on 'chest' in place of 'hips'"));
  EXPECT_THAT(problemOf(copying(changed(goodText(), "ROOT hips", "ROOT pelvis"))),
              HasSubstr("lacks the character's root, 'hips'"));
  Skeleton foreign = puppet();
  for (Joint& joint : foreign.joints) joint.name = "bone_" + joint.name;
  EXPECT_THAT(problemOf(copying(without(foreign))),
              HasSubstr("none of its joints is one of the character's: bone_hips, bone_chest, bone_Left_Arm"));
}

// As programs do that give end sites channels.
TEST_F(RetargetByProgram, AnEndSiteThatBecameAJointIsNoMatter) {
  Skeleton more = puppet();
  more.joints[4].name = "hand_end";
  more.joints.push_back(jointOf("hand_end_end", 4, {0, 0, 0}, {0, 0, 1}, 0));
  Asset asset = puppetAsset();
  EXPECT_TRUE(retarget(asset, puppetMotion(puppet()), copying(goodText(puppetMotion(more)))).warnings.empty());
}

// A root that only holds a prop may be left out.
TEST_F(RetargetByProgram, ARootOfItsOwnThatIsLeftOutStaysAtRest) {
  Skeleton less = puppet();
  less.joints.pop_back();
  Asset asset = puppetAsset();
  const ProgramClips made = retarget(asset, puppetMotion(puppet()), copying(goodText(puppetMotion(less))));
  ASSERT_EQ(made.warnings.items().size(), 1u);
  EXPECT_THAT(made.warnings.items()[0].message, HasSubstr("stay at rest: prop"));
}

TEST_F(RetargetByProgram, FramesMustBeThoseThatWereGiven) {
  Motion longer = puppetMotion(puppet());
  const auto written = [](const Motion& motion, double rate) {
    const Bytes bytes = handedMotion(motion, 0, rate, retargetAdapter(""));
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_THAT(problemOf(copying(written(longer, 2 * kRate))),
              HasSubstr("its frames last 0.02 s each in place of 0.04"));
  longer.clips[0] = trimClip(longer.clips[0], 0, 6 / kRate);
  EXPECT_THAT(problemOf(copying(written(longer, kRate))), HasSubstr("has 7 frames in place of 12"));
  EXPECT_THAT(problemOf(retargetAdapter("cp \"$3\" \"$2\"")), HasSubstr("nothing moves in it"));
  // Two digits are what many programs write.
  Asset asset = puppetAsset();
  const Adapter rounded = copying(changed(goodText(), "Frame Time: 0.04", "Frame Time: 0.0402"));
  EXPECT_NO_THROW(retarget(asset, puppetMotion(puppet()), rounded));
  expectSamePoses(puppet(), posesIn(asset), sampleFrames(puppet(), puppetMotion(puppet()).clips[0], kRate), 2e-6);
}

// Readers of a BVH cannot detect how long a motionless person rests.
TEST_F(RetargetByProgram, OneWhoStandsStillStandsAsLong) {
  PoseSequence still;
  still.frameSeconds = 1 / kRate;
  still.poses.assign(kFrames, restPose(puppet()));
  Motion motion = puppetMotion(puppet());
  motion.clips[0] = clipOf(puppet(), still, "dance");
  Asset asset = puppetAsset();
  EXPECT_EQ(retarget(asset, motion, retargetAdapter("cp \"$1\" \"$2\"")).clips[0].frames, kFrames);
  expectSamePoses(puppet(), posesIn(asset), still, 2e-6);
}

TEST_F(RetargetByProgram, ADamagedFileIsRefused) {
  std::string text = goodText();
  const std::size_t numbers = text.find('\n', text.find("Frame Time")) + 1;
  std::string nan = text, cut = text;
  nan.replace(numbers, text.find(' ', numbers + 1) - numbers, " nan");
  EXPECT_THAT(problemOf(copying(nan)), HasSubstr("numbers are not finite"));
  cut.resize(text.size() - 10);
  EXPECT_THAT(problemOf(copying(cut)), HasSubstr("motion.bvh"));
  EXPECT_THAT(problemOf(copying(text.substr(0, numbers))), HasSubstr("motion.bvh"));
  EXPECT_THAT(problemOf(copying(text.substr(0, text.find("MOTION")))), HasSubstr("frames are missing"));
  EXPECT_THAT(problemOf(copying(text.substr(0, text.find("CHANNELS")))), HasSubstr("motion.bvh"));
  EXPECT_THAT(problemOf(copying(changed(text, "JOINT tail", "JOINT hand"))), HasSubstr("a name that another has"));
  EXPECT_THAT(problemOf(copying("Traceback (most recent call last):\n")), HasSubstr("motion.bvh: "));
}

TEST_F(RetargetByProgram, AProgramThatFailsSaysSo) {
  EXPECT_THAT(problemOf(retargetAdapter("echo no checkpoint >&2; exit 2")),
              HasSubstr("failed: exit code 2; its last words: no checkpoint"));
  EXPECT_THAT(problemOf(retargetAdapter("kill -SEGV $$")), HasSubstr("crashed: signal 11"));
  EXPECT_THAT(problemOf(retargetAdapter(": > \"$2\"")), HasSubstr("left an empty output/motion.bvh"));
  EXPECT_THAT(problemOf(retargetAdapter("true")), HasSubstr("wrote no output/motion.bvh"));
  Adapter hanging = retargetAdapter("sleep 100");
  hanging.limits.seconds = 0.2;
  EXPECT_THAT(problemOf(hanging), HasSubstr("did not end within 0.2 s"));
}

TEST_F(RetargetByProgram, EachClipIsARunOfItsOwn) {
  Motion motion = puppetMotion(puppet());
  motion.clips.push_back(motion.clips[0]);
  motion.clips[1].name = "again";
  const fs::path runs = folder_.path() / "runs";
  Asset asset = puppetAsset();
  const ProgramClips made =
      retarget(asset, motion, retargetAdapter(fmt::format("echo run >> '{}'; cp \"$1\" \"$2\"", runs.string())));
  ASSERT_EQ(made.clips.size(), 2u);
  EXPECT_EQ(made.clips[0].name, "dance");
  EXPECT_EQ(made.clips[1].name, "again");
  EXPECT_EQ(fs::file_size(runs), 8u);
}

TEST_F(RetargetByProgram, AnotherFrameRateIsHandedOver) {
  RetargetAssetOptions options;
  options.frameRate = 50;
  Asset asset = puppetAsset();
  const ProgramClips made = retarget(asset, puppetMotion(puppet()), retargetAdapter("cp \"$1\" \"$2\""), options);
  EXPECT_EQ(made.clips[0].frames, 2 * kFrames - 1);
  EXPECT_EQ(made.clips[0].framesPerSecond, 50);
}

TEST_F(RetargetByProgram, RefusesWhatCannotBeDone) {
  Asset asset = puppetAsset();
  EXPECT_THROW(retarget(asset, puppetMotion(puppet()), shellAdapter("true")), Error);
  Motion none = puppetMotion(puppet());
  none.clips.clear();
  EXPECT_THROW(retarget(asset, none, retargetAdapter("true")), Error);
  Asset bare = meshAsset(testing::madeBody());
  EXPECT_THROW(retarget(bare, puppetMotion(puppet()), retargetAdapter("true")), Error);
}

TEST(HandedMotion, NamesArePlainAndUnique) {
  Skeleton skeleton;
  for (const char* name : {"a b", "a_b", "", "x{\n}", "センター"}) {
    Joint joint;
    joint.name = name;
    skeleton.joints.push_back(joint);
  }
  std::vector<std::string> names;
  for (const Joint& joint : plainlyNamed(skeleton).joints) names.push_back(joint.name);
  EXPECT_THAT(names, ElementsAre("a_b", "a_b_2", "joint_2", "x___", "センター"));
}

}  // namespace
}  // namespace limber
