#include "limber/skeleton/ik/limits/limits_json.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/known_error.h"
#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// One joint's entry, read with its location at hand for errors.
class EntryReader {
 public:
  EntryReader(const Json& entry, std::string where) : entry_(entry), where_(std::move(where)) {
    if (!entry.is_object()) bad("is not an object");
  }

  JointLimit read(const Transform& rest) const {
    JointLimit limit;
    limit.neutral = entry_.contains("neutral") ? quaternion("neutral") : rest.rotation.normalized();
    if (entry_.contains("axes")) limit.axes = quaternion("axes");
    limit.restTranslation = rest.translation;
    if (entry_.contains("stiffness")) limit.stiffness = number(entry_["stiffness"], "stiffness");
    limit.motion = motion();
    checkLimit(limit, where_);
    return limit;
  }

 private:
  [[noreturn]] void bad(const std::string& what) const { throw Error(ErrorCode::kBadData, what, where_); }

  JointMotion motion() const {
    if (!entry_.contains("type") || !entry_["type"].is_string()) bad("has no type");
    const std::string type = entry_["type"];
    if (type == "free") return allow({}), FreeJoint{};
    if (type == "fixed") return allow({}), FixedJoint{};
    if (type == "hinge") return allow({"x"}), Hinge{degrees("x")};
    if (type == "pivot") return allow({"y"}), Pivot{degrees("y")};
    if (type == "ball-and-socket") {
      return allow({"x", "z", "twist"}), BallAndSocket{degrees("x"), degrees("z"), degrees("twist")};
    }
    if (type == "condyloid") return allow({"x", "z"}), Condyloid{degrees("x"), degrees("z")};
    if (type == "saddle") return allow({"x", "z"}), Saddle{degrees("x"), degrees("z")};
    if (type == "swing-twist") {
      return allow({"x", "z", "twist"}), SwingTwist{degrees("x"), degrees("z"), degrees("twist")};
    }
    if (type == "reach-cone") return allow({"center", "polygon", "twist"}), reachCone();
    if (type == "plane") return allow({"x", "z"}), PlaneJoint{range("x", 1), range("z", 1)};
    bad("has a type that is not known: '" + type + "'");
  }

  // Refuses keys that the type does not have: a misspelt one would silently limit nothing.
  void allow(std::initializer_list<std::string_view> keys) const {
    constexpr std::string_view kCommon[] = {"type", "neutral", "axes", "stiffness"};
    for (const auto& item : entry_.items()) {
      const bool known = std::find(keys.begin(), keys.end(), item.key()) != keys.end() ||
                         std::find(std::begin(kCommon), std::end(kCommon), item.key()) != std::end(kCommon);
      if (!known) bad("has a key that its type does not have: '" + item.key() + "'");
    }
  }

  ReachCone reachCone() const {
    ReachCone cone;
    cone.twist = degrees("twist");
    if (!entry_.contains("polygon") || !entry_["polygon"].is_array()) bad("has no polygon");
    for (const Json& point : entry_["polygon"]) cone.polygon.push_back(vector(point, "polygon"));
    if (entry_.contains("center")) cone.center = vector(entry_["center"], "center").normalized();
    return cone;
  }

  double number(const Json& value, const char* key) const {
    if (!value.is_number()) bad(fmt::format("has a {} that is not a number", key));
    return value.get<double>();
  }

  AngleRange range(const char* key, double unit) const {
    if (!entry_.contains(key)) bad(fmt::format("has no range {}", key));
    const Json& value = entry_[key];
    if (!value.is_array() || value.size() != 2) bad(fmt::format("has a range {} that is not two numbers", key));
    return {unit * number(value[0], key), unit * number(value[1], key)};
  }

  AngleRange degrees(const char* key) const { return range(key, kDegree); }

  Vec3 vector(const Json& value, const char* key) const {
    if (!value.is_array() || value.size() != 3) bad(fmt::format("has a {} of not three numbers", key));
    return Vec3(number(value[0], key), number(value[1], key), number(value[2], key));
  }

  Quat quaternion(const char* key) const {
    const Json& value = entry_[key];
    if (!value.is_array() || value.size() != 4) bad(fmt::format("has a {} of not four numbers", key));
    const Quat q(number(value[3], key), number(value[0], key), number(value[1], key), number(value[2], key));
    if (!(std::abs(q.norm() - 1) < 1e-3)) bad(fmt::format("has a {} not of unit length", key));
    return q.normalized();
  }

  const Json& entry_;
  std::string where_;
};

Json degreesOf(const AngleRange& range) {
  return {range.min / kDegree, range.max / kDegree};
}

Json listOf(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json listOf(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

struct EntryWriter {
  Json operator()(const FreeJoint&) const { return {{"type", "free"}}; }
  Json operator()(const FixedJoint&) const { return {{"type", "fixed"}}; }
  Json operator()(const Hinge& l) const { return {{"type", "hinge"}, {"x", degreesOf(l.x)}}; }
  Json operator()(const Pivot& l) const { return {{"type", "pivot"}, {"y", degreesOf(l.y)}}; }
  Json operator()(const BallAndSocket& l) const { return three("ball-and-socket", l.x, l.z, l.twist); }
  Json operator()(const Condyloid& l) const { return two("condyloid", l.x, l.z); }
  Json operator()(const Saddle& l) const { return two("saddle", l.x, l.z); }
  Json operator()(const SwingTwist& l) const { return three("swing-twist", l.x, l.z, l.twist); }
  Json operator()(const PlaneJoint& l) const {
    return {{"type", "plane"}, {"x", {l.x.min, l.x.max}}, {"z", {l.z.min, l.z.max}}};
  }
  Json operator()(const ReachCone& l) const {
    Json entry = {{"type", "reach-cone"}, {"center", listOf(l.center)}, {"polygon", Json::array()}};
    for (const Vec3& point : l.polygon) entry["polygon"].push_back(listOf(point));
    entry["twist"] = degreesOf(l.twist);
    return entry;
  }

 private:
  static Json two(const char* type, const AngleRange& x, const AngleRange& z) {
    return {{"type", type}, {"x", degreesOf(x)}, {"z", degreesOf(z)}};
  }
  static Json three(const char* type, const AngleRange& x, const AngleRange& z, const AngleRange& twist) {
    Json entry = two(type, x, z);
    entry["twist"] = degreesOf(twist);
    return entry;
  }
};

// Refuses a key that occurs twice in one object: the parser would silently keep one of the two.
class KeyGuard {
 public:
  void take(std::size_t depth, const std::string& key) {
    if (!keys_[depth].insert(key).second) {
      const bool inEntry = depth >= kEntryDepth && !joint_.empty();
      throw Error(ErrorCode::kBadData, fmt::format("'{}' stands twice", key),
                  inEntry ? fmt::format("limits: joint '{}'", joint_) : "limits");
    }
    if (depth == kEntryDepth - 1) joint_ = key;
  }
  void leave(std::size_t depth) { keys_.erase(keys_.upper_bound(depth), keys_.end()); }

 private:
  static constexpr std::size_t kEntryDepth = 3;  // of the keys in {"joints": {"elbow": {

  std::map<std::size_t, std::set<std::string>> keys_;  // of the objects that are open, by depth
  std::string joint_;
};

Json parse(std::string_view text) {
  KeyGuard guard;
  const auto watch = [&guard](int depth, Json::parse_event_t event, Json& value) {
    const auto level = static_cast<std::size_t>(depth);
    if (event == Json::parse_event_t::key) guard.take(level, value.get_ref<const std::string&>());
    if (event == Json::parse_event_t::object_end) guard.leave(level);
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::parse_error& error) {
    throw KnownError(ErrorKind::kNoLimitsFile,
                     {ErrorCode::kBadData, fmt::format("are not JSON at byte {}", error.byte), "limits"});
  } catch (const Json::out_of_range&) {
    throw Error(ErrorCode::kBadData, "hold a number that is too large", "limits");
  }
}

}  // namespace

JointLimits limitsFromJson(std::string_view text, const Skeleton& skeleton) {
  const auto bad = [](const std::string& what) {
    throw KnownError(ErrorKind::kNoLimitsFile, {ErrorCode::kBadData, what, "limits"});
  };
  const Json file = parse(text);
  if (!file.is_object() || !file.contains("limber_limits")) bad("have no \"limber_limits\"");
  if (file["limber_limits"] != 1) bad("are of a version that is not known");
  if (!file.contains("joints") || !file["joints"].is_object()) bad("have no \"joints\"");
  JointLimits limits;
  limits.joints.resize(skeleton.jointCount());
  for (const auto& item : file["joints"].items()) {
    const std::string where = "limits: joint '" + item.key() + "'";
    const std::optional<Index> joint = skeleton.find(item.key());
    if (!joint) {
      throw KnownError(ErrorKind::kLimitsOfOther, {ErrorCode::kBadData, "is not in the skeleton", where},
                       {{"joint", item.key()}});
    }
    limits.joints[*joint] = EntryReader(item.value(), where).read(skeleton.joints[*joint].rest);
  }
  return limits;
}

std::string limitsToJson(const JointLimits& limits, const Skeleton& skeleton) {
  if (limits.joints.size() != skeleton.jointCount()) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("{} limits for {} joints", limits.joints.size(), skeleton.jointCount()));
  }
  Json joints = Json::object();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const JointLimit& limit = limits.joints[j];
    if (std::holds_alternative<FreeJoint>(limit.motion) && limit.stiffness == 0) continue;
    Json entry = std::visit(EntryWriter{}, limit.motion);
    entry["neutral"] = listOf(limit.neutral);
    entry["axes"] = listOf(limit.axes);
    if (limit.stiffness > 0) entry["stiffness"] = limit.stiffness;
    joints[skeleton.joints[j].name] = std::move(entry);
  }
  return Json{{"limber_limits", 1}, {"joints", std::move(joints)}}.dump(1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace limber
