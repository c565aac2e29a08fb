#include "limber/actions/pose/pose_edits.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

template <typename Call>
std::string errorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PoseEdits, ATurnHasAxesAndDegrees) {
  const std::vector<JointTurn> turns = parseTurn("head.L=x:-10,z:0.5");
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_EQ(turns[0].joint, "head.L");
  EXPECT_EQ(turns[0].axis, Vec3(1, 0, 0));
  EXPECT_EQ(turns[0].degrees, -10);
  EXPECT_EQ(turns[1].axis, Vec3(0, 0, 1));
}

TEST(PoseEdits, JointNamesMayHoldEqualsSigns) {
  const JointMove move = parseMove("a=b=0,0.1,-2");
  EXPECT_EQ(move.joint, "a=b");
  EXPECT_EQ(move.offset, Vec3(0, 0.1, -2));
}

TEST(PoseEdits, PoleAndBaseBelongToAReach) {
  PoseEdits edits;
  edits.reaches.push_back(parseReach("hand=1,2,3"));
  parsePole("hand=0,0,-1", edits);
  parseBase("hand=chest", edits);
  EXPECT_EQ(*edits.reaches[0].pole, Vec3(0, 0, -1));
  EXPECT_EQ(*edits.reaches[0].base, "chest");
  EXPECT_THAT(errorOf([&] { parsePole("foot=0,0,1", edits); }), HasSubstr("'foot=0,0,1'"));
}

TEST(PoseEdits, WhatCannotBeReadIsQuotedWithTheRightForm) {
  for (const char* text : {"head", "=y:30", "head=", "head=y", "head=w:3", "head=y:x", "head=y:30,", "head=y:nan"}) {
    EXPECT_THAT(errorOf([&] { parseTurn(text); }), HasSubstr(std::string("'") + text + "'")) << text;
  }
  for (const char* text : {"hip=1,2", "hip=1,2,3,4", "hip=1,,3", "hip=1,2,3m", "hip=1,2,inf"}) {
    EXPECT_THAT(errorOf([&] { parseMove(text); }), HasSubstr("joint=x,y,z")) << text;
  }
}

TEST(PoseFile, HoldsNamedPoses) {
  const std::vector<NamedPose> poses = parsePoses(R"({"poses": [
    {"name": "wave", "turn": [{"joint": "head", "axis": [0, 2, 0], "degrees": 30}],
     "reach": [{"joint": "hand", "target": [1, 2, 3], "pole": [0, 0, 1], "base": "chest"}]},
    {"name": "crouch", "scale": [{"joint": "head", "factor": 1.5}], "move": [{"joint": "hips", "offset": [0, -0.1, 0]}]}]})");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].name, "wave");
  EXPECT_EQ(poses[0].edits.turns[0].axis, Vec3(0, 1, 0));
  const auto far =
      parsePoses(R"({"poses": [{"name": "a", "turn": [{"joint": "b", "axis": [0, 1e308, 0], "degrees": 1}]}]})");
  EXPECT_EQ(far[0].edits.turns[0].axis, Vec3(0, 1, 0));
  EXPECT_EQ(*poses[0].edits.reaches[0].base, "chest");
  EXPECT_EQ(poses[1].edits.moves[0].offset, Vec3(0, -0.1, 0));
  EXPECT_EQ(poses[1].edits.scales[0].factor, 1.5);
}

TEST(PoseFile, AScaleIsAboveZero) {
  EXPECT_EQ(parseScale("head=0.5").factor, 0.5);
  for (const char* text : {"head=0", "head=-1", "head=", "head=big", "head=1,2,3", "=2"}) {
    EXPECT_THROW(parseScale(text), Error) << text;
  }
  EXPECT_THROW(parsePoses(R"({"poses": [{"name": "a", "scale": [{"joint": "b", "factor": 0}]}]})"), Error);
  EXPECT_THROW(parsePoses(R"({"poses": [{"name": "a", "scale": [{"joint": "b"}]}]})"), Error);
}

TEST(PoseFile, ErrorsNameTheEntry) {
  const auto errorIn = [](const char* text) { return errorOf([&] { parsePoses(text); }); };
  EXPECT_THAT(errorIn("{"), HasSubstr("JSON"));
  EXPECT_THAT(errorIn("[]"), HasSubstr("object"));
  EXPECT_THAT(errorIn("{}"), HasSubstr("no pose"));
  EXPECT_THAT(errorIn(R"({"poses": [{"turn": []}]})"), HasSubstr("poses[0]"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "turns": []}]})"), HasSubstr("poses[0].turns"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "reach": [{"joint": "b", "target": [1, 2]}]}]})"),
              HasSubstr("poses[0].reach[0].target"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "turn": [{"joint": "b", "axis": [0, 0, 0], "degrees": 1}]}]})"),
              HasSubstr("poses[0].turn[0]"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "move": [{"joint": "b", "offset": [0, "1", 0]}]}]})"),
              HasSubstr("poses[0].move[0].offset[1]"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "move": [{"joint": "b", "offset": [0, null, 0]}]}]})"),
              HasSubstr("poses[0].move[0].offset[1]"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "move": [{"joint": 7, "offset": [0, 0, 0]}]}]})"),
              HasSubstr("poses[0].move[0].joint"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "move": {}}]})"), HasSubstr("poses[0].move"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a"}, {"name": "b"}, {"name": "a"}]})"), HasSubstr("poses[2]"));
  EXPECT_THAT(errorIn(R"({"poses": [{"name": "a", "name": "b"}]})"), HasSubstr("twice"));
  for (const char* number : {"NaN", "Infinity", "1e999"}) {
    const std::string text = fmt::format(
        R"({{"poses": [{{"name": "a", "turn": [{{"joint": "b", "axis": [0, 1, 0], "degrees": {}}}]}}]}})", number);
    EXPECT_THAT(errorIn(text.c_str()), HasSubstr("JSON at byte 8")) << number;
  }
}

TEST(PoseFile, ErrorsAndEditsNameTheFile) {
  EXPECT_THAT(errorOf([] { parsePoses("{", "p.json"); }), HasSubstr("p.json: is not valid JSON at byte 2"));
  EXPECT_THAT(errorOf([] { parsePoses(R"({"poses": [{"name": ""}]})", "p.json"); }), HasSubstr("p.json: poses[0]: "));
  const std::vector<NamedPose> poses = parsePoses(R"({"poses": [{"name": "a",
    "turn": [{"joint": "b", "axis": [0, 1, 0], "degrees": 1}, {"joint": "b", "axis": [1, 0, 0], "degrees": 1}],
    "move": [{"joint": "b", "offset": [0, 0, 0]}], "reach": [{"joint": "b", "target": [0, 0, 0]}]}]})",
                                                  "p.json");
  EXPECT_EQ(poses[0].edits.turns[1].where, "p.json: poses[0].turn[1]");
  EXPECT_EQ(poses[0].edits.moves[0].where, "p.json: poses[0].move[0]");
  EXPECT_EQ(poses[0].edits.reaches[0].where, "p.json: poses[0].reach[0]");
}

}  // namespace
}  // namespace limber
