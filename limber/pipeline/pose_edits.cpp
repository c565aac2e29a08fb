#include "limber/pipeline/pose_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/core/error.h"
#include "limber/core/parse_number.h"

namespace limber {

namespace {

std::string inQuotes(std::string_view text) {
  return fmt::format("'{}'", text);
}

[[noreturn]] void failText(std::string_view text, std::string message, std::string remedy) {
  throw Error(ErrorCode::kBadArgument, std::move(message), inQuotes(text), std::move(remedy));
}

// Joint names may hold anything but '='; the last one counts, since values hold none.
std::pair<std::string, std::string_view> splitAtEquals(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0) failText(text, "names no joint", "write joint=value");
  return {std::string(text.substr(0, equals)), text.substr(equals + 1)};
}

// The whole of `word` as a finite number.
std::optional<double> numberOf(std::string_view word) {
  const char* at = word.data();
  const char* const end = at + word.size();
  const std::optional<double> value = parseNumber(at, end);
  return value && at == end && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string_view> splitAtCommas(std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t comma = text.find(',');
    words.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return words;
    text.remove_prefix(comma + 1);
  }
}

Vec3 pointOf(std::string_view text, std::string_view value) {
  const std::vector<std::string_view> words = splitAtCommas(value);
  Vec3 point = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = words.size() == 3 ? numberOf(words[i]) : std::nullopt;
    if (!number) failText(text, "has no point after the '='", "write joint=x,y,z in metres");
    point[static_cast<Eigen::Index>(i)] = *number;
  }
  return point;
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
  for (const std::string_view word : splitAtCommas(value)) {
    const bool axis = word.size() > 2 && word[0] >= 'x' && word[0] <= 'z' && word[1] == ':';
    const std::optional<double> degrees = axis ? numberOf(word.substr(2)) : std::nullopt;
    if (!degrees) failText(text, "has no turn after the '='", "write joint=y:30, an axis and degrees");
    turns.push_back({joint, Vec3::Unit(word[0] - 'x'), *degrees, inQuotes(text)});
  }
  return turns;
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

void refuseOtherKeys(const JsonView& object, std::initializer_list<std::string_view> known) {
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

JointTurn readTurn(const JsonView& entry) {
  refuseOtherKeys(entry, {"joint", "axis", "degrees"});
  const Vec3 axis = requirePoint(entry, "axis");
  if (!(axis.stableNorm() > 0)) entry.fail("has an axis of length 0");
  if (!entry.member("degrees").exists()) entry.fail("has no \"degrees\"");
  return {requireText(entry, "joint"), axis.stableNormalized(), entry.number("degrees", 0), entry.path()};
}

JointMove readMove(const JsonView& entry) {
  refuseOtherKeys(entry, {"joint", "offset"});
  return {requireText(entry, "joint"), requirePoint(entry, "offset"), entry.path()};
}

JointReach readReach(const JsonView& entry) {
  refuseOtherKeys(entry, {"joint", "target", "pole", "base"});
  JointReach reach{
      requireText(entry, "joint"), requirePoint(entry, "target"), pointMember(entry, "pole"), {}, entry.path()};
  if (entry.member("base").exists()) reach.base = requireText(entry, "base");
  return reach;
}

NamedPose readPose(const JsonView& entry) {
  refuseOtherKeys(entry, {"name", "turn", "move", "reach"});
  NamedPose pose{requireText(entry, "name"), {}};
  const JsonView turns = entry.array("turn"), moves = entry.array("move"), reaches = entry.array("reach");
  for (std::size_t k = 0; k < turns.size(); ++k) pose.edits.turns.push_back(readTurn(turns[k]));
  for (std::size_t k = 0; k < moves.size(); ++k) pose.edits.moves.push_back(readMove(moves[k]));
  for (std::size_t k = 0; k < reaches.size(); ++k) pose.edits.reaches.push_back(readReach(reaches[k]));
  return pose;
}

std::vector<NamedPose> readPoses(std::string_view json) {
  Warnings warnings;
  const Json document = parseJson(json, warnings);
  const JsonView root(document);
  if (!warnings.empty()) root.fail(warnings.items().front().message);
  refuseOtherKeys(root, {"poses"});
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
    const auto place = [&](auto& edits) {
      for (auto& edit : edits) edit.where = file.empty() ? edit.where : fmt::format("{}: {}", file, edit.where);
    };
    for (NamedPose& pose : poses) place(pose.edits.turns), place(pose.edits.moves), place(pose.edits.reaches);
    return poses;
  } catch (const Error& error) {
    throw error.within(file);
  }
}

}  // namespace limber
