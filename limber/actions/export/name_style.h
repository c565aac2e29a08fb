// How programs spell the names of joints: words, numbers and the side.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "limber/character/anatomy/anatomy.h"

namespace limber {

enum class NameStyle {
  kSnake,      // upper_arm_twist_01_l
  kPascal,     // LeftUpperArmTwist01
  kCamel,      // leftUpperArmTwist01
  kDotted,     // upper_arm_twist.01.L
  kRigify,     // DEF-upper_arm_twist.01.L
  kMixamo,     // mixamorig:LeftUpperArmTwist01; ends of bones are LeftToe_End
  kActorCore,  // CC_Base_L_UpperArmTwist01
};

// The words, in small letters and numbers apart, as one name without its side.
std::string spellStem(std::span<const std::string> words, NameStyle style);

// How a name of that style says left or right: "l", "Left".
std::string_view sideWord(Side side, NameStyle style);

// A name of that stem.
std::string spellName(std::string_view stem, Side side, NameStyle style);

}  // namespace limber
