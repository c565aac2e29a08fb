#include "limber/actions/export/bone_names.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "limber/character/anatomy/names/joint_words.h"
#include "limber/character/anatomy/names/naming_convention.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

namespace {

// Joints of a spine and of a neck that a program numbers: a longer one is not taken for its own.
constexpr std::size_t kMaxCounted = 9;
// MetaHuman's spine: the last joint carries neck and clavicles.
constexpr std::size_t kMetaHumanSpine = 5;

std::string_view conventionOf(BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
      return "Unreal";
    case BoneNames::kMetaHuman:
      return "MetaHuman";
    case BoneNames::kUnity:
      return "Unity";
    case BoneNames::kGodot:
      return "Godot";
    case BoneNames::kBlender:
      return "Blender";
    case BoneNames::kRigify:
      return "Rigify";
    case BoneNames::kMixamo:
      return "Mixamo";
    case BoneNames::kActorCore:
      return "Character Creator";
    case BoneNames::kRoblox:
      return "Roblox R15";
    case BoneNames::kVrm:
      break;
  }
  return "VRM";
}

// The names of a column.
class Column {
 public:
  explicit Column(BoneNames column)
      : convention_(*std::find_if(namingConventions().begin(), namingConventions().end(),
                                  [&](const NamingConvention& one) { return one.name == conventionOf(column); })) {}

  // Empty where the convention has none.
  std::string name(JointRole role, Side side, std::size_t number) const {
    return conventionName(convention_, role, side, number);
  }
  std::string center(JointRole role, std::size_t number) const { return name(role, Side::kCenter, number); }

  std::vector<std::string> all(JointRole role, Side side, std::size_t count) const {
    return conventionNames(convention_, role, side, count);
  }

  // Hips, spine, neck and head are one list.
  bool countsToHead() const { return !center(JointRole::kSpineToHead, 0).empty(); }
  bool countsTrunk() const { return countsToHead() || !center(JointRole::kTrunk, kMaxCounted).empty(); }

  // The lists that the program counts, each from its first name on.
  std::vector<std::vector<std::string>> counted() const {
    if (!countsTrunk()) return {};
    if (countsToHead()) return {list(JointRole::kSpineToHead, 2 * kMaxCounted)};
    return {list(JointRole::kTrunk, kMaxCounted), list(JointRole::kNeck, kMaxCounted)};
  }

  std::vector<std::string> list(JointRole role, std::size_t count) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(center(role, i));
    return names;
  }

 private:
  const NamingConvention& convention_;
};

void forEachRole(const auto& visit) {
  for (auto role = static_cast<int>(JointRole::kRoot); role <= static_cast<int>(JointRole::kWing); ++role) {
    for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) visit(static_cast<JointRole>(role), side);
  }
}

// What a bone of VRM is in every convention.
struct BoneRole {
  JointRole role = JointRole::kHelper;
  Side side = Side::kCenter;
  std::size_t number = 0;
};

using BoneRoles = std::map<std::string, BoneRole, std::less<>>;

const BoneRoles& boneRoles() {
  static const BoneRoles kRoles = [] {
    constexpr std::size_t kLongestChain = 3;  // of a finger
    BoneRoles roles;
    const Column vrm(BoneNames::kVrm);
    forEachRole([&](JointRole role, Side side) {
      for (std::size_t number = 0; number < kLongestChain; ++number) {
        roles.emplace(vrm.name(role, side, number), BoneRole{role, side, number});
      }
    });
    roles.erase("");
    return roles;
  }();
  return kRoles;
}

// MetaHuman's spine of fewer joints is spread over its own, so that the last one is its last.
std::size_t spineNumber(std::size_t i, std::size_t count, BoneNames column) {
  if (column != BoneNames::kMetaHuman || count >= kMetaHumanSpine || count < 2) return i;
  const double apart = double{kMetaHumanSpine - 1} / static_cast<double>(count - 1);
  return static_cast<std::size_t>(std::lround(apart * static_cast<double>(i)));
}

}  // namespace

std::optional<std::string> boneName(std::string_view vrmBone, BoneNames column, NameStyle style) {
  const auto found = boneRoles().find(vrmBone);
  if (found == boneRoles().end()) return std::nullopt;
  const auto [role, side, number] = found->second;
  const std::string name = Column(column).name(role, side, number);
  return name.empty() ? spellName(spellStem(partsOfName(vrmBone).words, style), side, style) : name;
}

std::vector<std::string> trunkNames(std::size_t spineJoints, std::size_t neckJoints, BoneNames column,
                                    NameStyle style) {
  const Column names(column);
  if (!names.countsTrunk()) return {};
  if (names.countsToHead()) return names.list(JointRole::kSpineToHead, spineJoints + neckJoints + 2);
  std::vector<std::string> trunk = {*boneName("hips", column, style)};
  for (std::size_t i = 0; i < spineJoints; ++i) {
    trunk.push_back(names.center(JointRole::kTrunk, spineNumber(i, spineJoints, column)));
  }
  for (std::string& neck : names.list(JointRole::kNeck, neckJoints)) trunk.push_back(std::move(neck));
  trunk.push_back(*boneName("head", column, style));
  return trunk;
}

std::set<std::string> ownNames(BoneNames column, NameStyle style) {
  std::set<std::string> names;
  forEachRole([&, own = Column(column)](JointRole role, Side side) {
    const std::size_t count = role == JointRole::kSpineToHead ? 2 * kMaxCounted : kMaxCounted;
    for (std::string& name : own.all(role, side, count)) names.insert(std::move(name));
  });
  for (const std::string_view bone : humanoidBones()) names.insert(*boneName(bone, column, style));
  return names;
}

bool isCountedAsOwn(const std::set<std::string>& names, BoneNames column, NameStyle) {
  if (column == BoneNames::kMetaHuman) {
    return names.count(Column(column).center(JointRole::kTrunk, kMetaHumanSpine - 1)) > 0;
  }
  const std::vector<std::vector<std::string>> lists = Column(column).counted();
  return std::all_of(lists.begin(), lists.end(), [&](const std::vector<std::string>& list) {
    return std::is_partitioned(list.begin(), list.end(),
                               [&](const std::string& name) { return names.count(name) > 0; });
  });
}

std::string metacarpalName(std::string_view finger, Side side, BoneNames column, NameStyle style) {
  const Column names(column);
  const std::size_t number = finger == "index" ? 0 : finger == "middle" ? 1 : finger == "ring" ? 2 : 3;
  if (std::string palm = names.name(JointRole::kPalm, side, number); !palm.empty()) return palm;
  const auto role = static_cast<JointRole>(static_cast<std::size_t>(JointRole::kIndex) + number);
  for (std::string& name : names.all(role, side, 1)) {
    if (saysMetapodial(name)) return std::move(name);
  }
  return spellName(spellStem(std::vector<std::string>{std::string(finger), "metacarpal"}, style), side, style);
}

}  // namespace limber
