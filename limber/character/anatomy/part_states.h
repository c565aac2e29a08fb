// The states that the labelling tells apart: a kind of part, and of legs and arms the segment. Internal to the module.
#pragma once

#include <array>
#include <string_view>

#include "limber/character/anatomy/body_part.h"

namespace limber {

enum class PartState : unsigned char {
  kOther,
  kTrunk,
  kNeck,
  kHead,
  kTail,
  kLegBase,
  kLegUpper,
  kLegMiddle,
  kLegHock,
  kLegEnd,
  kLegToes,
  kArmBase,
  kArmUpper,
  kArmMiddle,
  kArmEnd,
  kWing,
  kFin,
  kFinger,
  kEar,
  kJaw,
  kEye,
  kHair,
  kProp,
  kAttachment,
};
inline constexpr std::size_t kPartStates = 24;  // of PartState

constexpr PartKind kindOf(PartState state) {
  constexpr std::array<PartKind, kPartStates> kKinds = {
      PartKind::kOther, PartKind::kTrunk, PartKind::kNeck, PartKind::kHead, PartKind::kTail, PartKind::kLeg,
      PartKind::kLeg,   PartKind::kLeg,   PartKind::kLeg,  PartKind::kLeg,  PartKind::kLeg,  PartKind::kArm,
      PartKind::kArm,   PartKind::kArm,   PartKind::kArm,  PartKind::kWing, PartKind::kFin,  PartKind::kFinger,
      PartKind::kEar,   PartKind::kJaw,   PartKind::kEye,  PartKind::kHair, PartKind::kProp, PartKind::kAttachment};
  return kKinds[static_cast<std::size_t>(state)];
}

// kWhole of what is told apart by its kind alone.
constexpr Segment segmentOf(PartState state) {
  switch (state) {
    case PartState::kLegBase:
    case PartState::kArmBase:
      return Segment::kBase;
    case PartState::kLegUpper:
    case PartState::kArmUpper:
      return Segment::kUpper;
    case PartState::kLegMiddle:
    case PartState::kArmMiddle:
      return Segment::kMiddle;
    case PartState::kLegHock:
      return Segment::kHock;
    case PartState::kLegEnd:
    case PartState::kArmEnd:
      return Segment::kEnd;
    case PartState::kLegToes:
      return Segment::kToes;
    default:
      return Segment::kWhole;
  }
}

}  // namespace limber
