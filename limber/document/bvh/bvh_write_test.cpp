#include "limber/document/bvh/bvh_write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "limber/core/text/parse_number.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "random_values.h"
#include "shared_data.h"

namespace limber {
namespace {

using testing::randomRotation;

std::string text(const Motion& motion, const BvhWriteOptions& options = {}) {
  const Bytes bytes = writeBvh(motion, options);
  return {bytes.begin(), bytes.end()};
}

// Any rest rotations and scales; tracks for some joints.
Motion randomMotion(unsigned seed, bool scaled) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length(-1, 1), scale(0.5, 2);
  Motion motion;
  motion.name = "made";
  motion.framesPerSecond = 20;
  Clip clip;
  const Index count = 2 + random() % 9;
  for (Index j = 0; j < count; ++j) {
    Joint joint;
    joint.name = fmt::format("joint{}", j);
    if (j > 0 && random() % 8 != 0) joint.parent = random() % j;
    joint.rest.translation = Vec3(length(random), length(random), length(random));
    joint.rest.rotation = randomRotation(random);
    if (scaled) joint.rest.scale = Vec3::Constant(scale(random));
    motion.skeleton.joints.push_back(joint);
    Track<Eigen::Quaternionf> turns;
    turns.joint = j;
    Track<Vec3f> moves;
    moves.joint = j;
    for (int k = 0; k < 30; ++k) {
      turns.times.push_back(static_cast<float>(k * 0.05));
      turns.values.emplace_back(randomRotation(random).cast<float>());
      moves.times.push_back(static_cast<float>(k * 0.05));
      moves.values.emplace_back(Vec3(length(random), length(random), length(random)).cast<float>());
    }
    if (random() % 3 != 0) clip.rotations.push_back(turns);
    if (random() % 3 == 0) clip.translations.push_back(moves);
    if (scaled && random() % 3 == 0) {
      for (Vec3f& value : moves.values) value = Vec3f::Constant(1 + std::abs(value.x()));
      clip.scales.push_back(moves);
    }
  }
  motion.clips.push_back(clip);
  return motion;
}

std::vector<Vec3> positionsAt(const Motion& motion, double seconds, const std::vector<std::string>& names) {
  Pose pose = restPose(motion.skeleton);
  if (!motion.clips.empty()) sampleClip(motion.clips[0], seconds, pose);
  const std::vector<Affine> globals = poseGlobals(motion.skeleton, pose);
  std::vector<Vec3> result;
  for (const std::string& name : names) {
    const std::optional<Index> joint = motion.skeleton.find(name);
    result.push_back(joint ? Vec3(globals[*joint].translation()) : Vec3(Vec3::Constant(1e9)));
  }
  return result;
}

std::vector<std::string> namesOf(const Motion& motion) {
  std::vector<std::string> names;
  for (const Joint& joint : motion.skeleton.joints) names.push_back(joint.name);
  return names;
}

// Relative to how far out the joints are, where that is beyond 1: keys are in single precision.
double largestDistance(const Motion& a, const Motion& b, double rate) {
  const std::vector<std::string> names = namesOf(a);
  double largest = 0;
  for (Index k = 0; k < frameCount(a.clips.at(0), rate); ++k) {
    const std::vector<Vec3> x = positionsAt(a, k / rate, names), y = positionsAt(b, k / rate, names);
    for (std::size_t j = 0; j < x.size(); ++j)
      largest = std::max(largest, (x[j] - y[j]).norm() / std::max(1.0, x[j].norm()));
  }
  return largest;
}

TEST(WriteBvh, KeepsJointPositionsOfAnySkeleton) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Motion motion = randomMotion(seed, seed % 2 == 1);
    const Motion back = readBvh(asBytes(text(motion)), "made.bvh", {1, UpAxis::kY});
    EXPECT_TRUE(back.warnings.empty()) << seed;
    EXPECT_LT(largestDistance(motion, back, 20), 1e-5) << seed;
    EXPECT_DOUBLE_EQ(back.framesPerSecond, 20);
    // The rest pose too: that is what offsets are.
    Motion rest = motion, restBack = back;
    rest.clips.clear();
    restBack.clips.clear();
    const std::vector<Vec3> a = positionsAt(rest, 0, namesOf(motion)), b = positionsAt(restBack, 0, namesOf(motion));
    for (std::size_t j = 0; j < a.size(); ++j) EXPECT_LT((a[j] - b[j]).norm(), 1e-6) << seed;
  }
}

TEST(WriteBvh, WritesTheSameTextAfterReadingItsOwn) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Motion once = readBvh(asBytes(text(randomMotion(seed, false))), "made.bvh", {1, UpAxis::kY});
    const Motion twice = readBvh(asBytes(text(once)), "made.bvh", {1, UpAxis::kY});
    EXPECT_EQ(namesOf(once), namesOf(twice));
    EXPECT_LT(largestDistance(once, twice, 20), 1e-5) << seed;
  }
}

TEST(WriteBvh, TurnsSmoothlyThroughTheStraightAngle) {
  Motion motion;
  motion.skeleton.joints.push_back({"root", std::nullopt, {}, 0});
  Track<Eigen::Quaternionf> track;
  for (int k = 0; k <= 200; ++k) {  // X passes 90 degrees, where Z and Y turn about one axis
    track.times.push_back(static_cast<float>(k) / 100);
    const double angle = k * 0.01 * std::numbers::pi;
    track.values.emplace_back(Eigen::AngleAxisf(static_cast<float>(angle), Vec3f::UnitX()));
  }
  motion.clips.push_back({"turn", {}, {track}, {}});
  motion.framesPerSecond = 100;
  std::vector<double> before;
  const std::string written = text(motion);
  const char* at = written.data() + written.find("Frame Time:");
  at = std::find(at, written.data() + written.size(), '\n') + 1;
  for (int k = 0; k <= 200; ++k) {
    std::vector<double> row(6);
    for (double& value : row) {
      while (*at == ' ' || *at == '\n') ++at;
      value = parseNumber(at, written.data() + written.size()).value();
    }
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT(std::abs(row[i] - before[i]), 2) << k;
    before = row;
  }
  EXPECT_NEAR(before[4], 360, 1e-3);
}

TEST(WriteBvh, KeepsEndSitesAndUnits) {
  const std::string source =
      "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 0 0\n\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
      "Yrotation\n\tJOINT Head\n\t{\n\t\tOFFSET 0 40 0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\tEnd "
      "Site\n\t\t{\n\t\t\tOFFSET 0 20 0\n\t\t}\n\t}\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n1 2 3 10 20 30 40 50 "
      "60\n2 3 "
      "4 11 21 31 41 51 61\n";
  const Motion motion = readBvh(asBytes(source), "a.bvh", {0.01, UpAxis::kY});
  const std::string written = text(motion, {0, 0.01, {}});
  EXPECT_NE(written.find("End Site\n\t\t{\n\t\t\tOFFSET 0 20 0\n"), std::string::npos) << written;
  EXPECT_NE(written.find("Frames: 2\nFrame Time: 0.04\n"), std::string::npos) << written;
  EXPECT_EQ(written.find("Head_end"), std::string::npos);
  EXPECT_EQ(std::count(written.begin(), written.end(), '{'), std::count(written.begin(), written.end(), '}'));
  const Motion back = readBvh(asBytes(written), "a.bvh", {0.01, UpAxis::kY});
  EXPECT_LT(largestDistance(motion, back, 25), 1e-6);
}

TEST(WriteBvh, ALaterClipKeepsItsRate) {
  Motion motion = randomMotion(6, false);
  motion.clips.push_back(resampleClip(motion.clips[0], 50));
  const std::string written = text(motion, {1, 1, {}});
  EXPECT_NE(written.find("Frame Time: 0.02\n"), std::string::npos) << written.substr(written.find("Frame"), 60);
}

TEST(WriteBvh, KeysAreFramesWhereverTheClipBegins) {
  Motion motion = randomMotion(6, false);
  Clip& clip = motion.clips[0];
  clip = resampleClip(clip, 12);
  const auto delay = [](auto& tracks) {
    for (auto& track : tracks) {
      for (float& time : track.times) time += 1.0f / 24;
    }
  };
  delay(clip.translations);
  delay(clip.rotations);
  motion.framesPerSecond = 12;
  const Motion back = readBvh(asBytes(text(motion)), "made.bvh", {1, UpAxis::kY});
  EXPECT_NEAR(back.framesPerSecond, 24, 1e-4);
  EXPECT_LT(largestDistance(motion, back, 24), 1e-5);
}

TEST(WriteBvh, ResamplesOnRequest) {
  Motion motion = randomMotion(6, false);
  const Motion back = readBvh(asBytes(text(motion, {0, 1, 60})), "made.bvh", {1, UpAxis::kY});
  EXPECT_NEAR(back.framesPerSecond, 60, 1e-6);
  EXPECT_EQ(frameCount(back.clips[0], 60), frameCount(motion.clips[0], 60));
  EXPECT_LT(largestDistance(motion, back, 60), 1e-5);
}

TEST(WriteBvh, RefusesWhatABvhCannotSay) {
  Motion motion = randomMotion(1, false);
  EXPECT_THROW(writeBvh(motion, {1, 1, {}}), Error);
  EXPECT_THROW(writeBvh(motion, {0, 0, {}}), Error);
  motion.skeleton.joints[0].name = "a\nb";
  EXPECT_THROW(writeBvh(motion), Error);
  EXPECT_THROW(writeBvh({}), Error);

  Motion far = randomMotion(1, false);  // each joint's position fits a float, but the distance between two does not
  far.skeleton.joints[0].rest.translation = Vec3(3e38, 0, 0);
  far.skeleton.joints[1].rest.translation = Vec3(3e38, 0, 0);
  EXPECT_THROW(writeBvh(far, {0, 1e-3, {}}), Error);
}

TEST(WriteBvh, RefusesMoreFramesThanATextShouldHave) {
  Motion motion = randomMotion(6, false);
  motion.clips[0].name = std::string(1000, 'n');
  const double rate = std::ceil((1 << 24) / (motion.clips[0].duration() * motion.skeleton.jointCount())) + 1;
  try {
    writeBvh(motion, {0, 1, rate});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    EXPECT_EQ(error.where(), "clip '" + std::string(100, 'n') + "...'");
    EXPECT_NE(error.remedy().find("--fps"), std::string::npos);
  }
}

TEST(WriteBvh, WritesADeepChain) {
  Motion motion;
  for (Index j = 0; j < 3000; ++j) {
    Joint joint;
    joint.name = fmt::format("j{}", j);
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = Vec3(0, 1e-3, 0);
    motion.skeleton.joints.push_back(joint);
  }
  motion.clips.emplace_back();
  EXPECT_EQ(readBvh(asBytes(text(motion)), "deep.bvh").skeleton.joints.size(), 3001u);  // and the end site
}

}  // namespace
}  // namespace limber
