#include "limber/session/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

const Ray kRay{{0.1, 0.2, 3}, {0.25, -0.125, -1}};

// One of each kind, no field at its default.
std::vector<Command> oneOfEach() {
  return {OpenSample{"biped", true},
          OpenFile{"models/fox.glb", true},
          SetHandles{37},
          ChooseMethods{"other", "another"},
          PinJoint{"leftHand", {0.5, 1, -0.25}},
          UnpinJoint{"leftHand"},
          BeginDrag{"hand.L", DragMode::kTurn, kRay, {0, 0.5, -1}, {"head", "foot.R"}, true},
          UpdateDrag{kRay, {1, 0, -1}, true},
          TurnDrag{{0, 2, 1}, -35.5},
          ScaleDrag{1.25},
          MoveDrag{{0.1, 0, -0.25}, {0, 30, 0.5}},
          EndDrag{true},
          CancelDrag{},
          SetIk{false, "fabrik"},
          SetTarget{"foot.R", {1e-17, 2, 3}, {"foot.L"}},
          ClearTarget{"foot.R", {"foot.L"}},
          SetLimits{R"({"limber_limits": 1, "joints": {}})"},
          ResetJoint{"head", {"hips"}},
          ResetPose{},
          MirrorPose{MirrorFrom::kRight},
          SetRestPose{},
          RenameJoint{"head", "skull"},
          AddMotion{"motions/walk.bvh", true},
          AddSampleMotion{"walk", true},
          RetargetMotion{"walk", "fast", "aligned", R"({"matches": []})", 0.25, false},
          SetContact{"LeftFoot", 0.25, 0.5, ContactChange::kFound},
          AddClip{"wave"},
          RemoveClip{"wave"},
          RenameClip{"wave", "hello"},
          ChooseClip{"walk"},
          SetTime{1.0 / 3},
          SetKey{},
          EditKeys{{{"Knee", 0.5}, {"Elbow", 0.25}}, 0.5, 2, 0.25, true},
          DeleteKeys{{{"Knee", 0.5}}},
          SetJointKey{"Knee", 0.5, {0, 30, 0}, {0, 0.1, 0}},
          SetInterpolation{Interpolation::kCubic},
          SetTangents{{{"Knee", 0.5}}, KeyTangents::kFree, {0, 90, 0}, {0.5, 0, 0}},
          PasteKeys{{{R"({"limber_pose": 1})", {"Knee", "Elbow"}, 0.75}}},
          PaintWeights{"head", PaintMode::kReplace, 0.75, 0.2, true, {{7, 0.25, 0.5}, {8, 0, 1}}},
          LockWeights{"head", false, {"hips"}},
          MirrorWeights{MirrorFrom::kRight},
          AddJoint{"head", {0, 2, 0}, "hat"},
          DeleteJoint{"hat"},
          ReparentJoint{"head", "hips"},
          PlaceJoint{"hand.L", {0.5, 1, -0.25}, {"head"}, true, true},
          SetTurn{"hand.L", {30, -20, 1.0 / 3}, {"head"}, true, true},
          SetScale{"hand.L", 1.5, {"head"}, true, true},
          ApplyPose{R"({"limber_pose": 1})", {"head", "hips"}, true},
          ApplyTasks{{"look-at:head=0,1,2", "balance=within"}, true},
          Undo{},
          Redo{},
          AddSample{"stool", true, true},
          AddFile{"props/sword.glb", true, true},
          RemoveMember{"sword"},
          ChooseMember{"fox"},
          RenameMember{"fox", "vixen"},
          PlaceMember{"fox", {1, 0, -2}, {0, 90, 0}, 0.5},
          AttachMember{"sword", "fox", "paw.L", true},
          DetachMember{"sword"},
          SetClock{2.0 / 3},
          SetDeformer{"delta-mush"},
          TransferRig{"hero.glb"},
          RigFromAnimation{12},
          JoinClips{{"walk", "wave"}, 0.5, "both"}};
}

// The only command of that kind in the list.
template <class C>
const C& only(const std::vector<Command>& commands) {
  return std::get<C>(*std::find_if(commands.begin(), commands.end(),
                                   [](const Command& command) { return std::holds_alternative<C>(command); }));
}

TEST(Command, JsonKeepsEveryCommandAndEveryField) {
  const std::vector<Command> commands = oneOfEach();
  ASSERT_EQ(commands.size(), std::variant_size_v<Command>);
  const std::string text = commandsToJson(commands);
  const std::vector<Command> back = commandsFromJson(text);
  ASSERT_EQ(back.size(), commands.size());
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_EQ(back[i].index(), i);
  EXPECT_EQ(commandsToJson(back), text);
  // Against the values themselves, where reading and writing could agree on a mistake.
  EXPECT_EQ(only<PinJoint>(back).position, Vec3(0.5, 1, -0.25));
  EXPECT_EQ(only<BeginDrag>(back).ray.direction, kRay.direction);
  EXPECT_EQ(only<BeginDrag>(back).mode, DragMode::kTurn);
  EXPECT_EQ(only<BeginDrag>(back).with, only<BeginDrag>(commands).with);
  EXPECT_TRUE(only<BeginDrag>(back).mirrored);
  EXPECT_TRUE(only<OpenSample>(back).limbsFollow);
  EXPECT_TRUE(only<OpenFile>(back).limbsFollow);
  EXPECT_EQ(only<TurnDrag>(back).degrees, -35.5);
  EXPECT_EQ(only<ScaleDrag>(back).scale, 1.25);
  EXPECT_EQ(only<MoveDrag>(back).turn, Vec3(0, 30, 0.5));
  EXPECT_EQ(only<SetIk>(back).solver, "fabrik");
  EXPECT_EQ(only<SetDeformer>(back).deformer, "delta-mush");
  EXPECT_EQ(only<SetTarget>(back).position, Vec3(1e-17, 2, 3));
  EXPECT_EQ(only<MirrorPose>(back).from, MirrorFrom::kRight);
  EXPECT_FALSE(only<SetIk>(back).on);
  EXPECT_EQ(only<RenameJoint>(back).name, "skull");
  EXPECT_EQ(only<RetargetMotion>(back).clip, "fast");
  EXPECT_EQ(only<RetargetMotion>(back).reach, 0.25);
  EXPECT_FALSE(only<RetargetMotion>(back).contacts);
  EXPECT_EQ(only<PaintWeights>(back).dabs, only<PaintWeights>(commands).dabs);
  EXPECT_EQ(only<AddJoint>(back).name, "hat");
  EXPECT_EQ(only<ReparentJoint>(back).parent, "hips");
  EXPECT_EQ(only<PlaceJoint>(back).position, Vec3(0.5, 1, -0.25));
  EXPECT_TRUE(only<PlaceJoint>(back).relative);
  EXPECT_EQ(only<SetTurn>(back).turn, Vec3(30, -20, 1.0 / 3));
  EXPECT_TRUE(only<SetTurn>(back).relative);
  EXPECT_EQ(only<SetScale>(back).scale, 1.5);
  EXPECT_EQ(only<SetTurn>(back).with, std::vector<std::string>{"head"});
  EXPECT_TRUE(only<UpdateDrag>(back).snap);
  EXPECT_TRUE(only<EndDrag>(back).goesOn);
  EXPECT_EQ(only<ResetJoint>(back).with, std::vector<std::string>{"hips"});
  EXPECT_EQ(only<PaintWeights>(back).mode, PaintMode::kReplace);
  ASSERT_EQ(only<EditKeys>(back).keys.size(), 2u);
  EXPECT_EQ(only<EditKeys>(back).keys[1].joint, "Elbow");
  EXPECT_EQ(only<EditKeys>(back).keys[1].seconds, 0.25);
  EXPECT_EQ(only<EditKeys>(back).scale, 2);
  EXPECT_EQ(only<DeleteKeys>(back).keys.size(), 1u);
  EXPECT_EQ(only<SetJointKey>(back).turn, Vec3(0, 30, 0));
  EXPECT_EQ(only<SetContact>(back).contact, ContactChange::kFound);
  EXPECT_EQ(only<SetContact>(back).to, 0.5);
  EXPECT_EQ(only<JoinClips>(back).clips, (std::vector<std::string>{"walk", "wave"}));
  EXPECT_EQ(only<JoinClips>(back).seconds, 0.5);
  EXPECT_EQ(only<JoinClips>(back).into, "both");
  EXPECT_TRUE(only<AddMotion>(back).retarget);
  EXPECT_TRUE(only<AddSampleMotion>(back).retarget);
  EXPECT_EQ(only<SetTangents>(back).tangents, KeyTangents::kFree);
  EXPECT_EQ(only<SetTangents>(back).turn, Vec3(0, 90, 0));
  ASSERT_EQ(only<PasteKeys>(back).keys.size(), 1u);
  EXPECT_EQ(only<PasteKeys>(back).keys[0].joints, (std::vector<std::string>{"Knee", "Elbow"}));
  EXPECT_EQ(only<PasteKeys>(back).keys[0].seconds, 0.75);
  EXPECT_TRUE(only<AddFile>(back).asProp);
  EXPECT_EQ(only<RenameMember>(back).name, "vixen");
  EXPECT_EQ(only<PlaceMember>(back).turn, Vec3(0, 90, 0));
  EXPECT_EQ(only<PlaceMember>(back).scale, 0.5);
  EXPECT_EQ(only<AttachMember>(back).to, "fox");
  EXPECT_TRUE(only<AttachMember>(back).snap);
  EXPECT_EQ(only<SetInterpolation>(back).interpolation, Interpolation::kCubic);
}

TEST(Command, FieldsThatAreAbsentKeepTheirDefault) {
  const Command command = commandFromJson(Json{{"do", "begin_drag"}, {"joint", "a"}});
  EXPECT_EQ(std::get<BeginDrag>(command).mode, DragMode::kMove);
  EXPECT_EQ(std::get<BeginDrag>(command).view, Vec3(0, 0, -1));
  EXPECT_FALSE(std::get<UpdateDrag>(commandFromJson(Json{{"do", "update_drag"}})).snap);
  EXPECT_FALSE(std::get<EndDrag>(commandFromJson(Json{{"do", "end_drag"}})).goesOn);
  const Command retarget = commandFromJson(Json{{"do", "retarget"}, {"motion", "walk"}});
  EXPECT_EQ(std::get<RetargetMotion>(retarget).method, "limb-ik");
  EXPECT_TRUE(std::get<RetargetMotion>(retarget).map.empty());
}

TEST(Command, ListsOfOlderVersionsAreRead) {
  const std::vector<Command> old = commandsFromJson(
      R"({"limber_commands": 1, "commands": [{"do": "retarget", "motion": "walk", "method": "online"}]})");
  EXPECT_EQ(only<RetargetMotion>(old).method, "limb-ik") << "a method that there is no more";
}

// As the session did them when it had commands of those names.
TEST(Command, CommandsThatArePartOfOthersByNowAreReadAsThose) {
  const std::vector<Command> read = commandsFromJson(R"({"limber_commands": 2, "commands": [
    {"do": "turn_joint", "joint": "head", "axis": [0, 0, 2], "degrees": -30},
    {"do": "move_joint", "joint": "hips", "offset": [0.1, -0.2, 0.3]},
    {"do": "move_key", "from": 0.5, "to": 0.75},
    {"do": "delete_key", "seconds": 1.5}]})");
  ASSERT_EQ(read.size(), 4u);
  const auto& turned = std::get<SetTurn>(read[0]);
  EXPECT_EQ(turned.joint, "head");
  EXPECT_EQ(turned.turn, Vec3(0, 0, -30));
  EXPECT_TRUE(turned.relative);
  const auto& moved = std::get<PlaceJoint>(read[1]);
  EXPECT_EQ(moved.joint, "hips");
  EXPECT_EQ(moved.position, Vec3(0.1, -0.2, 0.3));
  EXPECT_TRUE(moved.relative);
  const auto& retimed = std::get<EditKeys>(read[2]);
  ASSERT_EQ(retimed.keys.size(), 1u);
  EXPECT_EQ(retimed.keys[0].joint, "") << "all joints";
  EXPECT_EQ(retimed.keys[0].seconds, 0.5);
  EXPECT_EQ(retimed.shift, 0.25);
  EXPECT_EQ(retimed.scale, 1);
  const auto& deleted = std::get<DeleteKeys>(read[3]);
  ASSERT_EQ(deleted.keys.size(), 1u);
  EXPECT_EQ(deleted.keys[0].joint, "");
  EXPECT_EQ(deleted.keys[0].seconds, 1.5);
  EXPECT_EQ(std::get<SetTurn>(commandFromJson(Json{{"do", "turn_joint"}, {"joint", "a"}})).turn, Vec3::Zero());
}

void expectRefused(const char* text, const char* where, const char* why) {
  try {
    commandsFromJson(text);
    ADD_FAILURE() << text << " is taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    EXPECT_THAT(error.where(), HasSubstr(where)) << text;
    EXPECT_THAT(error.what(), HasSubstr(why)) << text;
  }
}

TEST(Command, WhatIsWrongIsNamed) {
  expectRefused("{", "", "");
  expectRefused("{}", "", "no list of commands");
  expectRefused(R"({"limber_commands": 3, "commands": []})", "", "newer version of limber");
  const auto list = [](const char* entry) {
    static std::string text;
    text = std::string(R"({"limber_commands": 1, "commands": [{"do": "undo"}, )") + entry + "]}";
    return text.c_str();
  };
  expectRefused(list("7"), "commands[1]", "object");
  expectRefused(list(R"({"joint": "a"})"), "commands[1]", "no command is called ''");
  expectRefused(list(R"({"do": "fly"})"), "commands[1]", "'fly'");
  expectRefused(list(R"({"do": "undo", "often": 2})"), "commands[1].often", "not part");
  expectRefused(list(R"({"do": "reset_joint"})"), "commands[1]", "\"joint\"");
  expectRefused(list(R"({"do": "turn_joint"})"), "commands[1]", "\"joint\"");
  expectRefused(list(R"({"do": "move_key", "often": 2})"), "commands[1].often", "not part");
  expectRefused(list(R"({"do": "set_handles", "count": -3})"), "commands[1].count", "");
  expectRefused(list(R"({"do": "set_handles", "count": 1e300})"), "commands[1].count", "");
  expectRefused(list(R"({"do": "place_joint", "joint": "a", "position": [1, 2]})"), "commands[1].position", "three");
  expectRefused(list(R"({"do": "mirror_pose", "from": "above"})"), "commands[1].from", "'above'");
  expectRefused(list(R"({"do": "update_drag", "ray": 1})"), "commands[1].ray", "object");
  expectRefused(list(R"({"do": "retarget"})"), "commands[1]", "\"motion\"");
  expectRefused(list(R"({"do": "delete_keys"})"), "commands[1]", "\"keys\"");
  expectRefused(list(R"({"do": "paste_keys", "keys": [{"seconds": 1}]})"), "commands[1].keys[0]", "\"pose\"");
  expectRefused(list(R"({"do": "edit_keys", "keys": [{"joint": "a", "at": 1}]})"), "commands[1].keys[0].at",
                "not part");
  expectRefused(list(R"({"do": "set_interpolation", "interpolation": "wavy"})"), "commands[1].interpolation", "'wavy'");
}

// Each command's line has the fields that it is written with, and no others.
TEST(Commands, TypesNameEveryField) {
  const std::string types = commandTypes();
  for (const Command& command : oneOfEach()) {
    const Json json = commandToJson(command);
    const std::string start = "  | { do: '" + json["do"].get<std::string>() + "'";
    const std::size_t begin = types.find(start);
    ASSERT_NE(begin, std::string::npos) << start;
    const std::string line = types.substr(begin + start.size(), types.find('\n', begin) - begin - start.size());
    std::size_t fields = 0;
    for (const auto& [key, value] : json.items()) {
      if (key == "do") continue;
      ++fields;
      const bool isThere =
          line.find("; " + key + ": ") != std::string::npos || line.find("; " + key + "?: ") != std::string::npos;
      EXPECT_TRUE(isThere) << start << " " << key;
    }
    std::size_t named = 0;
    for (std::size_t at = line.find(": "); at != std::string::npos; at = line.find(": ", at + 1)) ++named;
    EXPECT_EQ(named, fields) << line;
  }
}

}  // namespace
}  // namespace limber
