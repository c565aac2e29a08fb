#include "limber/anatomy/joint_words.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limber/anatomy/humanoid_words.h"

namespace limber {

namespace {

using detail::BodyWord;

constexpr std::size_t kBodyWords = static_cast<std::size_t>(BodyWord::kLittle) + 1;  // of BodyWord

// Beyond the words of people. Words in one row mean the same.
enum ExtraWord {
  kTail,
  kWing,
  kFin,
  kEar,
  kMouth,
  kHair,
  kDigit,
  kProp,
  kRoot,
  kFeather,
  kHorn,
  kCloth,
  kBlade,
  kHoof,
  kClaw,
  kBody,
  kEyelid,
  kBreast,
  kTongue,
  kMetapodial
};
static_assert(kBodyWords + kMetapodial + 1 == kJointWords);

constexpr std::array<std::pair<std::string_view, ExtraWord>, 75> kExtraWords = {{
    {"tail", kTail},
    {"wing", kWing},
    {"wings", kWing},
    {"fin", kFin},
    {"fins", kFin},
    {"flipper", kFin},
    {"pectoral", kFin},
    {"dorsal", kFin},
    {"ear", kEar},
    {"ears", kEar},
    {"mouth", kMouth},
    {"snout", kMouth},
    {"beak", kMouth},
    {"lip", kMouth},
    {"lips", kMouth},
    {"bill", kMouth},
    {"teeth", kMouth},
    {"chin", kMouth},
    {"jawbone", kMouth},
    {"hair", kHair},
    {"mane", kHair},
    {"ponytail", kHair},
    {"braid", kHair},
    {"bang", kHair},
    {"bangs", kHair},
    {"beard", kHair},
    {"finger", kDigit},
    {"fingers", kDigit},
    {"digit", kDigit},
    {"prop", kProp},
    {"weapon", kProp},
    {"gun", kProp},
    {"sword", kProp},
    {"shield", kProp},
    {"item", kProp},
    {"bag", kProp},
    {"backpack", kProp},
    {"knife", kProp},
    {"axe", kProp},
    {"bow", kProp},
    {"slot", kProp},
    {"mug", kProp},
    {"staff", kProp},
    {"root", kRoot},
    {"armature", kRoot},
    {"master", kRoot},
    {"main", kRoot},
    {"global", kRoot},
    {"cog", kRoot},
    {"reference", kRoot},
    {"feather", kFeather},
    {"feathers", kFeather},
    {"horn", kHorn},
    {"antenna", kHorn},
    {"antler", kHorn},
    {"spike", kHorn},
    {"skirt", kCloth},
    {"cape", kCloth},
    {"cloth", kCloth},
    {"robe", kCloth},
    {"scapula", kBlade},
    {"blade", kBlade},
    {"hoof", kHoof},
    {"paw", kHoof},
    {"claw", kClaw},
    {"body", kBody},
    {"eyelid", kEyelid},
    {"eyebrow", kEyelid},
    {"breast", kBreast},
    {"tongue", kTongue},
    {"hock", kMetapodial},
    {"metatarsal", kMetapodial},
    {"metatarsals", kMetapodial},
    {"carpal", kMetapodial},
    {"metacarpal", kMetapodial},
}};

constexpr std::array<std::pair<std::string_view, NameMark>, 25> kMarks = {{
    {"front", NameMark::kFront},       {"fore", NameMark::kFront},    {"hind", NameMark::kHind},
    {"rear", NameMark::kHind},         {"back", NameMark::kHind},     {"end", NameMark::kEnd},
    {"tip", NameMark::kEnd},           {"nub", NameMark::kEnd},       {"leaf", NameMark::kEnd},
    {"site", NameMark::kEnd},          {"eff", NameMark::kEnd},       {"effector", NameMark::kEnd},
    {"ik", NameMark::kHelper},         {"fk", NameMark::kHelper},     {"pole", NameMark::kHelper},
    {"poletarget", NameMark::kHelper}, {"target", NameMark::kHelper}, {"ctrl", NameMark::kHelper},
    {"control", NameMark::kHelper},    {"helper", NameMark::kHelper}, {"mch", NameMark::kHelper},
    {"socket", NameMark::kHelper},     {"heel", NameMark::kHelper},   {"roll", NameMark::kTwist},
    {"twist", NameMark::kTwist},
}};

template <typename Value, std::size_t n>
std::optional<Value> lookUp(const std::array<std::pair<std::string_view, Value>, n>& list, std::string_view word) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.first == word; });
  return found == list.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Side> sideOf(std::string_view token) {
  if (token == "l" || token == "left" || token == "lft") return Side::kLeft;
  if (token == "r" || token == "right" || token == "rgt") return Side::kRight;
  return std::nullopt;
}

Side sideOf(detail::BodySide side) {
  return side == detail::BodySide::kLeft    ? Side::kLeft
         : side == detail::BodySide::kRight ? Side::kRight
                                            : Side::kCenter;
}

// Of "lhand", a side without a capital or a separator, the first letter goes.
std::vector<std::string> wordsWithoutSide(std::string_view name, Side side) {
  const std::vector<std::string> tokens = detail::wordsOfName(name);
  const bool hasWord =
      std::any_of(tokens.begin(), tokens.end(), [](const std::string& token) { return sideOf(token).has_value(); });
  std::vector<std::string> words;
  bool taken = side == Side::kCenter;
  for (const std::string& token : tokens) {
    const bool begins = !hasWord && token.size() > 2 && token[0] == (side == Side::kLeft ? 'l' : 'r');
    if (!taken && begins) words.push_back(token.substr(1));
    if (!taken && (begins || sideOf(token) == side)) {
      taken = true;
    } else {
      words.push_back(token);
    }
  }
  return words;
}

}  // namespace

NameParts partsOfName(std::string_view name) {
  NameParts parts;
  parts.side = readJointWords(name).side;
  parts.words = wordsWithoutSide(name, parts.side);
  const auto says = [](const std::string& word) {
    return !detail::isNoiseWord(word) && std::isdigit(static_cast<unsigned char>(word.front())) == 0;
  };
  if (std::any_of(parts.words.begin(), parts.words.end(), says)) {
    std::erase_if(parts.words, [](const std::string& word) { return detail::isNoiseWord(word); });
  }
  return parts;
}

std::string_view readNameOf(const Joint& joint) {
  return joint.declaredBone.empty() ? std::string_view(joint.name) : joint.declaredBone;
}

bool saysHips(std::string_view name) {
  return readJointWords(name).word == static_cast<std::size_t>(BodyWord::kHips);
}

bool saysMetapodial(std::string_view name) {
  const std::vector<std::string> tokens = detail::wordsOfName(name);
  return std::any_of(tokens.begin(), tokens.end(),
                     [](const std::string& token) { return lookUp(kExtraWords, token) == kMetapodial; });
}

std::vector<JointWords> wordsOfJoints(const Skeleton& skeleton) {
  std::vector<JointWords> words;
  for (const Joint& joint : skeleton.joints) words.push_back(readJointWords(readNameOf(joint)));
  return words;
}

std::vector<std::optional<NamedPartner>> partnersByName(const Skeleton& skeleton, std::span<const JointWords> words) {
  struct Sides {
    std::vector<Index> left, right;
  };
  std::map<std::string, Sides> bare;  // by the name without its side
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Side side = words[j].side;
    if (side == Side::kCenter) continue;
    std::string rest;
    for (const std::string& word : wordsWithoutSide(readNameOf(skeleton.joints[j]), side))
      rest.append("_").append(word);
    (side == Side::kLeft ? bare[rest].left : bare[rest].right).push_back(j);
  }
  std::vector<std::optional<NamedPartner>> partners(skeleton.jointCount());
  for (const auto& [name, sides] : bare) {
    if (sides.left.size() != 1 || sides.right.size() != 1) continue;
    partners[sides.left[0]] = NamedPartner{sides.right[0], true};
    partners[sides.right[0]] = NamedPartner{sides.left[0], false};
  }
  return partners;
}

std::optional<Index> fingerOfWord(std::size_t word) {
  constexpr auto kFirst = static_cast<std::size_t>(BodyWord::kThumb),
                 kLast = static_cast<std::size_t>(BodyWord::kLittle);
  return word >= kFirst && word <= kLast ? std::optional(static_cast<Index>(word - kFirst)) : std::nullopt;
}

JointWords readJointWords(std::string_view name) {
  JointWords words;
  const detail::BodyName whole = detail::readBodyName(name);
  const std::vector<std::string> tokens = detail::wordsOfName(name);
  std::string rest;
  std::optional<ExtraWord> extra;
  bool word = false;
  for (const std::string& token : tokens) {
    const std::optional<NameMark> mark = lookUp(kMarks, token);
    if (mark) words.marks[static_cast<std::size_t>(*mark)] = true;
    const bool isNumber = std::isdigit(static_cast<unsigned char>(token.front())) != 0;
    if (isNumber && word) words.marks[static_cast<std::size_t>(NameMark::kNumbered)] = true;
    if (const std::optional<Side> side = sideOf(token); side && words.side == Side::kCenter) words.side = *side;
    if (const std::optional<ExtraWord> found = lookUp(kExtraWords, token); found && !extra) extra = found;
    if (!mark) rest.append(rest.empty() ? "" : "_").append(token);
    word = word || !isNumber;
  }
  if (whole.word != BodyWord::kNone) {
    words.word = static_cast<std::size_t>(whole.word);
    if (whole.side != detail::BodySide::kMiddle) words.side = sideOf(whole.side);
    return words;
  }
  if (extra) {
    words.word = kBodyWords + static_cast<std::size_t>(*extra);
    return words;
  }
  const detail::BodyName bare = detail::readBodyName(rest);
  words.word = static_cast<std::size_t>(bare.word);
  if (words.side == Side::kCenter) words.side = sideOf(bare.side);
  return words;
}

}  // namespace limber
