#include "limber/actions/export/target_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/character/anatomy/body_part.h"
#include "limber/character/anatomy/names/joint_words.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

// A skeleton has a program's names where so many bones, and this fraction of all that are read, are called as there. A
// person has 15 bones at least (VRM 1.0), and most of these are to agree. A third, as a reading may go wrong in both
// hands, which have 30 of 54 bones, while of a body whose sides are exchanged no more than the trunk agrees, 6 of 22.
constexpr std::size_t kFewestOwnBones = 8;
constexpr double kOwnFraction = 1.0 / 3;

// Bones that are named together: a limb, a finger, an eye, the trunk with neck and head.
std::string chainOf(std::string_view bone) {
  static constexpr std::array<std::string_view, 5> kFingers = {"Thumb", "Index", "Middle", "Ring", "Little"};
  static constexpr std::array<std::string_view, 4> kLeg = {"UpperLeg", "LowerLeg", "Foot", "Toes"};
  static constexpr std::array<std::string_view, 2> kAlone = {"Eye", "jaw"};
  std::string side;
  for (const Side each : kSides) {
    if (bone.starts_with(nameOf(each))) side = nameOf(each);
  }
  for (const std::string_view finger : kFingers) {
    if (bone.substr(side.size()).starts_with(finger)) return side + std::string(finger);
  }
  const auto endsIn = [&](std::string_view end) { return bone.ends_with(end); };
  if (std::any_of(kAlone.begin(), kAlone.end(), endsIn)) return std::string(bone);
  if (side.empty()) return "trunk";
  return side + (std::any_of(kLeg.begin(), kLeg.end(), endsIn) ? "Leg" : "Arm");
}

// partsOfName takes "center" for a word that says nothing of the body; in center_of_mass it is the name.
NameParts partsWithCenter(const std::string& name) {
  constexpr std::string_view kCenter = "center";
  NameParts parts = partsOfName(name);
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::size_t at = small.find(kCenter);
  const auto isLetterAt = [&](std::size_t i) {
    return i < small.size() && std::isalpha(static_cast<unsigned char>(small[i])) != 0;
  };
  const bool isWord = at != std::string::npos && !isLetterAt(at + kCenter.size()) && (at == 0 || !isLetterAt(at - 1));
  if (!isWord || std::find(parts.words.begin(), parts.words.end(), kCenter) != parts.words.end()) return parts;
  const std::size_t before = at == 0 ? 0 : partsOfName(name.substr(0, at)).words.size();
  const auto index = static_cast<std::ptrdiff_t>(std::min(before, parts.words.size()));
  parts.words.insert(parts.words.begin() + index, std::string(kCenter));
  return parts;
}

class TargetNamer {
 public:
  TargetNamer(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones, BoneNames column,
              NameStyle style)
      : skeleton_(skeleton),
        anatomy_(anatomy),
        column_(column),
        style_(style),
        own_(ownNames(column, style)),
        wanted_(skeleton.joints.size()) {
    for (const HumanoidJoint& bone : bones) jointOf_[bone.bone] = bone.joint;
  }

  // Names are given in this order, and the first of two that are alike keeps it.
  TargetNames names() {
    nameBones();
    nameTrunk();
    const bool isOwn = hasOwnNames();
    if (isOwn) keepNamesOfBones();
    giveNames();
    for (Index j = 0; isOwn && j < skeleton_.jointCount(); ++j) want(j, nameOfJoint(j));
    nameMetacarpals();
    for (const Part& part : anatomy_.parts) namePart(part);
    giveNames();
    for (Index j = 0; j < skeleton_.jointCount(); ++j) want(j, isOwnName(j) ? nameOfJoint(j) : respelledName(j));
    giveNames();
    return {std::move(given_), isOwn};
  }

 private:
  std::string spell(std::initializer_list<std::string> words, Side side) const {
    return spellName(spellStem(std::vector<std::string>(words), style_), side, style_);
  }

  void want(Index joint, std::string name) {
    if (wanted_[joint].empty()) wanted_[joint] = std::move(name);
  }

  std::optional<Index> jointOf(std::string_view bone) const {
    const auto found = jointOf_.find(bone);
    return found == jointOf_.end() ? std::nullopt : std::optional(found->second);
  }

  const std::string& nameOfJoint(Index joint) const { return skeleton_.joints[joint].name; }
  std::string respelledName(Index joint) const { return respelled(nameOfJoint(joint), style_); }
  bool isOwnName(Index joint) const { return own_.count(nameOfJoint(joint)) > 0; }

  // Names that are wanted by now are the joints', in their order.
  void giveNames() {
    given_.resize(wanted_.size());
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (given_[j].empty() && !wanted_[j].empty()) given_[j] = unique_.add(wanted_[j]);
    }
  }

  void nameBones() {
    for (const auto& [bone, joint] : jointOf_) {
      if (const std::optional<std::string> name = boneName(bone, column_, style_)) want(joint, *name);
    }
  }

  bool hasOwnNames() const {
    const auto isCalledSo = [&](const auto& bone) { return nameOfJoint(bone.second) == wanted_[bone.second]; };
    const auto same = static_cast<std::size_t>(std::count_if(jointOf_.begin(), jointOf_.end(), isCalledSo));
    return same >= kFewestOwnBones && static_cast<double>(same) >= kOwnFraction * static_cast<double>(jointOf_.size());
  }

  // A chain that has another program's names, too, is named as it is read: Godot's LeftThumbProximal is another joint
  // than Unity's, whose LeftThumbIntermediate is none of Godot's.
  void keepNamesOfBones() {
    const std::set<std::string> foreign = foreignChains();
    for (const auto& [bone, joint] : jointOf_) {
      if (foreign.count(chainOf(bone)) == 0) wanted_[joint] = nameOfJoint(joint);
    }
    for (const Index joint : trunk_) {
      if (foreign.count(chainOf("hips")) == 0) wanted_[joint] = nameOfJoint(joint);
    }
  }

  std::set<std::string> foreignChains() const {
    std::set<std::string> all, unread, chains;
    for (const Joint& joint : skeleton_.joints) all.insert(joint.name);
    unread = all;
    for (const auto& [bone, joint] : jointOf_) unread.erase(nameOfJoint(joint));
    for (const auto& [bone, joint] : jointOf_) {
      // Where a joint that no bone was read in has the bone's name, it is the reading that went wrong.
      if (!isOwnName(joint) && unread.count(wanted_[joint]) == 0) chains.insert(chainOf(bone));
    }
    if (!isCountedAsOwn(all, column_, style_)) chains.insert(chainOf("hips"));
    return chains;
  }

  // The joints strictly between two, from the upper one down; none where the lower one does not hang on it.
  std::vector<Index> between(std::optional<Index> upper, std::optional<Index> lower) const {
    std::vector<Index> joints;
    if (!upper || !lower) return joints;
    std::optional<Index> at = skeleton_.joints[*lower].parent;
    for (; at && *at != *upper; at = skeleton_.joints[*at].parent) joints.push_back(*at);
    if (!at) return {};
    std::reverse(joints.begin(), joints.end());
    return joints;
  }

  // Counted where the program counts, however many there are.
  void nameTrunk() {
    const std::optional<Index> hips = jointOf("hips"), neck = jointOf("neck"), head = jointOf("head");
    const std::vector<Index> spine = between(hips, neck ? neck : head);
    if (spine.empty()) return;
    std::vector<Index> necks = between(neck, head);
    if (neck) necks.insert(necks.begin(), *neck);
    const std::vector<std::string> names = trunkNames(spine.size(), necks.size(), column_, style_);
    if (names.empty()) return;
    trunk_.push_back(*hips);
    trunk_.insert(trunk_.end(), spine.begin(), spine.end());
    trunk_.insert(trunk_.end(), necks.begin(), necks.end());
    if (head) trunk_.push_back(*head);
    for (std::size_t i = 0; i < trunk_.size(); ++i) wanted_[trunk_[i]] = names[i];
  }

  void nameMetacarpals() {
    for (const Side side : kSides) {
      for (const char* finger : {"Index", "Middle", "Ring", "Little"}) {
        const std::string sideName(nameOf(side));
        const std::vector<Index> palm = between(jointOf(sideName + "Hand"), jointOf(sideName + finger + "Proximal"));
        if (palm.empty()) continue;
        std::string word(finger);
        word[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(word[0])));
        want(palm.back(), metacarpalName(word, side, column_, style_));
      }
    }
  }

  // The parts that no person has.
  void namePart(const Part& part) {
    if (part.kind == PartKind::kLeg || part.kind == PartKind::kArm) return nameLimb(part);
    const bool isNamed = part.kind == PartKind::kTail || part.kind == PartKind::kWing || part.kind == PartKind::kFin ||
                         part.kind == PartKind::kEar;
    if (!isNamed) return;
    std::string kind(nameOf(part.kind));
    const std::string pair = part.pair > 0 ? std::to_string(part.pair + 1) : "";
    for (std::size_t i = 0; i < part.joints.size(); ++i) {
      const std::string number = part.joints.size() > 1 ? fmt::format("{:02}", i + 1) : "";
      want(part.joints[i], spell({kind, pair, number}, part.side));
    }
  }

  void nameLimb(const Part& part) {
    const Index pairs = anatomy_.pairsOf(part.kind);
    const std::string kind(nameOf(part.kind));
    std::string location, number;
    if (pairs == 2) location = part.pair == 0 ? "front" : "hind";
    if (pairs > 2 || (pairs == 1 && part.pair > 0)) number = std::to_string(part.pair + 1);
    const bool isArm = part.kind == PartKind::kArm;
    const auto name = [&](std::optional<Index> joint, std::initializer_list<std::string> words) {
      if (!joint) return;
      std::vector<std::string> all = {location};
      all.insert(all.end(), words);
      all.push_back(number);
      want(*joint, spellName(spellStem(all, style_), part.side, style_));
    };
    if (part.upper && part.upper != part.joints.front()) {
      name(part.joints.front(), {isArm || (pairs == 2 && part.pair == 0) ? "shoulder" : "hip"});
    }
    name(part.upper, {"upper", kind});
    name(part.middle, {"lower", kind});
    name(part.hock, {"hock"});
    name(part.end, {isArm ? "hand" : "foot"});
    name(part.toes, {isArm ? "fingers" : "toes"});
  }

  const Skeleton& skeleton_;
  const Anatomy& anatomy_;
  BoneNames column_;
  NameStyle style_;
  std::set<std::string> own_;                  // of the program's skeletons
  std::map<std::string_view, Index> jointOf_;  // by the bone of VRM
  std::vector<Index> trunk_;                   // from the hips to the head, where the program counts
  std::vector<std::string> wanted_;            // #J, empty: not named yet
  UniqueNames unique_;
  std::vector<std::string> given_;  // #J, unique
};

}  // namespace

std::string respelled(const std::string& name, NameStyle style) {
  const auto isForeign = [](char c) { return static_cast<unsigned char>(c) > 0x7e; };
  if (std::any_of(name.begin(), name.end(), isForeign)) return name;
  const NameParts parts = partsWithCenter(name);
  return parts.words.empty() ? name : spellName(spellStem(parts.words, style), parts.side, style);
}

TargetNames targetNames(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones,
                        BoneNames column, NameStyle style) {
  return TargetNamer(skeleton, anatomy, bones, column, style).names();
}

}  // namespace limber
