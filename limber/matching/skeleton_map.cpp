#include "limber/matching/skeleton_map.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/core/error.h"
#include "limber/matching/animal_map.h"
#include "limber/matching/body_plan.h"
#include "limber/matching/humanoid_shape.h"
#include "limber/matching/neutral_pose.h"
#include "limber/matching/quadruped.h"
#include "limber/matching/quadruped_shape.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kAlike = 0.6;    // of the smaller one's joints, in animals that are matched by names alone
constexpr double kWhole = 0.75;   // of the smaller one's joints: more names in common tell most
constexpr double kGuessed = 0.5;  // confidence of one who hardly looks like a person, at most
constexpr double kFacing = 0.5;   // cosine between where toes and a body point, at least, to tell left from right by it

// A person as the matching sees it: parts with their joints.
struct Body {
  struct Part {
    std::vector<Index> joints;
    double confidence = 1;
  };
  std::map<std::string, Part, std::less<>> parts;
  std::vector<std::string> order;  // of the parts
  MatchedBy by = MatchedBy::kName;

  bool hasArms() const { return parts.contains("leftLowerArm") || parts.contains("rightLowerArm"); }
};

class BodyReader {
 public:
  explicit BodyReader(const Skeleton& skeleton) : skeleton_(skeleton) {
    labels_ = humanoidJointsByName(skeleton);
    if (!isPerson()) {
      labels_ = humanoidJointsByShape(skeleton);
      body_.by = MatchedBy::kShape;
    }
  }

  std::optional<Body> read() {
    if (!isPerson()) return std::nullopt;
    if (isMirrored()) {
      for (HumanoidJoint& label : labels_) label.bone = mirroredBone(label.bone);
    }
    for (const HumanoidJoint& label : labels_) {
      const std::string bone(label.bone);
      if (bone == "spine") {
        add("trunk", trunk(), label.confidence);
      } else if (bone == "neck") {
        add("neck", neck(), label.confidence);
      } else if (bone != "chest" && bone != "upperChest") {
        add(bone, withLinks(label), label.confidence);
      }
    }
    return std::move(body_);
  }

 private:
  // Hips, and most of what arms and legs consist of.
  bool isPerson() const {
    int limbs = 0;
    for (const char* bone : {"leftUpperArm", "rightUpperArm", "leftUpperLeg", "rightUpperLeg", "leftLowerArm",
                             "rightLowerArm", "leftLowerLeg", "rightLowerLeg"}) {
      limbs += jointOf(bone).has_value();
    }
    return jointOf("hips") && limbs >= 4 && shinsHangOnThighs();
  }

  // A spider's second leg is no shin, whatever it is called.
  bool shinsHangOnThighs() const {
    for (const auto& [thighBone, shinBone] :
         {std::pair{"leftUpperLeg", "leftLowerLeg"}, std::pair{"rightUpperLeg", "rightLowerLeg"}}) {
      const std::optional<Index> thigh = jointOf(thighBone), shin = jointOf(shinBone);
      if (thigh && shin && !isAncestorOrSelf(skeleton_, *thigh, *shin)) return false;
    }
    return true;
  }

  // Do the feet point backwards for someone whose left is where the names say? Then left is where they say right: the
  // skeleton is a mirror image, by a negative scale or out of a program with a left hand's axes.
  bool isMirrored() const {
    const std::optional<Index> left = jointOf("leftUpperLeg"), right = jointOf("rightUpperLeg"), head = jointOf("head");
    if (!left || !right || !head || !jointOf("leftUpperArm") || !jointOf("rightUpperArm")) return false;
    const std::vector<Affine> globals = restGlobals(skeleton_);
    const auto at = [&](Index joint) -> Vec3 { return globals[joint].translation(); };
    Vec3 forward = Vec3::Zero(), down = Vec3::Zero();
    for (const auto& [footBone, toesBone] : {std::pair{"leftFoot", "leftToes"}, std::pair{"rightFoot", "rightToes"}}) {
      const std::optional<Index> foot = jointOf(footBone), toes = jointOf(toesBone);
      if (!foot || !toes) return false;
      forward += at(*toes) - at(*foot);
      down += at(*foot) - at(*jointOf("hips"));
    }
    const Vec3 up = at(*head) - at(*jointOf("hips"));
    if (up.dot(-down) < kFacing * up.norm() * down.norm()) return false;  // stands or hangs in another way
    const Vec3 facing = (at(*left) - at(*right)).cross(-down);
    return facing.dot(forward) < -kFacing * facing.norm() * forward.norm();
  }

  std::optional<Index> jointOf(std::string_view bone) const {
    for (const HumanoidJoint& label : labels_) {
      if (label.bone == bone) return label.joint;
    }
    return std::nullopt;
  }
  bool isLabelled(Index joint) const {
    return std::any_of(labels_.begin(), labels_.end(), [&](const HumanoidJoint& l) { return l.joint == joint; });
  }

  // Without joints that another part has: where bodies are short, form gives some to an arm and to the neck.
  void add(const std::string& part, std::vector<Index> joints, double confidence) {
    std::erase_if(joints, [&](Index joint) { return !taken_.insert(joint).second; });
    if (joints.empty()) return;
    body_.parts[part] = {std::move(joints), confidence};
    body_.order.push_back(part);
  }

  // The joints strictly between two, root to tip; none where one does not hang on the other.
  std::vector<Index> between(Index above, Index below) const {
    std::vector<Index> joints;
    for (std::optional<Index> up = skeleton_.joints[below].parent; up && *up != above;
         up = skeleton_.joints[*up].parent)
      joints.insert(joints.begin(), *up);
    return isAncestorOrSelf(skeleton_, above, below) ? joints : std::vector<Index>{};
  }

  std::vector<Index> trunk() const {
    const Index hips = *jointOf("hips");
    const std::optional<Index> neck = jointOf("neck"), head = jointOf("head");
    if (neck || head) {
      std::vector<Index> joints = between(hips, neck ? *neck : *head);
      if (!joints.empty()) return joints;
    }
    std::vector<Index> joints;
    for (const char* bone : {"spine", "chest", "upperChest"}) {
      if (const std::optional<Index> joint = jointOf(bone)) joints.push_back(*joint);
    }
    return joints;
  }

  std::vector<Index> neck() const {
    std::vector<Index> joints = {*jointOf("neck")};
    if (const std::optional<Index> head = jointOf("head")) {
      for (const Index joint : between(joints[0], *head)) joints.push_back(joint);
    }
    return joints;
  }

  // A limb's joint, with the links (twist joints, doubled joints) before the limb's next one.
  std::vector<Index> withLinks(const HumanoidJoint& label) const {
    std::vector<Index> joints = {label.joint};
    for (const HumanoidJoint& next : labels_) {
      if (humanoidParent(next.bone) != label.bone || label.bone == "hips") continue;
      const std::vector<Index> links = between(label.joint, next.joint);
      const bool ofOthers = std::any_of(links.begin(), links.end(), [&](Index link) { return isLabelled(link); });
      const bool isHand = label.bone == "leftHand" || label.bone == "rightHand" || label.bone == "head";
      if (!ofOthers && !isHand) joints.insert(joints.end(), links.begin(), links.end());
    }
    return joints;
  }

  const Skeleton& skeleton_;
  std::vector<HumanoidJoint> labels_;
  std::set<Index> taken_;
  Body body_;
};

// By name with arms, or by a form that leaves little over, such as a tail, and whose trunk is upright.
bool isSurelyAPerson(const std::optional<Body>& body, const Skeleton& skeleton) {
  if (!body) return false;
  if (body->by == MatchedBy::kName) return body->hasArms();
  const Body::Part& hips = body->parts.at("hips");
  const auto head = body->parts.find("head");
  if (head == body->parts.end()) return hips.confidence > kGuessed;
  const std::vector<Affine> globals = restGlobals(skeleton);
  const Vec3 up = globals[head->second.joints.back()].translation() - globals[hips.joints.front()].translation();
  return hips.confidence > kGuessed && up.y() > std::hypot(up.x(), up.z());
}

// Arms or legs: hips and a head are no person.
bool hasLimbs(const SkeletonMap& map) {
  return (map.find("leftUpperLeg") && map.find("rightUpperLeg")) ||
         (map.find("leftUpperArm") && map.find("rightUpperArm"));
}

SkeletonMap matchBodies(const Body& source, const Body& target) {
  SkeletonMap map;
  for (const std::string& part : target.order) {
    const auto from = source.parts.find(part);
    if (from == source.parts.end()) continue;
    const Body::Part& to = target.parts.at(part);
    const bool byShape = source.by == MatchedBy::kShape || target.by == MatchedBy::kShape;
    map.matches.push_back({part, from->second.joints, to.joints, std::min(from->second.confidence, to.confidence),
                           byShape ? MatchedBy::kShape : MatchedBy::kName});
  }
  return map;
}

std::string plainName(std::string_view name) {
  if (const std::size_t space = name.find_last_of(":|"); space != std::string_view::npos) name.remove_prefix(space + 1);
  std::string plain;
  for (const char c : name) {
    if (c != '_' && c != '.' && c != '-' && c != ' ')
      plain.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return plain;
}

SkeletonMap matchNames(const Skeleton& source, const Skeleton& target) {
  std::map<std::string, Index> byName;
  for (Index j = 0; j < source.jointCount(); ++j) byName.emplace(plainName(source.joints[j].name), j);
  SkeletonMap map;
  std::set<Index> used;
  for (Index j = 0; j < target.jointCount(); ++j) {
    const auto found = byName.find(plainName(target.joints[j].name));
    if (found == byName.end() || !used.insert(found->second).second) continue;
    const bool same = source.joints[found->second].name == target.joints[j].name;
    map.matches.push_back({target.joints[j].name, {found->second}, {j}, same ? 1.0 : 0.9, MatchedBy::kName});
  }
  return map;
}

// Which joints of two skeletons hang on joints of one match.
class Hanging {
 public:
  Hanging(const SkeletonMap& map, const Skeleton& source, const Skeleton& target)
      : source_(source), target_(target), ofSource_(source.jointCount()), ofTarget_(target.jointCount()) {
    for (const JointMatch& match : map.matches) add(match);
  }

  void add(const JointMatch& match) {
    for (const Index joint : match.source) ofSource_[joint] = count_;
    for (const Index joint : match.target) ofTarget_[joint] = count_;
    ++count_;
  }
  // On joints of the same match both, or on none.
  bool alike(const JointMatch& match) const {
    return above(source_, ofSource_, match.source.front()) == above(target_, ofTarget_, match.target.front());
  }
  // Not part of any match, but on joints of one.
  bool isFree(const JointMatch& match) const {
    return !ofSource_[match.source.front()] && !ofTarget_[match.target.front()] &&
           above(source_, ofSource_, match.source.front());
  }

 private:
  using Matches = std::vector<std::optional<std::size_t>>;  // #J
  static std::optional<std::size_t> above(const Skeleton& skeleton, const Matches& matchOf, Index joint) {
    const std::optional<Index> at = nearestAbove(skeleton, joint, [&](Index j) { return matchOf[j].has_value(); });
    return at ? matchOf[*at] : std::nullopt;
  }

  const Skeleton &source_, &target_;
  Matches ofSource_, ofTarget_;
  std::size_t count_ = 0;
};

// Most names of the smaller one in common, on joints that hang alike.
bool areAlike(const SkeletonMap& names, const Skeleton& source, const Skeleton& target) {
  const Hanging hanging(names, source, target);
  const auto alike = std::count_if(names.matches.begin(), names.matches.end(),
                                   [&](const JointMatch& match) { return hanging.alike(match); });
  const std::size_t fewer = std::min(source.jointCount(), target.jointCount());
  return static_cast<double>(alike) > kAlike * static_cast<double>(fewer);
}

// What one family has besides, by equal names, where they hang on the same part: ears, jaws, tails, wings, hair.
void addNamesakes(const SkeletonMap& names, const Skeleton& source, const Skeleton& target, SkeletonMap& map) {
  Hanging hanging(map, source, target);
  const std::span<const std::string_view> bones = humanoidBones();
  for (const JointMatch& match : names.matches) {
    const bool isPart = map.find(match.part) || std::find(bones.begin(), bones.end(), match.part) != bones.end();
    if (isPart || !hanging.isFree(match) || !hanging.alike(match)) continue;
    map.matches.push_back(match);
    hanging.add(match);
  }
}

bool sameTree(const Skeleton& a, const Skeleton& b) {
  return a.jointCount() == b.jointCount() &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(),
                    [](const Joint& one, const Joint& other) { return one.parent == other.parent; });
}

SkeletonMap matchTrees(const Skeleton& target) {
  SkeletonMap map;
  for (Index j = 0; j < target.jointCount(); ++j) {
    map.matches.push_back({target.joints[j].name, {j}, {j}, 0.6, MatchedBy::kShape});
  }
  return map;
}

// Tries one way of matching after the other.
class Matchmaker {
 public:
  Matchmaker(const Skeleton& source, const Skeleton& target)
      : source_(source),
        target_(target),
        names_(matchNames(source, target)),
        from_(BodyReader(source).read()),
        to_(BodyReader(target).read()) {
    // Skeletons of one family, people or not, have most names in common.
    const std::size_t fewer = std::min(source.jointCount(), target.jointCount());
    isFamily_ = names_.matches.size() >= 3 && names_.matches.size() * 2 > fewer;
    isWhole_ = isFamily_ && static_cast<double>(names_.matches.size()) > kWhole * static_cast<double>(fewer);
    areArmless_ = isFamily_ && from_ && to_ && !from_->hasArms() && !to_->hasArms();
  }

  SkeletonMap match() {
    for (const auto way : {&Matchmaker::quadrupeds, &Matchmaker::bodyPlans, &Matchmaker::people}) {
      if (std::optional<SkeletonMap> map = (this->*way)()) return *std::move(map);
    }
    if (isFamily_) {
      matchChainsOfAnimals(source_, target_, names_);
      return names_;
    }
    if (sameTree(source_, target_)) return matchTrees(target_);
    throw Error(ErrorCode::kUnsupported,
                fmt::format("the motion's skeleton of {} and the character's of {} have too little in common to "
                            "be matched by names or by form: {}",
                            counted(source_.jointCount(), "joint"), target_.jointCount(), whatDiffers()),
                "", "say in a map which joint follows which, as docs/retargeting.md tells");
  }

 private:
  // Animals that are built otherwise may well have many words in common.
  std::optional<SkeletonMap> quadrupeds() const {
    if ((isNamed(from_) && isNamed(to_)) || (isFamily_ && areAlike(names_, source_, target_))) return std::nullopt;
    std::optional<SkeletonMap> map = matchQuadrupeds(source_, target_);
    if (map && sameTree(source_, target_)) return matchTrees(target_);
    if (map && isFamily_) addNamesakes(names_, source_, target_, *map);
    return map;
  }

  std::optional<SkeletonMap> bodyPlans() const {
    if (isWhole_ || sameTree(source_, target_)) return std::nullopt;
    if (isSurelyAPerson(from_, source_) || isSurelyAPerson(to_, target_)) return std::nullopt;
    std::optional<SkeletonMap> plan = matchBodyPlans(source_, target_);
    const bool namesTell = isFamily_ && (!mayBePeople() || areArmless_);
    const bool less = plan && matchedJoints(*plan, MapSide::kTarget).size() <= names_.matches.size();
    return namesTell && less ? std::nullopt : plan;
  }

  // A family without arms, of birds or bats, moves more than legs and trunk.
  std::optional<SkeletonMap> people() const {
    if (!mayBePeople() || areArmless_ || areStrangers()) return std::nullopt;
    SkeletonMap map = matchBodies(*from_, *to_);
    if (isFamily_) addNamesakes(names_, source_, target_, map);
    return map.matches.size() >= 5 && hasLimbs(map) ? std::optional(std::move(map)) : std::nullopt;
  }

  bool mayBePeople() const { return from_ && to_ && (isNamed(from_) || isNamed(to_) || !isFamily_); }

  std::string whatDiffers() const {
    const bool oneIsQuadruped = readQuadruped(source_).has_value() != readQuadruped(target_).has_value();
    if (oneIsQuadruped && (isNamed(from_) || isNamed(to_))) return "one is a person, the other stands on four legs";
    return whyBodyPlansDiffer(source_, target_);
  }

  static bool isNamed(const std::optional<Body>& body) { return body && body->by == MatchedBy::kName; }

  // By their form alone both hardly look like people, or one is a quadruped: a fox is no person, nor a frog one for a
  // fox to follow.
  bool areStrangers() const {
    const auto isQuadruped = [](const Body& body, const Skeleton& skeleton) {
      return body.by == MatchedBy::kShape && readQuadruped(skeleton);
    };
    const auto isGuessed = [](const Body& body) {
      return body.by == MatchedBy::kShape && body.parts.at("hips").confidence <= kGuessed;
    };
    return (isGuessed(*from_) && isGuessed(*to_)) || isQuadruped(*from_, source_) || isQuadruped(*to_, target_);
  }

  const Skeleton &source_, &target_;
  SkeletonMap names_;
  std::optional<Body> from_, to_;
  bool isFamily_ = false, isWhole_ = false, areArmless_ = false;
};

}  // namespace

const JointMatch* SkeletonMap::find(std::string_view part) const {
  const auto found =
      std::find_if(matches.begin(), matches.end(), [&](const JointMatch& match) { return match.part == part; });
  return found == matches.end() ? nullptr : &*found;
}

SkeletonMap matchSkeletons(const Skeleton& source, const Skeleton& target) {
  return Matchmaker(source, target).match();
}

void checkSkeletonMap(const SkeletonMap& map, const Skeleton& source, const Skeleton& target) {
  std::set<Index> moved;
  std::set<std::string> parts;
  if (map.matches.empty()) throw Error(ErrorCode::kBadData, "the map matches nothing");
  for (const JointMatch& match : map.matches) {
    const auto refuse = [&](const std::string& what) { throw Error(ErrorCode::kBadData, what, match.part); };
    if (match.source.empty() || match.target.empty()) refuse("has no joint on one side");
    if (!parts.insert(match.part).second) refuse("is matched twice");
    for (const Index joint : match.source) {
      if (joint >= source.jointCount()) refuse("names a joint that the motion does not have");
    }
    for (const Index joint : match.target) {
      if (joint >= target.jointCount()) refuse("names a joint that the character does not have");
      if (!moved.insert(joint).second) refuse(fmt::format("moves '{}' a second time", target.joints[joint].name));
    }
  }
}

}  // namespace limber
