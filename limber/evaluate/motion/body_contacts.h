// Poses in which a body touches itself, made by code on bodies of any proportions: hands on hips, crossed arms, hands
// together, chin on hand, hand on knee. Where a hand has to be on another body is known.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "limber/motion/retarget/retarget_method.h"

namespace limber {

// Of a person who is 1.75 m tall where all are 1. Lengths of bones and widths, each 0.5 to 2.
struct FigureShape {
  double arms = 1, legs = 1, trunk = 1, shoulders = 1, hips = 1;
};

// A person in T-pose with VRM's names, all rest rotations identities, who is capsules about the bones: the trunk as
// thick as 0.3 of the distance of the shoulders, a head 0.4 of its length, limbs 0.16 (thighs) and 0.13 (forearms) of
// theirs. So the surface is known from the skeleton alone.
Skeleton contactFigure(const FigureShape& shape);

// Base figure first, then arms, legs, trunk, shoulders and hips shorter and longer, one by one and together.
std::vector<FigureShape> contactFigures();

struct BodyContact {
  std::string_view name;        // "hands-on-hips"
  std::array<bool, 2> touches;  // left hand, right hand
};
std::array<BodyContact, 5> bodyContacts();

// From standing into the pose, which lasts for `kHoldFrames`, and back, 30 frames a second. Hands that do not reach
// come as near as they can.
PoseSequence contactMotion(const Skeleton& figure, const BodyContact& contact);

struct ContactScore {
  double reached = 0, farReached = 0;  // hands whose target is within the arm's reach, and those farther off
  double kept = 0;                     // of `reached`: within kKept of their target in the middle of the hold
  double worst = 0;                    // of `reached`: distance from the target over the body's height
  double farWorst = 0;                 // of the others: from the nearest point that the arm reaches, likewise
};
inline constexpr double kKept = 0.02;  // heights
inline constexpr std::size_t kHoldFrames = 20;

// From the base figure onto all figures.
ContactScore scoreContact(const RetargetMethod& method, const BodyContact& contact);

}  // namespace limber
