#include "limber/actions/report_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/actions/rig/rig_check_report.h"

namespace limber {
namespace {

TEST(ReportJson, SaysAllInOneCasing) {
  AutoRigReport report;
  report.rigger = "sphere-mesh";
  report.skinning = "bone-heat";
  report.weldedVertices = 7;
  report.removedClips = 2;
  report.stages = {{"weld", 0.25, {}}, {"skin", 0.5, {{"factorise", 0.125, {}}}}};
  report.suggestions = {{12, 0.5}};
  report.bridged = {{"Hair", 30, 20}};
  report.warnings.add("bridged-vertices", "vertices of such pieces", "Hair", 20);
  const Json json = toJson(report);
  EXPECT_EQ(json.at("methods").at("rigger"), "sphere-mesh");
  EXPECT_EQ(json.at("counts").at("welded_vertices"), 7);
  EXPECT_EQ(json.at("counts").at("removed_clips"), 2);
  EXPECT_EQ(json.at("seconds"), 0.75);
  EXPECT_EQ(json.at("stages"), Json::parse(R"([{"name": "weld", "seconds": 0.25},
                            {"name": "skin", "seconds": 0.5, "steps": [{"name": "factorise", "seconds": 0.125}]}])"));
  EXPECT_EQ(json.at("suggestions"), Json::parse(R"([{"handles": 12, "score": 0.5}])"));
  EXPECT_EQ(json.at("bridged"), Json::parse(R"([{"node": "Hair", "vertices": 30, "bridged": 20}])"));
  EXPECT_EQ(json.at("warnings"), Json::parse(R"([{"kind": "bridged-vertices", "message": "vertices of such pieces",
                                                  "where": "Hair", "count": 20}])"));
}

TEST(ReportJson, OfACheckBeforeRigging) {
  RigCheckReport report;
  report.check.kinds = {{"humanoid", 0.75}, {"dinosaur", 0.25}};
  report.check.isSure = true;
  report.check.pose = BodyPose::kHanging;
  report.check.missing = {"rightUpperArm to rightHand"};
  report.check.grownTogether = {{"fore_end.L", "hind_upper.L", 0.125}};
  report.check.doubts = {"head"};
  report.pieces = 2;
  report.innerShellVertices = 30;
  report.hasRig = true;
  report.advice.add("grown-together", "parts move together", "left hand and left thigh");
  report.warnings.add("repeated-faces", "faces left out", {}, 4);
  EXPECT_EQ(toJson(report), Json::parse(R"({
      "kinds": [{"name": "humanoid", "confidence": 0.75}, {"name": "dinosaur", "confidence": 0.25}],
      "sure": true, "pose": "hanging", "missing": ["rightUpperArm to rightHand"],
      "grown_together": [{"parts": ["left hand", "left thigh"], "length": 0.125}],
      "doubts": ["head"], "upright": true, "pieces": 2, "inner_shell_vertices": 30, "has_rig": true,
      "advice": [{"kind": "grown-together", "message": "parts move together", "where": "left hand and left thigh",
                  "count": 1}],
      "warnings": [{"kind": "repeated-faces", "message": "faces left out", "where": "", "count": 4}]})"));
  report.check.pose.reset();
  EXPECT_TRUE(toJson(report).at("pose").is_null());
}

TEST(ReportJson, WithoutARiggerItIsNull) {
  EXPECT_TRUE(toJson(AutoRigReport()).at("methods").at("rigger").is_null());
}

}  // namespace
}  // namespace limber
