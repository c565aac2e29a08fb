#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "limber/character/matching/skeleton_map.h"
#include "limber/core/error.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view byName(MatchedBy by) {
  return by == MatchedBy::kName ? "name" : by == MatchedBy::kShape ? "shape" : "file";
}

Json namesOf(const std::vector<Index>& joints, const Skeleton& skeleton) {
  Json names = Json::array();
  for (const Index joint : joints) names.push_back(skeleton.joints[joint].name);
  return names;
}

std::vector<Index> jointsOf(const Json& match, const char* key, const Skeleton& skeleton, const std::string& where) {
  const auto list = match.find(key);
  if (list == match.end() || !list->is_array()) {
    throw Error(ErrorCode::kBadData, fmt::format("'{}' is no list of joint names", key), where);
  }
  std::vector<Index> joints;
  for (const Json& name : *list) {
    if (!name.is_string())
      throw Error(ErrorCode::kBadData, fmt::format("'{}' holds something else than names", key), where);
    const std::optional<Index> joint = skeleton.find(name.get_ref<const std::string&>());
    if (!joint) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("'{}' names the joint '{}', which is not there", key, name.get_ref<const std::string&>()),
                  where, "limber info lists the joints of a file");
    }
    joints.push_back(*joint);
  }
  return joints;
}

bool flagOf(const Json& json, const char* key) {
  const auto flag = json.find(key);
  if (flag == json.end()) return false;
  if (!flag->is_boolean()) throw Error(ErrorCode::kBadData, "is neither true nor false", key);
  return flag->get<bool>();
}

}  // namespace

std::string skeletonMapToJson(const SkeletonMap& map, const Skeleton& source, const Skeleton& target) {
  Json matches = Json::array();
  for (const JointMatch& match : map.matches) {
    matches.push_back({{"part", nameOf(match, target)},
                       {"source", namesOf(match.source, source)},
                       {"target", namesOf(match.target, target)},
                       {"confidence", match.confidence},
                       {"by", byName(match.by)}});
  }
  Json left = Json::array();
  for (const UnmatchedPart& part : map.left) {
    left.push_back({{"part", nameOf(part.part)},
                    {"of", part.ofTarget ? "target" : "source"},
                    {"joints", namesOf(part.joints, part.ofTarget ? target : source)},
                    {"meanwhile", !part.ofTarget ? "moves nothing"
                                  : part.carrier ? "follows " + nameOf(*part.carrier)
                                                 : "rests"}});
  }
  Json json = {{"matches", std::move(matches)}};
  if (map.jointByJoint) json["joint_by_joint"] = true;
  if (map.unlikeBodies) json["unlike_bodies"] = true;
  if (!left.empty()) json["unmatched"] = std::move(left);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

SkeletonMap skeletonMapFromJson(std::string_view text, const Skeleton& source, const Skeleton& target) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw Error(ErrorCode::kBadData, "is no JSON");
  const auto list = json.is_object() ? json.find("matches") : json.end();
  if (!json.is_object() || list == json.end() || !list->is_array()) {
    throw Error(ErrorCode::kBadData, "has no list 'matches'", "", "docs/skeleton_map.schema.json tells the form");
  }
  SkeletonMap map;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string where = fmt::format("matches[{}]", i);
    const Json& entry = (*list)[i];
    if (!entry.is_object()) throw Error(ErrorCode::kBadData, "is no object", where);
    const auto part = entry.find("part");
    if (part == entry.end() || !part->is_string()) throw Error(ErrorCode::kBadData, "'part' is no text", where);
    JointMatch match;
    match.source = jointsOf(entry, "source", source, where);
    match.target = jointsOf(entry, "target", target, where);
    const std::optional<BodyPart> known = bodyPartNamed(part->get_ref<const std::string&>());
    const Index own = match.target.empty() ? 0 : match.target.front();
    match.part = known ? *known : BodyPart{PartKind::kOther, Side::kCenter, 0, Segment::kWhole, own};
    match.by = MatchedBy::kFile;
    map.matches.push_back(std::move(match));
  }
  map.jointByJoint = flagOf(json, "joint_by_joint");
  map.unlikeBodies = flagOf(json, "unlike_bodies");
  checkSkeletonMap(map, source, target);
  return map;
}

}  // namespace limber
