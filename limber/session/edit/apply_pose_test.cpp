#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/pose_file.h"
#include "limber/samples/motions/sample_poses.h"
#include "limber/session/rigged_model.h"
#include "limber/session/session.h"
#include "limber/session/testing/commands.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

void follow(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Session freshly(const char* sample, bool limbsFollow = true) {
  Session session;
  follow(session, OpenSample{sample, limbsFollow});
  return session;
}

// A person with a skeleton whose joints have names, which takes a while to make.
Session personWithNames() {
  static const Session made = [] {
    Session session = freshly("biped");
    follow(session, ChooseMethods{"template", "bone-heat"});
    return session;
  }();
  return made.fork();
}

std::string sampleText(const char* name) {
  return poseToJson(makeSamplePose(name));
}

Vec3 isAt(const Session& session, const std::string& joint) {
  const Skeleton& skeleton = session.state().rig->skeleton();
  return posePositions(skeleton, session.state().pose)[skeleton.find(joint).value()];
}

// The joint of a person's named skeleton, and in the sample pose, as a direction to the next one.
Vec3 directionOf(const std::vector<Vec3>& positions, const Skeleton& skeleton, const char* from, const char* to) {
  return (positions[skeleton.find(to).value()] - positions[skeleton.find(from).value()]).normalized();
}

std::string refusalOf(Session& session, const Command& command) {
  try {
    follow(session, command);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ApplyPose, ComesBackBitForBitOnTheSameSkeleton) {
  for (const char* sample : {"biped", "quadruped", "winged", "stool"}) {
    Session session = freshly(sample);
    const std::string joint = session.state().rig->skeleton().joints.back().name;
    follow(session, testing::turnedBy(joint, {1, 2, 3}, 40));
    follow(session, testing::movedBy(session.state().rig->skeleton().joints[0].name, {0.1, 0.05, -0.2}));
    const Pose posed = session.state().pose;
    const std::string text = session.savePose("mine");
    follow(session, ResetPose{});
    ASSERT_FALSE(samePose(session.state().pose, posed));
    follow(session, ApplyPose{text});
    EXPECT_TRUE(samePose(session.state().pose, posed)) << sample;
    EXPECT_EQ(session.undoName(), "apply_pose");
    follow(session, Undo{});
    EXPECT_TRUE(samePose(session.state().pose, session.state().rig->home)) << sample;
  }
}

TEST(ApplyPose, BonesOfAnotherSkeletonPointAsInThePose) {
  constexpr double kWithin = 12;  // degrees; bodies are not built the same
  Session session = personWithNames();
  const Skeleton& skeleton = session.state().rig->skeleton();
  for (const char* name : {"sit", "kneel", "wave", "cheer", "crouch", "point"}) {
    const PortablePose sample = makeSamplePose(name);
    follow(session, ApplyPose{poseToJson(sample)});
    const std::vector<Vec3> there = posePositions(sample.skeleton, sample.pose),
                            here = posePositions(skeleton, session.state().pose);
    for (const auto& [from, to] :
         {std::pair("leftUpperArm", "leftLowerArm"), std::pair("rightUpperArm", "rightLowerArm"),
          std::pair("rightLowerArm", "rightHand"), std::pair("leftUpperLeg", "leftLowerLeg"),
          std::pair("rightLowerLeg", "rightFoot")}) {
      const double cosine = directionOf(there, sample.skeleton, from, to).dot(directionOf(here, skeleton, from, to));
      EXPECT_LT(std::acos(std::min(1.0, cosine)) / kDegree, kWithin) << name << " " << from;
    }
  }
}

TEST(ApplyPose, ASeatedOrCrouchedBodyKeepsItsFeetOnTheGroundAndWhereTheyStood) {
  Session session = personWithNames();
  follow(session, ApplyPose{sampleText("stand")});
  const Vec3 left = isAt(session, "leftFoot"), right = isAt(session, "rightFoot");
  for (const char* name : {"sit", "crouch", "stand"}) {
    follow(session, ApplyPose{sampleText(name)});
    for (const auto& [foot, before] : {std::pair("leftFoot", left), std::pair("rightFoot", right)}) {
      EXPECT_NEAR(isAt(session, foot).y(), before.y(), 0.06) << name;
    }
    const Vec3 middle = 0.5 * (isAt(session, "leftFoot") + isAt(session, "rightFoot") - left - right);
    EXPECT_LT(std::hypot(middle.x(), middle.z()), 1e-6) << name;
  }
  follow(session, ApplyPose{sampleText("jump")});
  EXPECT_GT(std::min(isAt(session, "leftToes").y(), isAt(session, "rightToes").y()), 0.15);
}

TEST(ApplyPose, WhereTheBodyWasMovedItStays) {
  Session session = personWithNames();
  follow(session, SetIk{false, "whole-body"});
  follow(session, testing::movedBy(session.state().rig->skeleton().joints[0].name, {1.5, 0, -0.5}));
  const Vec3 before = 0.5 * (isAt(session, "leftFoot") + isAt(session, "rightFoot"));
  follow(session, ApplyPose{sampleText("wave")});
  const Vec3 after = 0.5 * (isAt(session, "leftFoot") + isAt(session, "rightFoot"));
  EXPECT_NEAR(after.x(), before.x(), 1e-6);
  EXPECT_NEAR(after.z(), before.z(), 1e-6);
}

TEST(ApplyPose, AnimalsTakeThoseOfAnimals) {
  for (const char* sample : {"quadruped", "winged"}) {
    Session session = freshly(sample);
    follow(session, ApplyPose{sampleText("animal-howl")});
    EXPECT_FALSE(samePose(session.state().pose, session.state().rig->home)) << sample;
  }
}

TEST(ApplyPose, AnotherKindOfBodyIsRefusedAndNothingChanges) {
  Session session = freshly("biped"), stool = freshly("stool");
  const Pose before = session.state().pose;
  const std::size_t recorded = session.record().size();
  EXPECT_THAT(refusalOf(session, ApplyPose{sampleText("animal-sit")}), HasSubstr("another kind of body"));
  EXPECT_THAT(refusalOf(session, ApplyPose{"{}"}), HasSubstr("no pose that limber knows"));
  EXPECT_THAT(refusalOf(session, ApplyPose{sampleText("sit"), {"no joint"}}), HasSubstr("no joint is called"));
  EXPECT_THAT(refusalOf(stool, ApplyPose{sampleText("sit")}), ::testing::Not(""));
  EXPECT_TRUE(samePose(session.state().pose, before));
  EXPECT_EQ(session.record().size(), recorded);
  EXPECT_FALSE(session.canUndo());
}

TEST(ApplyPose, PinsGoWhereThePoseHasThemAndLiftedFeetAreLetGo) {
  Session session = personWithNames();
  follow(session, SetTarget{"leftHand", isAt(session, "leftHand")});
  ASSERT_EQ(session.state().targets.size(), 3u);
  follow(session, ApplyPose{sampleText("sit")});
  ASSERT_EQ(session.state().targets.size(), 3u);
  const auto expectPinned = [&] {
    const std::vector<Vec3> positions = posePositions(session.state().rig->skeleton(), session.state().pose);
    for (const PinnedTarget& target : session.state().targets) {
      EXPECT_LT((target.position - positions[target.joint]).norm(), 1e-9);
    }
  };
  expectPinned();
  follow(session, ApplyPose{sampleText("jump")});
  EXPECT_EQ(session.state().targets.size(), 1u);
  expectPinned();
  // What holds does not pull the pose back.
  const Pose posed = session.state().pose;
  follow(session, testing::turnedBy("head", {0, 1, 0}, 0));
  for (std::size_t j = 0; j < posed.locals.size(); ++j) {
    EXPECT_LT(posed.locals[j].rotation.angularDistance(session.state().pose.locals[j].rotation), 0.01) << j;
  }
}

TEST(ApplyPose, OnJointsThatAreNamedAloneAndMirrored) {
  Session session = personWithNames();
  const Pose before = session.state().pose;
  const Skeleton& skeleton = session.state().rig->skeleton();
  follow(session, ApplyPose{sampleText("wave"), {"rightUpperArm", "rightLowerArm"}});
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const bool asked = skeleton.joints[j].name == "rightUpperArm" || skeleton.joints[j].name == "rightLowerArm";
    EXPECT_EQ(sameTransform(session.state().pose.locals[j], before.locals[j]), !asked) << skeleton.joints[j].name;
  }
  follow(session, ApplyPose{sampleText("wave"), {}, true});
  EXPECT_GT(isAt(session, "leftHand").y(), isAt(session, "neck").y());
  EXPECT_LT(isAt(session, "rightHand").y(), isAt(session, "leftHand").y() - 0.3);
}

TEST(ApplyPose, IsAPoseOfTheChosenClipsMoment) {
  Session session = personWithNames();
  follow(session, AddClip{"two poses"});
  follow(session, ApplyPose{sampleText("stand")});
  follow(session, SetKey{});
  follow(session, SetTime{1});
  follow(session, ApplyPose{sampleText("crouch")});
  const Pose crouched = session.state().pose;
  follow(session, SetKey{});
  follow(session, SetTime{0});
  follow(session, SetTime{1});
  for (std::size_t j = 0; j < crouched.locals.size(); ++j) {
    EXPECT_LT(crouched.locals[j].rotation.angularDistance(session.state().pose.locals[j].rotation), 1e-5) << j;
  }
}

TEST(ApplyPose, ReplaysToTheSameBytes) {
  Session session = personWithNames();
  follow(session, ApplyPose{sampleText("sit"), {}, true});
  follow(session, ApplyPose{session.savePose("again")});
  follow(session, ApplyPose{sampleText("wave"), {"leftUpperArm"}});
  Session again;
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) follow(again, command);
  EXPECT_EQ(again.saveSession(), session.saveSession());
}

}  // namespace
}  // namespace limber
