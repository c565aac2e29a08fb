#include "limber/character/anatomy/body_part.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

namespace limber {

namespace {

constexpr std::array<std::array<std::string_view, 3>, 5> kFingerBones = {{
    {"ThumbMetacarpal", "ThumbProximal", "ThumbDistal"},
    {"IndexProximal", "IndexIntermediate", "IndexDistal"},
    {"MiddleProximal", "MiddleIntermediate", "MiddleDistal"},
    {"RingProximal", "RingIntermediate", "RingDistal"},
    {"LittleProximal", "LittleIntermediate", "LittleDistal"},
}};

std::string_view legSegment(Segment segment) {
  constexpr std::array<std::string_view, 7> kNames = {"Leg", "Hip", "UpperLeg", "LowerLeg", "Hock", "Foot", "Toes"};
  return kNames[static_cast<std::size_t>(segment)];
}

std::string_view armSegment(Segment segment) {
  constexpr std::array<std::string_view, 7> kNames = {"Arm",     "Shoulder", "UpperArm", "LowerArm",
                                                      "ArmHock", "Hand",     "ArmToes"};
  return kNames[static_cast<std::size_t>(segment)];
}

std::string capital(std::string_view word) {
  std::string text(word);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// Without side, pair and piece.
std::string stem(const BodyPart& part) {
  if (part.kind == PartKind::kTrunk && part.segment == Segment::kBase) return "Hips";
  if (part.kind == PartKind::kLeg) return std::string(legSegment(part.segment));
  if (part.kind == PartKind::kArm) return std::string(armSegment(part.segment));
  return capital(nameOf(part.kind));
}

// Without numbers, and without the names that VRM has for fingers.
std::string plainNameOf(const BodyPart& part) {
  std::string name = std::string(part.side == Side::kCenter ? "" : nameOf(part.side)) + stem(part);
  if (part.side == Side::kCenter) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

// Every name without its numbers, to the part.
const std::map<std::string, BodyPart, std::less<>>& stems() {
  static const std::map<std::string, BodyPart, std::less<>> kStems = [] {
    std::map<std::string, BodyPart, std::less<>> all;
    for (std::size_t k = 0; k + 1 < kPartKinds; ++k) {
      const auto kind = static_cast<PartKind>(k);
      const bool limb = kind == PartKind::kLeg || kind == PartKind::kArm;
      for (int s = 0; s < 7; ++s) {
        if (s > 0 && !limb && !(kind == PartKind::kTrunk && s == 1)) continue;
        for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
          const BodyPart part{kind, side, 0, static_cast<Segment>(s), 0};
          all.emplace(plainNameOf(part), part);
        }
      }
    }
    return all;
  }();
  return kStems;
}

// Takes a number off the end, if there is one.
std::optional<Index> takeNumber(std::string_view& name) {
  std::size_t begin = name.size();
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1]))) --begin;
  if (begin == name.size() || name.size() - begin > 6) return std::nullopt;
  Index number = 0;
  for (const char digit : name.substr(begin)) number = 10 * number + static_cast<Index>(digit - '0');
  name = name.substr(0, begin);
  return number;
}

}  // namespace

std::string nameOf(const BodyPart& part) {
  if (part.kind == PartKind::kFinger && part.side != Side::kCenter && part.pair < 5 && part.piece < 3) {
    return std::string(nameOf(part.side)) + std::string(kFingerBones[part.pair][part.piece]);
  }
  std::string name = plainNameOf(part);
  if (part.pair > 0) name += std::to_string(part.pair + 1);
  if (part.piece > 0) name += "Piece" + std::to_string(part.piece + 1);
  return name;
}

std::optional<BodyPart> bodyPartNamed(std::string_view name) {
  for (const Side side : kSides) {
    const std::string_view word = nameOf(side);
    if (!name.starts_with(word)) continue;
    for (Index finger = 0; finger < kFingerBones.size(); ++finger) {
      for (Index piece = 0; piece < 3; ++piece) {
        if (name.substr(word.size()) == kFingerBones[finger][piece]) {
          return BodyPart{PartKind::kFinger, side, finger, Segment::kWhole, piece};
        }
      }
    }
  }
  std::string_view rest = name;
  Index piece = 0;
  constexpr std::string_view kPiece = "Piece";
  std::string_view before = rest;
  if (const std::optional<Index> number = takeNumber(before); number && *number > 1 && before.ends_with(kPiece)) {
    piece = *number - 1;
    rest = before.substr(0, before.size() - kPiece.size());
  }
  before = rest;
  Index pair = 0;
  if (const std::optional<Index> number = takeNumber(before); number && *number > 1) {
    pair = *number - 1;
    rest = before;
  }
  const auto found = stems().find(rest);
  if (found == stems().end()) return std::nullopt;
  BodyPart part = found->second;
  part.pair = pair;
  part.piece = piece;
  return nameOf(part) == name ? std::optional(part) : std::nullopt;
}

std::optional<BodyPart> bodyPartAt(const Anatomy& anatomy, Index joint) {
  if (!anatomy.partOf[joint]) return std::nullopt;
  const Part& part = anatomy.parts[*anatomy.partOf[joint]];
  BodyPart piece{part.kind, part.side, part.pair, Segment::kWhole, 0};
  const std::array<std::pair<std::optional<Index>, Segment>, 5> landmarks = {{{part.upper, Segment::kUpper},
                                                                              {part.middle, Segment::kMiddle},
                                                                              {part.hock, Segment::kHock},
                                                                              {part.end, Segment::kEnd},
                                                                              {part.toes, Segment::kToes}}};
  if (part.upper && part.upper != part.joints.front()) piece.segment = Segment::kBase;
  for (const Index along : part.joints) {
    for (const auto& [landmark, segment] : landmarks) {
      if (landmark == along) piece.segment = segment;
    }
    if (along == joint) return piece;
  }
  piece.segment = Segment::kWhole;  // it branches off
  return piece;
}

std::string labelOf(const Anatomy& anatomy, Index joint) {
  const std::optional<BodyPart> part = bodyPartAt(anatomy, joint);
  if (!part) return "";
  const Index pairs = anatomy.pairsOf(part->kind);
  const bool isLimb = part->kind == PartKind::kLeg || part->kind == PartKind::kArm;
  std::string label;
  const auto say = [&](std::string_view word) {
    if (!label.empty()) label.push_back(' ');
    label.append(word);
  };
  if (part->side != Side::kCenter) say(nameOf(part->side));
  if (isLimb && pairs == 2) say(part->pair == 0 ? "front" : "hind");
  for (const char c : stem(*part)) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isupper(letter)) say("");
    label.push_back(static_cast<char>(std::tolower(letter)));
  }
  if (part->pair > 0 && !(isLimb && pairs == 2)) say(std::to_string(part->pair + 1));
  return label;
}

}  // namespace limber
