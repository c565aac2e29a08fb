// Skeletons that are laid along the curves of a body, whatever its proportions and however many legs it has.
#pragma once

#include <span>
#include <string_view>

#include "limber/rigging/shape/shape_reading.h"
#include "limber/rigging/templates/template_fit.h"

namespace limber {

// A kind of body that is told by its plan. Joints of all kinds are named by one rule: hips, spine, chest, neck, head
// and tail along the trunk; per side UpperLeg, LowerLeg and Foot of one pair of legs, with Front and Hind before them
// of two, with numbers behind them of more (from the front: none, 1, 2, ...); UpperArm or UpperWing and what is below;
// Fin.
struct PlanKind {
  std::string_view name;     // "fish"
  std::string_view summary;  // one line for --help
  BodyPlan plan;
  std::size_t fewestLegs, maxLegs;  // pairs
  bool hasWings = false;
};

std::span<const PlanKind> planKinds();
const PlanKind* findPlanKind(std::string_view name);  // null where there is none

// How sure it is that a body is of the kind: the reading's confidence, of crawlers the less the higher they stand; or
// 0.
double likelihood(const PlanKind& kind, const ShapeReading& reading);

// The kind's skeleton in the body. Positions are in body space (of the reading's frame).
// Throws Error kUnsupported where the body has too few legs for it, or too many.
TemplateFit fitPlan(const PlanKind& kind, const ShapeReading& reading);

}  // namespace limber
