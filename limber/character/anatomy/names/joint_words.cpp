#include "limber/character/anatomy/names/joint_words.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limber/character/anatomy/names/humanoid_words.h"
#include "limber/core/text/split_text.h"

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

constexpr std::size_t numberOf(BodyWord word) {
  return static_cast<std::size_t>(word);
}
constexpr std::size_t numberOf(ExtraWord word) {
  return kBodyWords + static_cast<std::size_t>(word);
}

// The words of roles; tips and helpers have marks instead.
constexpr std::pair<JointRole, std::size_t> kRoleWords[] = {{JointRole::kRoot, numberOf(kRoot)},
                                                            {JointRole::kAttachment, numberOf(kCloth)},
                                                            {JointRole::kHips, numberOf(BodyWord::kHips)},
                                                            {JointRole::kTrunk, numberOf(BodyWord::kTrunk)},
                                                            {JointRole::kSpineToHead, numberOf(BodyWord::kTrunk)},
                                                            {JointRole::kNeck, numberOf(BodyWord::kNeck)},
                                                            {JointRole::kHead, numberOf(BodyWord::kHead)},
                                                            {JointRole::kJaw, numberOf(BodyWord::kJaw)},
                                                            {JointRole::kEye, numberOf(BodyWord::kEye)},
                                                            {JointRole::kCollar, numberOf(BodyWord::kCollar)},
                                                            {JointRole::kUpperArm, numberOf(BodyWord::kUpperArm)},
                                                            {JointRole::kLowerArm, numberOf(BodyWord::kLowerArm)},
                                                            {JointRole::kHand, numberOf(BodyWord::kHand)},
                                                            {JointRole::kLegBase, numberOf(BodyWord::kHip)},
                                                            {JointRole::kUpperLeg, numberOf(BodyWord::kUpperLeg)},
                                                            {JointRole::kLowerLeg, numberOf(BodyWord::kLowerLeg)},
                                                            {JointRole::kHock, numberOf(kMetapodial)},
                                                            {JointRole::kPalm, numberOf(kMetapodial)},
                                                            {JointRole::kFoot, numberOf(BodyWord::kFoot)},
                                                            {JointRole::kToes, numberOf(BodyWord::kToes)},
                                                            {JointRole::kThumb, numberOf(BodyWord::kThumb)},
                                                            {JointRole::kIndex, numberOf(BodyWord::kIndex)},
                                                            {JointRole::kMiddle, numberOf(BodyWord::kMiddle)},
                                                            {JointRole::kRing, numberOf(BodyWord::kRing)},
                                                            {JointRole::kLittle, numberOf(BodyWord::kLittle)},
                                                            {JointRole::kTail, numberOf(kTail)},
                                                            {JointRole::kHair, numberOf(kHair)},
                                                            {JointRole::kEar, numberOf(kEar)},
                                                            {JointRole::kWing, numberOf(kWing)}};

// In the languages that artists write them in; words that also mean a part of the body are left out.
struct ExtraWords {
  ExtraWord meaning;
  std::string_view words;  // separated by spaces
};
constexpr ExtraWords kExtraWords[] = {
    {kTail, "tail shippo sippo schwanz schweif hvost khvost"},
    {kWing, "wing wings tsubasa fluegel aile krylo"},
    {kFin, "fin fins flipper pectoral dorsal"},
    {kEar, "ear ears mimi ohr oreille oreja uho"},
    {kMouth, "mouth snout beak lip lips bill teeth chin jawbone"},
    {kHair,
     "hair hairs mane ponytail pony twintail pigtail braid bang bangs fringe sidelock sideburn ahoge wig beard "
     "mustache "
     "kami maegami haar haare zopf cheveux pelo cabello coleta trenza volosy kosa"},
    {kDigit, "finger fingers digit"},
    {kProp,
     "prop weapon gun sword shield item bag backpack knife axe bow slot mug staff holster sheath scabbard quiver "
     "lantern "
     "wand spear hammer schwert arme espada mech"},
    {kRoot, "root armature master main global cog reference"},
    {kFeather, "feather feathers"},
    {kHorn, "horn horns antenna antler spike tsuno corne cuerno"},
    {kCloth,
     "skirt cape cloth robe cloak mantle mantel scarf muffler coat jacket dress hem apron frill lace tunic tabard "
     "loincloth "
     "sash obi sleeve cuff hood tie necktie ribbon strap belt buckle string cord rope tassel pendant necklace earring "
     "pouch "
     "hat helmet veil glasses pauldron armor tasset himo suso sode manto fuku jupe kleid umhang kapuze schal falda "
     "vestido "
     "capa capucha yubka plash remen qun"},
    {kBlade, "scapula blade"},
    {kHoof, "hoof paw"},
    {kClaw, "claw"},
    {kBody, "body"},
    {kEyelid, "eyelid eyebrow"},
    {kBreast,
     "breast breasts boob boobs bust tit mune oppai butt buttock buttocks glute siri shiri ribs busen sein seno"},
    {kTongue, "tongue"},
    {kMetapodial, "hock metatarsal metatarsals carpal metacarpal"},
};

// Words of scripts that do not separate them: any name that contains one.
constexpr ExtraWords kContained[] = {
    {kCloth,
     "スカート 裙 치마 スカーフ マント 披风 斗篷 披風 망토 コート ドレス 服 衣 裾 袖 帯 帶 ベルト 벨트 リボン 리본 "
     "蝴蝶 ネクタイ 领带 マフラー 围巾 "
     "フード フリル 飘带 紐 ひも 帽 帽子 юбка плащ"},
    {kHair, "髪 髮 头发 前发 刘海 马尾 辫 アホ毛 あほ毛 もみあげ ツインテ おさげ 三つ編み 머리카락 헤어 волос"},
    {kBreast, "胸 乳 おっぱい 가슴 尻 臀"},
    {kTail, "しっぽ 尻尾 尾 꼬리 хвост"},
    {kEar, "耳 귀"},
    {kWing, "翼 羽 翅 날개"},
    {kHorn, "角 뿔"},
    {kProp, "剣 剑 刀 銃 枪 武器 무기 меч"},
};

std::optional<ExtraWord> extraWordOf(const std::string& word) {
  static const std::unordered_map<std::string_view, ExtraWord> kMeanings = [] {
    std::unordered_map<std::string_view, ExtraWord> meanings;
    for (const ExtraWords& row : kExtraWords) {
      for (const std::string_view each : wordsIn(row.words)) meanings.emplace(each, row.meaning);
    }
    return meanings;
  }();
  const auto found = kMeanings.find(word);
  return found == kMeanings.end() ? std::nullopt : std::optional(found->second);
}

std::optional<ExtraWord> containedWordOf(std::string_view name) {
  const auto isForeign = [](char c) { return static_cast<unsigned char>(c) > 0x7f; };
  if (std::none_of(name.begin(), name.end(), isForeign)) return std::nullopt;
  for (const ExtraWords& row : kContained) {
    for (const std::string_view each : wordsIn(row.words)) {
      if (name.find(each) != std::string_view::npos) return row.meaning;
    }
  }
  return std::nullopt;
}

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

JointWords wordsOfRole(const NamedRole& role) {
  JointWords words;
  words.side = role.side;
  if (role.role == JointRole::kTip) words.marks[static_cast<std::size_t>(NameMark::kEnd)] = true;
  if (role.role == JointRole::kHelper) words.marks[static_cast<std::size_t>(NameMark::kHelper)] = true;
  for (const auto& [known, word] : kRoleWords) {
    if (known == role.role) words.word = word;
  }
  return words;
}

bool saysHips(std::string_view name) {
  return readJointWords(name).word == numberOf(BodyWord::kHips);
}

bool saysMetapodial(std::string_view name) {
  const std::vector<std::string> tokens = detail::wordsOfName(name);
  const bool isNumbered = std::any_of(tokens.begin(), tokens.end(), [](const std::string& token) {
    return std::isdigit(static_cast<unsigned char>(token.front())) != 0;
  });
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
    return extraWordOf(token) == kMetapodial || (token == "palm" && isNumbered);  // "palm.01.L", not a hand's "Palm.L"
  });
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
  constexpr auto kFirst = numberOf(BodyWord::kThumb), kLast = numberOf(BodyWord::kLittle);
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
    if (const std::optional<ExtraWord> found = extraWordOf(token); found && !extra) extra = found;
    if (!mark) rest.append(rest.empty() ? "" : "_").append(token);
    word = word || !isNumber;
  }
  if (!extra) extra = containedWordOf(name);
  if (whole.word != BodyWord::kNone) {
    words.word = static_cast<std::size_t>(whole.word);
    if (whole.side != detail::BodySide::kMiddle) words.side = sideOf(whole.side);
    return words;
  }
  if (extra) {
    words.word = numberOf(*extra);
    return words;
  }
  const detail::BodyName bare = detail::readBodyName(rest);
  words.word = static_cast<std::size_t>(bare.word);
  if (words.side == Side::kCenter) words.side = sideOf(bare.side);
  return words;
}

}  // namespace limber
