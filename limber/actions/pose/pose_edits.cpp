#include "limber/actions/pose/pose_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/actions/edit_text.h"
#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/core/text/parse_number.h"
#include "limber/core/text/split_text.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

// Joint names may hold anything but '='; the last one counts, since values hold none.
std::pair<std::string, std::string_view> splitAtEquals(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0) failText(text, "names no joint", "write joint=value");
  return {std::string(text.substr(0, equals)), text.substr(equals + 1)};
}

Vec3 pointOf(std::string_view text, std::string_view value) {
  const std::vector<double> numbers = numbersOf(value, 3);
  if (numbers.empty()) failText(text, "has no point after the '='", "write joint=x,y,z in metres");
  return {numbers[0], numbers[1], numbers[2]};
}

JointReach& reachOf(std::string_view text, const std::string& joint, PoseEdits& edits) {
  for (JointReach& reach : edits.reaches) {
    if (reach.joint == joint) return reach;
  }
  failText(text, "speaks of a joint that reaches for nothing", "give --reach for that joint too");
}

}  // namespace

std::vector<JointTurn> parseTurn(std::string_view text) {
  const auto [joint, value] = splitAtEquals(text);
  std::vector<JointTurn> turns;
  for (const std::string_view word : splitAt(value, ',')) {
    const bool axis = word.size() > 2 && word[0] >= 'x' && word[0] <= 'z' && word[1] == ':';
    const std::optional<double> degrees = axis ? finiteNumber(word.substr(2)) : std::nullopt;
    if (!degrees) failText(text, "has no turn after the '='", "write joint=y:30, an axis and degrees");
    turns.push_back({joint, Vec3::Unit(word[0] - 'x'), *degrees, inQuotes(text)});
  }
  return turns;
}

JointScale parseScale(std::string_view text) {
  const auto [joint, value] = splitAtEquals(text);
  const std::optional<double> factor = finiteNumber(value);
  if (!factor || !(*factor > 0)) failText(text, "has no factor above 0 after the '='", "write joint=1.5");
  return {joint, *factor, inQuotes(text)};
}

JointMove parseMove(std::string_view text) {
  const auto [joint, value] = splitAtEquals(text);
  return {joint, pointOf(text, value), inQuotes(text)};
}

JointReach parseReach(std::string_view text) {
  const auto [joint, value] = splitAtEquals(text);
  return {joint, pointOf(text, value), std::nullopt, std::nullopt, inQuotes(text)};
}

void parsePole(std::string_view text, PoseEdits& edits) {
  const auto [joint, value] = splitAtEquals(text);
  reachOf(text, joint, edits).pole = pointOf(text, value);
}

void parseBase(std::string_view text, PoseEdits& edits) {
  const auto [joint, value] = splitAtEquals(text);
  reachOf(text, joint, edits).base = std::string(value);
}

namespace {

void refuseOtherKeys(const JsonView& object, std::span<const std::string_view> known) {
  object.requireObject();
  object.forEachMember([&](std::string_view key, const JsonView& value) {
    if (std::find(known.begin(), known.end(), key) == known.end()) value.fail("is not part of a pose");
  });
}

std::string requireText(const JsonView& object, std::string_view key) {
  const std::string text(object.text(key));
  if (text.empty()) object.fail(fmt::format("has no \"{}\"", key));
  return text;
}

std::optional<Vec3> pointMember(const JsonView& object, std::string_view key) {
  const JsonView array = object.array(key);
  if (!array.exists()) return std::nullopt;
  if (array.size() != 3) array.fail("is not three numbers");
  return Vec3(array[0].asNumber(), array[1].asNumber(), array[2].asNumber());
}

Vec3 requirePoint(const JsonView& object, std::string_view key) {
  const std::optional<Vec3> point = pointMember(object, key);
  if (!point) object.fail(fmt::format("has no \"{}\"", key));
  return *point;
}

Vec3 requireAxis(const JsonView& object, std::string_view key) {
  const Vec3 axis = requirePoint(object, key);
  if (!(axis.stableNorm() > 0)) object.fail(fmt::format("has an {} of length 0", key));
  return axis.stableNormalized();
}

JointTurn readTurn(const JsonView& entry) {
  refuseOtherKeys(entry, std::array<std::string_view, 3>{"joint", "axis", "degrees"});
  const Vec3 axis = requireAxis(entry, "axis");
  if (!entry.member("degrees").exists()) entry.fail("has no \"degrees\"");
  return {requireText(entry, "joint"), axis, entry.number("degrees", 0), entry.path()};
}

JointMove readMove(const JsonView& entry) {
  refuseOtherKeys(entry, std::array<std::string_view, 2>{"joint", "offset"});
  return {requireText(entry, "joint"), requirePoint(entry, "offset"), entry.path()};
}

JointReach readReach(const JsonView& entry) {
  refuseOtherKeys(entry, std::array<std::string_view, 4>{"joint", "target", "pole", "base"});
  JointReach reach{
      requireText(entry, "joint"), requirePoint(entry, "target"), pointMember(entry, "pole"), {}, entry.path()};
  if (entry.member("base").exists()) reach.base = requireText(entry, "base");
  return reach;
}

TaskKind readKind(const JsonView& entry) {
  const std::string kind = requireText(entry, "kind");
  try {
    return findTaskKind(kind);
  } catch (const Error& error) {
    entry.member("kind").fail(fmt::format("{} ({})", error.message(), error.remedy()));
  }
}

double requireNumber(const JsonView& entry, std::string_view key) {
  if (!entry.member(key).exists()) entry.fail(fmt::format("has no \"{}\"", key));
  return entry.number(key, 0);
}

bool isWord(const JsonView& entry, std::string_view key, std::string_view usual, std::string_view other) {
  const std::string_view word = entry.text(key, usual);
  if (word != usual && word != other) {
    entry.member(key).fail(fmt::format("is neither \"{}\" nor \"{}\"", usual, other));
  }
  return word == other;
}

// What each kind has besides.
void readTaskMembers(const JsonView& entry, TaskEdit& task) {
  const auto onlyThese = [&](std::initializer_list<std::string_view> members) {
    std::vector<std::string_view> known = {"kind", "joint", "weight", "priority"};
    known.insert(known.end(), members.begin(), members.end());
    refuseOtherKeys(entry, known);
  };
  switch (task.kind) {
    case TaskKind::kPosition:
      onlyThese({"target"});
      task.point = requirePoint(entry, "target");
      break;
    case TaskKind::kOrientation:
      onlyThese({"axis", "degrees"});
      task.turn = Eigen::AngleAxisd(requireNumber(entry, "degrees") * kDegree, requireAxis(entry, "axis"));
      break;
    case TaskKind::kLookAt:
      onlyThese({"target", "axis"});
      task.point = requirePoint(entry, "target");
      if (entry.member("axis").exists()) task.axis = requireAxis(entry, "axis");
      break;
    case TaskKind::kDistance:
      onlyThese({"from", "distance"});
      task.amount = requireNumber(entry, "distance");
      if (entry.member("from").exists() && entry.member("from").json().is_string()) {
        task.other = requireText(entry, "from");
      } else {
        task.point = requirePoint(entry, "from");
      }
      break;
    case TaskKind::kPlane:
      onlyThese({"normal", "offset", "side"});
      task.axis = requireAxis(entry, "normal");
      task.amount = requireNumber(entry, "offset");
      task.exact = isWord(entry, "side", "above", "on");
      break;
    case TaskKind::kBalance: {
      onlyThese({"supports", "over"});
      const JsonView supports = entry.array("supports");
      for (std::size_t k = 0; k < supports.size(); ++k) {
        if (!supports[k].json().is_string()) supports[k].fail("is not the name of a joint");
        task.supports.push_back(supports[k].json().get<std::string>());
      }
      task.exact = isWord(entry, "over", "within", "centred");
      break;
    }
    case TaskKind::kKeepOut:
      onlyThese({"from", "to", "radius"});
      task.point = requirePoint(entry, "from");
      task.end = pointMember(entry, "to").value_or(task.point);
      task.amount = requireNumber(entry, "radius");
      break;
    case TaskKind::kCoupling:
      onlyThese({"leader", "ratio"});
      task.other = requireText(entry, "leader");
      task.amount = requireNumber(entry, "ratio");
      break;
  }
}

TaskEdit readTask(const JsonView& entry) {
  entry.requireObject();
  TaskEdit task;
  task.kind = readKind(entry);
  if (task.kind != TaskKind::kBalance) task.joint = requireText(entry, "joint");
  task.weight = entry.number("weight", 1);
  if (!(task.weight > 0)) entry.member("weight").fail("is not above 0");
  task.priority = static_cast<int>(entry.index("priority", kHighestPriority + 1).value_or(0));
  readTaskMembers(entry, task);
  task.where = entry.path();
  return task;
}

JointScale readScale(const JsonView& entry) {
  refuseOtherKeys(entry, std::array<std::string_view, 2>{"joint", "factor"});
  JointScale scale{requireText(entry, "joint"), requireNumber(entry, "factor"), entry.path()};
  if (!(scale.factor > 0)) entry.member("factor").fail("is not above 0");
  return scale;
}

NamedPose readPose(const JsonView& entry) {
  refuseOtherKeys(entry, std::array<std::string_view, 6>{"name", "turn", "scale", "move", "reach", "tasks"});
  NamedPose pose{requireText(entry, "name"), {}};
  const JsonView turns = entry.array("turn"), moves = entry.array("move"), reaches = entry.array("reach");
  for (std::size_t k = 0; k < turns.size(); ++k) pose.edits.turns.push_back(readTurn(turns[k]));
  const JsonView scales = entry.array("scale");
  for (std::size_t k = 0; k < scales.size(); ++k) pose.edits.scales.push_back(readScale(scales[k]));
  for (std::size_t k = 0; k < moves.size(); ++k) pose.edits.moves.push_back(readMove(moves[k]));
  for (std::size_t k = 0; k < reaches.size(); ++k) pose.edits.reaches.push_back(readReach(reaches[k]));
  const JsonView tasks = entry.array("tasks");
  for (std::size_t k = 0; k < tasks.size(); ++k) pose.edits.tasks.push_back(readTask(tasks[k]));
  return pose;
}

std::vector<NamedPose> readPoses(std::string_view json) {
  Warnings warnings;
  const Json document = parseJson(json, warnings);
  const JsonView root(document);
  if (!warnings.empty()) root.fail(warnings.items().front().message);
  refuseOtherKeys(root, std::array<std::string_view, 1>{"poses"});
  const JsonView list = root.array("poses");
  std::vector<NamedPose> poses;
  for (std::size_t i = 0; i < list.size(); ++i) {
    NamedPose pose = readPose(list[i]);
    const auto hasName = [&](const NamedPose& other) { return other.name == pose.name; };
    if (std::any_of(poses.begin(), poses.end(), hasName)) list[i].fail("has the name of a pose before it");
    poses.push_back(std::move(pose));
  }
  if (poses.empty()) root.fail("holds no pose");
  return poses;
}

}  // namespace

std::vector<NamedPose> parsePoses(std::string_view json, std::string_view file) {
  try {
    std::vector<NamedPose> poses = readPoses(json);
    const auto applyTransform = [&](auto& edits) {
      for (auto& edit : edits) edit.where = file.empty() ? edit.where : fmt::format("{}: {}", file, edit.where);
    };
    for (NamedPose& pose : poses) {
      applyTransform(pose.edits.turns), applyTransform(pose.edits.scales), applyTransform(pose.edits.moves),
          applyTransform(pose.edits.reaches), applyTransform(pose.edits.tasks);
    }
    return poses;
  } catch (const Error& error) {
    throw error.within(file);
  }
}

}  // namespace limber
