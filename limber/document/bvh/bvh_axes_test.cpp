#include "limber/document/bvh/bvh_axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include "limber/core/rotation.h"
#include "limber/document/bvh/bvh_read.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Rotations = std::map<std::string, Quat>;

struct TextJoint {
  std::string name, parent;
  Vec3 offset;
};

// A person of 1.7 m in T-pose, +Y up, facing +Z. With `plain` names nothing tells which joint is what.
std::vector<TextJoint> personParts(bool plain = false) {
  std::vector<TextJoint> parts = {{"Hips", "", {0, 0.94, 0}},        {"Spine", "Hips", {0, 0.11, 0}},
                                  {"Chest", "Spine", {0, 0.17, 0}},  {"Neck", "Chest", {0, 0.23, 0}},
                                  {"Head", "Neck", {0, 0.09, 0.01}}, {"Top", "Head", {0, 0.18, 0}}};
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? "Left" : "Right";
    parts.push_back({side + "Shoulder", "Chest", {0.03 * s, 0.18, 0}});
    parts.push_back({side + "UpperArm", side + "Shoulder", {0.14 * s, 0.01, 0}});
    parts.push_back({side + "LowerArm", side + "UpperArm", {0.28 * s, 0, 0}});
    parts.push_back({side + "Hand", side + "LowerArm", {0.25 * s, 0, 0}});
    for (int finger = 0; finger < 3; ++finger) {
      parts.push_back({fmt::format("{}Finger{}", side, finger), side + "Hand", {0.15 * s, 0, 0.02 * finger}});
    }
    parts.push_back({side + "UpperLeg", "Hips", {0.09 * s, -0.04, 0}});
    parts.push_back({side + "LowerLeg", side + "UpperLeg", {0, -0.41, 0}});
    parts.push_back({side + "Foot", side + "LowerLeg", {0, -0.4, 0}});
    parts.push_back({side + "Toes", side + "Foot", {0, -0.065, 0.12}});
  }
  if (!plain) return parts;
  std::map<std::string, std::string> names = {{"", ""}};
  for (const TextJoint& part : parts) names.emplace(part.name, fmt::format("joint_{}", names.size()));
  for (TextJoint& part : parts) {
    part.name = names.at(part.name);
    part.parent = names.at(part.parent);
  }
  return parts;
}

std::vector<BvhJoint> bvhJoints(const std::vector<TextJoint>& parts) {
  std::vector<BvhJoint> joints;
  for (const TextJoint& part : parts) {
    BvhJoint joint;
    joint.name = part.name;
    joint.offset = part.offset;
    for (std::size_t p = 0; p < joints.size(); ++p) {
      if (parts[p].name == part.parent) joint.parent = static_cast<Index>(p);
    }
    joints.push_back(joint);
  }
  return joints;
}

// The position of the hips and rotations of joints of one frame; those of the hips are "Hips".
struct TextFrame {
  Vec3 hips = Vec3(0, 0.94, 0);
  Rotations rotations = {};
};

Quat about(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * kPi / 180, axis));
}

TextFrame turned(const Quat& world, TextFrame frame) {
  frame.hips = world * frame.hips;
  Quat& hips = frame.rotations.try_emplace("Hips", Quat::Identity()).first->second;
  hips = world * hips;
  return frame;
}

// A file as a text. `restTurn` turns the offsets alone, as of a skeleton with other axes.
std::string bvh(const std::vector<TextFrame>& frames, bool plain = false, const Quat& restTurn = Quat::Identity()) {
  const std::vector<TextJoint> named = personParts(), parts = personParts(plain);
  std::string text = "HIERARCHY\n";
  std::vector<std::size_t> order;
  const std::function<void(std::size_t)> add = [&](std::size_t p) {
    order.push_back(p);
    const Vec3 offset = restTurn * parts[p].offset;
    text += fmt::format("{} {}\n{{\nOFFSET {:.6f} {:.6f} {:.6f}\nCHANNELS {} Zrotation Yrotation Xrotation\n",
                        p == 0 ? "ROOT" : "JOINT", parts[p].name, offset.x(), offset.y(), offset.z(),
                        p == 0 ? "6 Xposition Yposition Zposition" : "3");
    for (std::size_t c = 0; c < parts.size(); ++c) {
      if (c > 0 && parts[c].parent == parts[p].name) add(c);
    }
    text += "}\n";
  };
  add(0);
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: 0.033333333\n", frames.size());
  for (const TextFrame& frame : frames) {
    text += fmt::format("{:.6f} {:.6f} {:.6f}", frame.hips.x(), frame.hips.y(), frame.hips.z());
    for (const std::size_t p : order) {
      const auto found = frame.rotations.find(named[p].name);
      Quat rotation = found == frame.rotations.end() ? Quat::Identity() : found->second;
      // Global rotations of the two are the same but for the rest pose's axes.
      rotation = p == 0 ? rotation * restTurn.conjugate() : restTurn * rotation * restTurn.conjugate();
      const Vec3 zyx = rotation.toRotationMatrix().eulerAngles(2, 1, 0) * (180 / kPi);
      text += fmt::format(" {:.6f} {:.6f} {:.6f}", zyx[0], zyx[1], zyx[2]);
    }
    text += "\n";
  }
  return text;
}

TextFrame strideAt(int frame, double forwards) {
  const double phase = 2 * kPi * frame / 30, swing = 30 * std::sin(phase);
  const double lowest = 0.875 * std::cos(std::abs(swing) * kPi / 180);
  return {{0, 0.065 + lowest, forwards * frame / 30},
          {{"LeftUpperLeg", about(Vec3::UnitX(), -swing)},
           {"RightUpperLeg", about(Vec3::UnitX(), swing)},
           {"LeftUpperArm", about(Vec3::UnitZ(), -70)},
           {"RightUpperArm", about(Vec3::UnitZ(), 70)}}};
}

std::vector<TextFrame> walk(double forwards = 1.3, int frames = 90) {
  std::vector<TextFrame> result;
  for (int f = 0; f < frames; ++f) result.push_back(strideAt(f, forwards));
  return result;
}

std::vector<TextFrame> turnedAll(const Quat& world, std::vector<TextFrame> frames) {
  for (TextFrame& frame : frames) frame = turned(world, frame);
  return frames;
}

// On hands and knees or the belly, the head towards +Z, body about level.
std::vector<TextFrame> crawl(int frames = 90) {
  std::vector<TextFrame> result = walk(0, frames);
  for (std::size_t f = 0; f < result.size(); ++f) {
    result[f].hips = Vec3(0, 0.3, 0.02 * static_cast<double>(f));
    result[f].rotations["Hips"] = about(Vec3::UnitX(), 85);
  }
  return result;
}

std::vector<TextFrame> lie(const Vec3& hips, int frames = 60) {
  return std::vector<TextFrame>(static_cast<std::size_t>(frames),
                                TextFrame{hips, {{"Hips", about(Vec3::UnitX(), 90)}}});
}

Motion readText(const std::string& text, std::optional<UpAxis> up = {}) {
  BvhOptions options;
  options.up = up;
  return readBvh(asBytes(text), "test.bvh", options);
}

std::vector<std::string> kindsOf(const Motion& motion) {
  std::vector<std::string> result;
  for (const Warning& warning : motion.warnings.items()) result.push_back(warning.kind);
  return result;
}

// The farthest that joints are apart in any frame.
double farthest(const Motion& a, const Motion& b) {
  double distance = 0;
  for (int f = 0; f < 90; ++f) {
    Pose poseA = restPose(a.skeleton), poseB = restPose(b.skeleton);
    sampleClip(a.clips[0], f / 30.0, poseA);
    sampleClip(b.clips[0], f / 30.0, poseB);
    const std::vector<Vec3> at = posePositions(a.skeleton, poseA), bt = posePositions(b.skeleton, poseB);
    for (std::size_t j = 0; j < at.size(); ++j) distance = std::max(distance, (at[j] - bt[j]).norm());
  }
  return distance;
}

double restDifference(const Motion& a, const Motion& b) {
  const std::vector<Vec3> at = restPositions(a.skeleton), bt = restPositions(b.skeleton);
  double distance = 0;
  for (std::size_t j = 0; j < at.size(); ++j) distance = std::max(distance, (at[j] - bt[j]).norm());
  return distance;
}

const Quat kYToZ = about(Vec3::UnitX(), 90);

TEST(BvhAxes, EndsAreFoundByTheTreeAlone) {
  const std::vector<BvhJoint> joints = bvhJoints(personParts(true));
  EXPECT_FALSE(namedEnds(joints).known());
  const BvhEnds ends = findEnds(joints);
  ASSERT_TRUE(ends.known());
  const std::vector<TextJoint> named = personParts();
  EXPECT_EQ(named[ends.heads.front()].name, "Chest");
  EXPECT_THAT((std::vector{named[ends.feet[0]].name, named[ends.feet[1]].name}),
              ::testing::UnorderedElementsAre("LeftToes", "RightToes"));
}

TEST(BvhAxes, ATreeWithoutArmsOrLegsTellsNothing) {
  std::vector<TextJoint> parts = personParts(true);
  std::vector<BvhJoint> chain = bvhJoints({{"a", "", {0, 1, 0}}, {"b", "a", {0, 1, 0}}, {"c", "b", {0, 1, 0}}});
  EXPECT_FALSE(endsOfTree(chain).known());
  EXPECT_FALSE(endsOfTree({}).known());
  std::vector<BvhJoint> points = bvhJoints(parts);
  for (BvhJoint& joint : points) joint.offset.setZero();
  EXPECT_FALSE(endsOfTree(points).known());
}

TEST(BvhAxes, FramesWithZUpAreTurnedWhereTheRestPoseHasYUp) {
  for (const double heading : {0.0, 90.0, 37.0}) {
    const std::vector<TextFrame> upright = turnedAll(about(Vec3::UnitY(), heading), walk());
    for (const bool plain : {false, true}) {
      const Motion right = readText(bvh(upright, plain)), motion = readText(bvh(turnedAll(kYToZ, upright), plain));
      EXPECT_THAT(kindsOf(right), IsEmpty());
      EXPECT_THAT(kindsOf(motion), ElementsAre("converted-axes"));
      EXPECT_LT(farthest(motion, right), 1e-4) << heading;
      EXPECT_EQ(restDifference(motion, right), 0) << "the rest pose stands already";
      const Motion declared = readText(bvh(turnedAll(kYToZ, upright), plain), UpAxis::kZ);
      EXPECT_LT(farthest(declared, right), 1e-4);
      EXPECT_EQ(restDifference(declared, right), 0);
    }
  }
}

TEST(BvhAxes, AWalkOnTheSpotIsTurnedByTheGroundAtZero) {
  const Motion right = readText(bvh(walk(0))), motion = readText(bvh(turnedAll(kYToZ, walk(0))));
  EXPECT_THAT(kindsOf(motion), ElementsAre("converted-axes"));
  EXPECT_LT(farthest(motion, right), 1e-4);
}

// Its joints' names do not tell that the rest pose has Z up: both are turned.
TEST(BvhAxes, ARestPoseWithZUpIsTurnedAlong) {
  const Motion right = readText(bvh(walk(), true)), motion = readText(bvh(turnedAll(kYToZ, walk()), true, kYToZ));
  EXPECT_THAT(kindsOf(motion), ElementsAre("converted-axes"));
  EXPECT_LT(farthest(motion, right), 1e-4);
  EXPECT_LT(restDifference(motion, right), 1e-5);
}

TEST(BvhAxes, ARestPoseWithZUpIsTurnedAloneWhereTheFramesHaveYUp) {
  const Motion right = readText(bvh(walk())), motion = readText(bvh(walk(), false, kYToZ));
  EXPECT_THAT(kindsOf(motion), ElementsAre("converted-axes"));
  EXPECT_LT(farthest(motion, right), 1e-4);
  EXPECT_LT(restDifference(motion, right), 1e-5);
}

TEST(BvhAxes, WhoLiesOrCrawlsIsNotTurned) {
  const auto after = [](std::vector<TextFrame> first, const std::vector<TextFrame>& then) {
    first.insert(first.end(), then.begin(), then.end());
    return first;
  };
  const std::vector<TextFrame> lies = lie({0, 0.15, 0.3});
  for (const std::vector<TextFrame>& frames :
       {crawl(), after(walk(0, 20), crawl(200)), after(walk(1.3, 15), lies), after(lies, walk(1.3, 15))}) {
    const std::string text = bvh(frames);
    const Motion motion = readText(text);
    EXPECT_THAT(kindsOf(motion), IsEmpty());
    EXPECT_EQ(farthest(motion, readText(text, UpAxis::kY)), 0);
  }
}

TEST(BvhAxes, WhoLiesStillAllTheTimeStaysWithAWarning) {
  const std::string text = bvh(lie({0, 0.15, 0.3}));
  const Motion motion = readText(text);
  EXPECT_THAT(kindsOf(motion), ElementsAre("maybe-z-up"));
  EXPECT_THAT(motion.warnings.items()[0].message, ::testing::HasSubstr("--up z"));
  EXPECT_EQ(farthest(motion, readText(text, UpAxis::kY)), 0);
  EXPECT_THAT(kindsOf(readText(text, UpAxis::kY)), IsEmpty()) << "it was said";
}

TEST(BvhAxes, FramesUpsideDownAreReported) {
  const Motion right = readText(bvh(walk()));
  const std::string text = bvh(turnedAll(about(Vec3::UnitX(), 180), walk()));
  const Motion motion = readText(text);
  EXPECT_THAT(kindsOf(motion), ElementsAre("upside-down"));
  EXPECT_THAT(motion.warnings.items()[0].message, ::testing::HasSubstr("--up=-y"));
  const Motion declared = readText(text, UpAxis::kMinusY);
  EXPECT_THAT(kindsOf(declared), ElementsAre("converted-axes"));
  EXPECT_LT(farthest(declared, right), 1e-4);
  EXPECT_EQ(restDifference(declared, right), 0);
  const Motion fromZ = readText(bvh(turnedAll(about(Vec3::UnitX(), -90), walk())), UpAxis::kMinusZ);
  EXPECT_LT(farthest(fromZ, right), 1e-4);
}

TEST(BvhAxes, AHandstandForPartOfTheClipIsNoReason) {
  std::vector<TextFrame> frames = walk(0, 40);
  for (TextFrame& frame : frames) frame = turned(about(Vec3::UnitZ(), 180), frame);
  const std::vector<TextFrame> standing = walk(0, 10);
  frames.insert(frames.end(), standing.begin(), standing.end());
  EXPECT_THAT(kindsOf(readText(bvh(frames))), IsEmpty());
}

// Hips with a head and two feet, as far from them as these offsets.
std::vector<BvhJoint> fewJoints(const Vec3& head, const Vec3& left, const Vec3& right) {
  std::vector<BvhJoint> joints(5);
  const char* names[] = {"Root", "Hips", "Head", "LeftFoot", "RightFoot"};
  const Vec3 offsets[] = {Vec3::Zero(), Vec3(0, 0, 0.9), head, left, right};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joints[j].name = names[j];
    joints[j].offset = offsets[j];
    if (j > 0) joints[j].parent = j == 1 ? 0 : 1;
  }
  return joints;
}

// As programs write it that zero their joints' axes: the legs are longer than the trunk, to the same side of the hips.
TEST(BvhAxes, ARestPoseAlongOneAxisTellsNothing) {
  EXPECT_TRUE(isUprightAlongZ(fewJoints({0, 0.02, 0.6}, {0.1, 0, -0.8}, {-0.1, 0, -0.8})));
  EXPECT_FALSE(isUprightAlongZ(fewJoints({0, 0.6, 0.02}, {0.1, -0.8, 0}, {-0.1, -0.8, 0})));
  EXPECT_FALSE(isUprightAlongZ(fewJoints({0, 0, -0.6}, {0.1, 0, -0.8}, {-0.1, 0, -0.8})));
  EXPECT_FALSE(isUprightAlongZ(fewJoints({0, 0, 0.9}, {0.1, 0, 0.8}, {-0.1, 0, 0.8})));
  EXPECT_FALSE(isUprightAlongZ(fewJoints({0.6, 0, 0.1}, {0.8, 0, -0.1}, {0.8, 0, -0.1})));
}

// Those of a beast lie before its feet in all frames, too: nothing is to be turned.
TEST(BvhAxes, HeadsThatLieAheadTellNothing) {
  const auto liesAhead = [](const Vec3& head, const Vec3& foot) {
    const std::vector<BvhJoint> joints = fewJoints(head, foot, foot - Vec3(2 * foot.x(), 0, 0));
    return headsLieAhead(joints, namedEnds(joints));
  };
  EXPECT_TRUE(liesAhead({0, 0.2, 0.5}, {0.1, -0.3, -0.6}));
  EXPECT_FALSE(liesAhead({0, 0.6, 0.02}, {0.1, -0.8, 0}));
  EXPECT_FALSE(liesAhead({0, 0.02, 0.6}, {0.1, 0, -0.8}));
  EXPECT_FALSE(liesAhead({0, 0.2, -0.5}, {0.1, -0.3, 0.6}));
}

}  // namespace
}  // namespace limber
