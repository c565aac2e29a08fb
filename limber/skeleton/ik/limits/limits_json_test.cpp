#include "limber/skeleton/ik/limits/limits_json.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"
#include "source_folder.h"

namespace limber {
namespace {

Skeleton threeJoints() {
  Skeleton skeleton = straightChain(3, 1);
  skeleton.joints[1].rest.rotation = fromRotationVector(Vec3(0.3, 0.2, 0.1));
  return skeleton;
}

std::string fileWith(const std::string& entry) {
  return R"({"limber_limits": 1, "joints": {"joint_01": )" + entry + "}}";
}

TEST(LimitsJson, ReadsWhatItSays) {
  const Skeleton skeleton = threeJoints();
  const JointLimits limits =
      limitsFromJson(fileWith(R"({"type": "hinge", "x": [-10, 90], "stiffness": 0.25})"), skeleton);
  ASSERT_EQ(limits.joints.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<FreeJoint>(limits.joints[0].motion));
  const JointLimit& limit = limits.joints[1];
  EXPECT_DOUBLE_EQ(std::get<Hinge>(limit.motion).x.max, kPi / 2);
  EXPECT_EQ(limit.stiffness, 0.25);
  EXPECT_LT(limitViolation(limit, skeleton.joints[1].rest.rotation), 1e-9) << "neutral is the rest pose";
}

TEST(LimitsJson, EveryTypeComesBack) {
  const Skeleton skeleton = straightChain(10, 1);
  JointLimits limits;
  limits.joints.resize(10);
  ReachCone cone;
  cone.polygon = {Vec3(1, 1, 0), Vec3(0, 1, -1), Vec3(-1, 1, 0.5)};
  const AngleRange r{-0.5, 1.25};
  const JointMotion motions[] = {
      FreeJoint{},  FixedJoint{},        Hinge{r}, Pivot{r},        BallAndSocket{r, r, r}, Condyloid{r, r},
      Saddle{r, r}, SwingTwist{r, r, r}, cone,     PlaneJoint{r, r}};
  for (std::size_t j = 0; j < 10; ++j) {
    limits.joints[j].motion = motions[j];
    limits.joints[j].stiffness = 0.5;
    limits.joints[j].neutral = fromRotationVector(Vec3(0.1, 0.2, 0.1 * static_cast<double>(j)));
    limits.joints[j].axes = fromRotationVector(Vec3(-0.4, 0.1 * static_cast<double>(j), 1));
  }
  const std::string text = limitsToJson(limits, skeleton);
  const JointLimits back = limitsFromJson(text, skeleton);
  for (std::size_t j = 0; j < 10; ++j) {
    EXPECT_EQ(back.joints[j].motion.index(), j);
    for (int i = 0; i < 20; ++i) {
      const Quat local = fromRotationVector(2 * Vec3(std::sin(i), std::sin(2.3 * i), std::sin(4.1 * i)));
      EXPECT_NEAR(limitViolation(back.joints[j], local), limitViolation(limits.joints[j], local), 1e-9);
    }
  }
}

TEST(LimitsJson, HumanoidLimitsComeBack) {
  const Skeleton humanoid = practiceHumanoid();
  const JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  const JointLimits back = limitsFromJson(limitsToJson(limits, humanoid), humanoid);
  for (Index j = 0; j < humanoid.jointCount(); ++j) {
    const Quat local = fromRotationVector(Vec3(std::sin(j), std::sin(2.3 * j), std::sin(4.1 * j)));
    EXPECT_NEAR(limitViolation(back.joints[j], local), limitViolation(limits.joints[j], local), 1e-9);
  }
}

TEST(LimitsJson, BadFilesAreRefusedByEntry) {
  const Skeleton skeleton = threeJoints();
  const auto message = [&](const std::string& text) {
    try {
      limitsFromJson(text, skeleton);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadData);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message("{"), "limits: are not JSON at byte 2");
  EXPECT_EQ(message(R"({"limber_limits": NaN})"), "limits: are not JSON at byte 19");
  EXPECT_EQ(message(R"({"limber_limits": 1, "limber_limits": 1, "joints": {}})"),
            "limits: 'limber_limits' stands twice");
  EXPECT_EQ(message(R"({"limber_limits": 1, "joints": {"joint_01": {"type": "free"}, "joint_01": {"type": "free"}}})"),
            "limits: 'joint_01' stands twice");
  EXPECT_EQ(message(fileWith(R"({"type": "hinge", "x": [0, 10], "x": [0, 20]})")),
            "limits: joint 'joint_01': 'x' stands twice");
  EXPECT_EQ(message(fileWith(R"({"type": "hinge", "x": [0, 1e999]})")), "limits: hold a number that is too large");
  EXPECT_EQ(message("[]"), "limits: have no \"limber_limits\"");
  EXPECT_EQ(message(R"({"limber_limits": 2, "joints": {}})"), "limits: are of a version that is not known");
  EXPECT_EQ(message(R"({"limber_limits": 1})"), "limits: have no \"joints\"");
  EXPECT_EQ(message(R"({"limber_limits": 1, "joints": {"elbow": {"type": "free"}}})"),
            "limits: joint 'elbow': is not in the skeleton");
  for (const char* entry :
       {"3", "{}", R"({"type": 3})", R"({"type": "elbow"})", R"({"type": "hinge"})", R"({"type": "hinge", "x": [1]})",
        R"({"type": "hinge", "x": [1, "2"]})", R"({"type": "hinge", "x": [20, 10]})",
        R"({"type": "hinge", "x": [0, 1, 2]})", R"({"type": "hinge", "x": [0, 10], "y": [0, 1]})",
        R"({"type": "free", "stiffness": 2})", R"({"type": "free", "axes": [0, 0, 0, 2]})",
        R"({"type": "free", "neutral": [0, 0, 1]})", R"({"type": "reach-cone", "twist": [0, 0]})",
        R"({"type": "reach-cone", "twist": [0, 0], "polygon": [[0, 1, 0], [0, 1], 3]})",
        R"({"type": "reach-cone", "twist": [0, 0], "polygon": [[1, 1, 0], [0, 1, 1], [-1, 1, 0]]})"}) {
    const std::string said = message(fileWith(entry));
    EXPECT_TRUE(said.rfind("limits: joint 'joint_01': ", 0) == 0) << entry << said;
  }
}

// The schema lists each type that can be written, so that the two cannot drift apart.
TEST(LimitsJson, TheSchemaKnowsEveryType) {
  std::ifstream file(limber::testing::sourceFolder() / "docs/limits.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(file);
  std::vector<std::string> types;
  for (const auto& one : schema["properties"]["joints"]["additionalProperties"]["oneOf"]) {
    types.push_back(one["properties"]["type"]["const"]);
  }
  EXPECT_EQ(types, (std::vector<std::string>{"free", "fixed", "hinge", "pivot", "ball-and-socket", "condyloid",
                                             "saddle", "swing-twist", "reach-cone", "plane"}));
}

}  // namespace
}  // namespace limber
