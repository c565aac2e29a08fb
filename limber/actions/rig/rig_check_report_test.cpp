#include "limber/actions/rig/rig_check_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/progress.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/rigging/body/testing/capsule_person.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Asset person() {
  return meshAsset(testing::capsulePerson(0.7).mesh);
}

std::string messageOf(const Warnings& advice, std::string_view kind) {
  for (const Warning& one : advice.items()) {
    if (one.kind == kind) return one.message;
  }
  return {};
}

// What a check says of a person, without reading one.
RigCheck checkedPerson() {
  RigCheck check;
  check.kinds = {{"humanoid-fingers", 0.994}};
  check.isSure = true;
  check.pose = BodyPose::kA;
  return check;
}

TEST(RigCheckReport, OfAPersonThatCanBeRigged) {
  const RigCheckReport report = checkRigging(person(), {});
  EXPECT_THAT(report.check.kinds.front().name, StartsWith("humanoid"));
  EXPECT_EQ(report.check.pose, BodyPose::kA);
  EXPECT_FALSE(report.hasRig);
  EXPECT_GT(report.pieces, 1u);  // capsules
  EXPECT_EQ(report.innerShellVertices, 0u);
  for (const char* kind : {"has-rig", "no-template", "unsure-template", "grown-together", "not-upright", "posed"}) {
    EXPECT_EQ(testing::countOf(report.advice, kind), 0u) << kind;
  }
}

TEST(RigCheckReport, ARigOfItsOwnIsAdvisedOnAndLeftOut) {
  Asset rigged = person();
  AutoRigOptions handles;
  handles.rig.handles = 5;
  Progress progress;
  autoRig(rigged, handles, progress);
  const RigCheckReport report = checkRigging(std::move(rigged), {});
  EXPECT_TRUE(report.hasRig);
  ASSERT_FALSE(report.advice.empty());
  EXPECT_EQ(report.advice.items().front().kind, "has-rig");
  EXPECT_THAT(messageOf(report.advice, "has-rig"), HasSubstr("`existing-rig: replace`"));
  EXPECT_EQ(report.check.pose, BodyPose::kA);
}

TEST(RigCheckReport, ALyingModelIsToldToBeRotated) {
  TriMesh lying = testing::capsulePerson().mesh;
  for (Vec3f& p : lying.positions) p = Vec3f(p.x(), -p.z(), p.y());
  AutoRigOptions options;
  options.rig.up = Vec3::UnitZ();
  const RigCheckReport report = checkRigging(meshAsset(lying), options);
  EXPECT_FALSE(report.check.isUpright);
  EXPECT_THAT(messageOf(report.advice, "not-upright"), HasSubstr("`upright`"));
  EXPECT_THAT(summaryOf(report.check), HasSubstr("up axis is not +Y"));
}

TEST(RigCheckReport, ABallGetsHandles) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.49, 0}, {0, 0.51, 0}, 0.49);
  const RigCheckReport report = checkRigging(meshAsset(ball), {});
  EXPECT_THAT(messageOf(report.advice, "no-template"),
              HasSubstr("`template: " + report.check.kinds.front().name + "`"));
  EXPECT_THAT(testing::warningKinds(report.advice), Not(Contains("posed")));
}

TEST(RigCheckReport, TheSummaryIsOneLine) {
  RigCheck check = checkedPerson();
  EXPECT_EQ(summaryOf(check), "humanoid-fingers, 99 % sure, arms lowered (A pose)");
  check.pose.reset();
  EXPECT_EQ(summaryOf(check), "humanoid-fingers, 99 % sure");
  check.pose = BodyPose::kHanging;
  check.grownTogether = {{"fore_end.L", "hind_upper.L", 0.1}};
  check.missing = {"rightUpperArm to rightHand"};
  EXPECT_EQ(summaryOf(check),
            "humanoid-fingers, 99 % sure, arms at the sides - left hand is grown onto the left thigh; "
            "rightUpperArm to rightHand is missing");
  check = {};
  check.kinds = {{"quadruped", 0.12}};
  EXPECT_EQ(summaryOf(check), "like no kind of body (likeliest: quadruped, 12 % sure) - it gets handles");
}

TEST(RigCheckReport, PartsAreCalledAsInTheKindOfBody) {
  RigCheck check = checkedPerson();
  const PartContact contact{"fore_end.R", "trunk", 0.1};
  EXPECT_THAT(describeParts(check, contact), ::testing::ElementsAre("right hand", "trunk"));
  check.kinds = {{"quadruped", 0.9}};
  EXPECT_THAT(describeParts(check, contact), ::testing::ElementsAre("right front foot", "trunk"));
}

// The first line of limber rig.
TEST(RigCheckReport, AutoRigHandsTheCheckOutBeforeItRigs) {
  AutoRigOptions options;
  options.rigger = "template";
  std::vector<std::string> summaries, stagesThen;
  Progress progress;
  options.onCheck = [&](const RigCheck& check) {
    summaries.push_back(summaryOf(check));
    for (const StageTime& stage : progress.stages()) stagesThen.push_back(stage.name);
  };
  Asset asset = person();
  const AutoRigReport report = autoRig(asset, options, progress);
  ASSERT_EQ(summaries.size(), 1u);
  EXPECT_THAT(summaries[0], AllOf(StartsWith(report.matches.front().name), HasSubstr("A pose")));
  EXPECT_THAT(stagesThen, ::testing::ElementsAre("read geometry", "weld"));
  Asset handled = person();
  options.rigger = "prop";
  autoRig(handled, options, progress);
  EXPECT_EQ(summaries.size(), 1u);  // it looks for no limbs
}

}  // namespace
}  // namespace limber
