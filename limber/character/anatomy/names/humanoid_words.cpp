#include "limber/character/anatomy/names/humanoid_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <utility>

namespace limber::detail {

namespace {

using Word = std::pair<std::string_view, BodyWord>;

// Compounds are written together: tokens are joined before they are looked up.
constexpr std::array kWords = {
    Word{"hips", BodyWord::kHips},
    Word{"hip", BodyWord::kHips},
    Word{"pelvis", BodyWord::kHips},
    Word{"spine", BodyWord::kTrunk},
    Word{"spinebase", BodyWord::kTrunk},
    Word{"spinemid", BodyWord::kTrunk},
    Word{"spinelower", BodyWord::kTrunk},
    Word{"spineupper", BodyWord::kTrunk},
    Word{"spineshoulder", BodyWord::kTrunk},
    Word{"chest", BodyWord::kTrunk},
    Word{"upperchest", BodyWord::kTrunk},
    Word{"chestupper", BodyWord::kTrunk},
    Word{"chestlower", BodyWord::kTrunk},
    Word{"abdomen", BodyWord::kTrunk},
    Word{"abdomenlower", BodyWord::kTrunk},
    Word{"abdomenupper", BodyWord::kTrunk},
    Word{"ab", BodyWord::kTrunk},
    Word{"belly", BodyWord::kTrunk},
    Word{"waist", BodyWord::kTrunk},
    Word{"torso", BodyWord::kTrunk},
    Word{"thorax", BodyWord::kTrunk},
    Word{"back", BodyWord::kTrunk},
    Word{"lowerback", BodyWord::kTrunk},
    Word{"upperback", BodyWord::kTrunk},
    Word{"neck", BodyWord::kNeck},
    Word{"lowerneck", BodyWord::kNeck},
    Word{"upperneck", BodyWord::kNeck},
    Word{"necklower", BodyWord::kNeck},
    Word{"neckupper", BodyWord::kNeck},
    Word{"head", BodyWord::kHead},
    Word{"skull", BodyWord::kHead},
    Word{"jaw", BodyWord::kJaw},
    Word{"eye", BodyWord::kEye},
    Word{"collar", BodyWord::kCollar},
    Word{"collarbone", BodyWord::kCollar},
    Word{"clavicle", BodyWord::kCollar},
    Word{"shoulder", BodyWord::kShoulder},
    Word{"arm", BodyWord::kArm},
    Word{"upperarm", BodyWord::kUpperArm},
    Word{"uparm", BodyWord::kUpperArm},
    Word{"uarm", BodyWord::kUpperArm},
    Word{"shldr", BodyWord::kUpperArm},
    Word{"humerus", BodyWord::kUpperArm},
    Word{"bicep", BodyWord::kUpperArm},
    Word{"lowerarm", BodyWord::kLowerArm},
    Word{"lowarm", BodyWord::kLowerArm},
    Word{"loarm", BodyWord::kLowerArm},
    Word{"farm", BodyWord::kLowerArm},
    Word{"forearm", BodyWord::kLowerArm},
    Word{"elbow", BodyWord::kLowerArm},
    Word{"radius", BodyWord::kLowerArm},
    Word{"hand", BodyWord::kHand},
    Word{"wrist", BodyWord::kHand},
    Word{"palm", BodyWord::kHand},
    Word{"fist", BodyWord::kHand},
    Word{"leg", BodyWord::kLeg},
    Word{"upperleg", BodyWord::kUpperLeg},
    Word{"upleg", BodyWord::kUpperLeg},
    Word{"uleg", BodyWord::kUpperLeg},
    Word{"thigh", BodyWord::kUpperLeg},
    Word{"femur", BodyWord::kUpperLeg},
    Word{"midleg", BodyWord::kMiddleLeg},
    Word{"middleleg", BodyWord::kMiddleLeg},
    Word{"lowerleg", BodyWord::kLowerLeg},
    Word{"lowleg", BodyWord::kLowerLeg},
    Word{"loleg", BodyWord::kLowerLeg},
    Word{"knee", BodyWord::kLowerLeg},
    Word{"calf", BodyWord::kLowerLeg},
    Word{"shin", BodyWord::kLowerLeg},
    Word{"tibia", BodyWord::kLowerLeg},
    Word{"foot", BodyWord::kFoot},
    Word{"ankle", BodyWord::kFoot},
    Word{"toes", BodyWord::kToes},
    Word{"toe", BodyWord::kToes},
    Word{"toebase", BodyWord::kToes},
    Word{"ball", BodyWord::kToes},
};

constexpr std::array kFingers = {
    Word{"thumb", BodyWord::kThumb},   Word{"index", BodyWord::kIndex},   Word{"middle", BodyWord::kMiddle},
    Word{"mid", BodyWord::kMiddle},    Word{"ring", BodyWord::kRing},     Word{"pinky", BodyWord::kLittle},
    Word{"pinkie", BodyWord::kLittle}, Word{"little", BodyWord::kLittle},
};

// Joints that move nothing of their own, and limbs that no person has.
constexpr std::array<std::string_view, 36> kHelpers = {
    "end",    "tip",        "leaf",       "nub",         "site",    "eff",    "effector", "ik",     "fk",
    "pole",   "target",     "poletarget", "ctrl",        "twist",   "roll",   "helper",   "slot",   "weapon",
    "mch",    "control",    "front",      "rear",        "hind",    "wing",   "tail",     "fin",    "in",
    "carpal", "metacarpal", "metatarsal", "metatarsals", "buttock", "breast", "ear",      "socket", "hair"};

// Words of programs and pipelines that say nothing of the body.
constexpr std::array<std::string_view, 24> kNoise = {
    "bip", "biped", "valvebiped", "mixamorig", "rig",  "def",  "org",       "j", "c",   "b",    "bone", "joint",
    "jnt", "sk",    "skeleton",   "cc",        "base", "bend", "character", "f", "sec", "part", "m",    "center"};

template <typename List>
bool has(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

template <typename List>
std::optional<BodyWord> lookUp(const List& list, std::string_view word) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Word& entry) { return entry.first == word; });
  return found == list.end() ? std::nullopt : std::optional(found->second);
}

enum class Letter { kUpper, kLower, kDigit, kOther };

Letter letterOf(char c) {
  const auto u = static_cast<unsigned char>(c);
  if (std::isupper(u)) return Letter::kUpper;
  if (std::islower(u)) return Letter::kLower;
  return std::isdigit(u) ? Letter::kDigit : Letter::kOther;
}

}  // namespace

// "LHipJoint" -> l, hip, joint; "finger2-1.L" -> finger, 2, 1, l.
std::vector<std::string> wordsOfName(std::string_view name) {
  const std::size_t space = name.find_last_of(":|");
  if (space != std::string_view::npos) name.remove_prefix(space + 1);
  std::vector<std::string> tokens;
  Letter last = Letter::kOther;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const Letter now = letterOf(name[i]);
    const bool nextIsLower = i + 1 < name.size() && letterOf(name[i + 1]) == Letter::kLower;
    // A word begins at a capital after a small letter, and at the last of several capitals ("LHip").
    const bool word = now == Letter::kUpper && (last != Letter::kUpper || nextIsLower);
    const bool begins = word || (now == Letter::kDigit) != (last == Letter::kDigit) || last == Letter::kOther;
    if (now != Letter::kOther) {
      if (begins) tokens.emplace_back();
      tokens.back().push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(name[i]))));
    }
    last = now;
  }
  return tokens;
}

namespace {

bool isNumber(const std::string& token) {
  return letterOf(token.front()) == Letter::kDigit;
}

std::optional<BodySide> sideOf(std::string_view token) {
  if (token == "l" || token == "left" || token == "lft") return BodySide::kLeft;
  if (token == "r" || token == "right" || token == "rgt") return BodySide::kRight;
  return std::nullopt;
}

BodyName named(BodyWord word, BodySide side, double confidence) {
  const bool sided = word > BodyWord::kJaw;
  if (sided && side == BodySide::kMiddle) return {};
  if (word == BodyWord::kHips && side != BodySide::kMiddle) word = BodyWord::kHip;
  if (!sided && word != BodyWord::kHip && side != BodySide::kMiddle) return {};
  return {word, side, confidence};
}

// Biped's Finger0 (thumb) to Finger42 and MakeHuman's finger1-1 (thumb) to finger5-3.
std::optional<BodyWord> numberedFinger(const std::vector<std::string>& numbers) {
  constexpr std::array kOrder = {BodyWord::kThumb, BodyWord::kIndex, BodyWord::kMiddle, BodyWord::kRing,
                                 BodyWord::kLittle};
  if (numbers.empty()) return std::nullopt;
  const int first = numbers.front().front() - '0' - (numbers.size() > 1 ? 1 : 0);
  if (first < 0 || first > 4) return std::nullopt;
  return kOrder[static_cast<std::size_t>(first)];
}

struct Tokens {
  std::vector<std::string> words;
  std::vector<std::string> numbers;  // those after the last word
  BodySide side = BodySide::kMiddle;
  bool helper = false;
};

Tokens sortTokens(std::string_view name) {
  Tokens sorted;
  std::vector<std::string> all = wordsOfName(name);
  for (std::string& token : all) {
    const std::optional<BodySide> side = sideOf(token);
    // OptiTrack's "LUArm", "RFArm".
    const bool sideAndShort = token == "lu" || token == "ru" || token == "lf" || token == "rf";
    if (sideAndShort && sorted.side == BodySide::kMiddle) {
      sorted.side = token[0] == 'l' ? BodySide::kLeft : BodySide::kRight;
      sorted.words.push_back(token.substr(1));
    } else if (isNumber(token)) {
      sorted.numbers.push_back(std::move(token));
    } else if (side && sorted.side == BodySide::kMiddle) {
      sorted.side = *side;
    } else if (has(kHelpers, token) && !(token == "metacarpal" && has(sorted.words, "thumb"))) {
      sorted.helper = true;
    } else {
      sorted.words.push_back(std::move(token));
      sorted.numbers.clear();
    }
  }
  // "lhand", "rthumb": a side without a capital or a separator.
  if (sorted.side == BodySide::kMiddle && sorted.words.size() == 1 && sorted.words[0].size() > 2) {
    const std::string rest = sorted.words[0].substr(1);
    const std::optional<BodySide> side = sideOf(sorted.words[0].substr(0, 1));
    if (side && (lookUp(kWords, rest) || lookUp(kFingers, rest) || rest == "hipjoint")) {
      sorted.side = *side;
      sorted.words[0] = rest == "hipjoint" ? "hip" : rest;
    }
  }
  return sorted;
}

// "HandIndex1", "index finger", "IndexProximal"; not "middle hand", "mid leg".
std::optional<BodyWord> fingerOf(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 5> kAfter = {"finger", "proximal", "intermediate", "distal", "metacarpal"};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::optional<BodyWord> finger = lookUp(kFingers, words[i]);
    if (finger && (i + 1 == words.size() || has(kAfter, words[i + 1]))) return finger;
  }
  return std::nullopt;
}

std::string join(const std::vector<std::string>& words, bool withNoise) {
  std::string joined;
  for (const std::string& word : words) {
    if (withNoise || !has(kNoise, word)) joined += word;
  }
  return joined;
}

}  // namespace

bool isNoiseWord(std::string_view word) {
  return has(kNoise, word);
}

BodyName readBodyName(std::string_view name) {
  if (name.substr(0, 2) == "__") return {};  // MakeHuman's links
  constexpr std::array<std::string_view, 4> kXsensSpine = {"L5", "L3", "T12", "T8"};
  if (has(kXsensSpine, name)) return {BodyWord::kTrunk, BodySide::kMiddle, 0.95};

  const Tokens tokens = sortTokens(name);
  if (tokens.helper) return {};
  for (const bool withNoise : {true, false}) {
    const std::string joined = join(tokens.words, withNoise);
    if (joined == "finger" || joined == "toe") {
      const std::optional<BodyWord> finger = joined == "finger" ? numberedFinger(tokens.numbers) : std::nullopt;
      if (finger) return named(*finger, tokens.side, 0.9);
    }
    if (const std::optional<BodyWord> word = lookUp(kWords, joined)) return named(*word, tokens.side, 0.95);
  }
  if (tokens.side != BodySide::kMiddle) {
    if (const std::optional<BodyWord> finger = fingerOf(tokens.words)) return named(*finger, tokens.side, 0.95);
  }
  // A model's own name before the word: "eric_upperarm_l". Legs and feet at the back are an animal's.
  if (tokens.words.size() < 2 || has(tokens.words, "back")) return {};
  const std::string lastTwo = tokens.words[tokens.words.size() - 2] + tokens.words.back();
  if (const std::optional<BodyWord> word = lookUp(kWords, lastTwo)) return named(*word, tokens.side, 0.7);
  if (const std::optional<BodyWord> word = lookUp(kWords, tokens.words.back())) return named(*word, tokens.side, 0.7);
  return {};
}

}  // namespace limber::detail
