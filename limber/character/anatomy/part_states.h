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

}  // namespace limber
