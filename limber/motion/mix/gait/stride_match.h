// Which footfall of one motion is which of another.
#pragma once

#include <span>

#include "limber/motion/mix/gait/footfalls.h"
#include "limber/motion/mix/gait/gait_phase.h"

namespace limber {

// Two motions on one scale: equal phases are equal moments of a step.
struct StridePhases {
  GaitPhase a, b;
  std::size_t matched = 0;  // footfalls that meet
  double stride = 1;        // after that much of the scale the same foot comes down again
};

// Every alignment of the footfalls of `b` with those of `a`, one after the other, in which at least one meets another
// and feet agree (after Park, Shin, Shin 2002, On-line locomotion generation based on motion blending; Menardais,
// Kulpa, Multon, Arnaldi 2004, Synchronization for dynamic blending of motions): those in which most meet first, of
// equal ones those that shift one against the other by the fewest footfalls. Where feet come down in other orders (a
// walk and a gallop) only the footfalls of one foot are aligned, of the foot that has most. None where one of the
// motions has no two footfalls to match. O(footfalls^2).
std::vector<StridePhases> matchStrides(std::span<const Footfall> a, std::span<const Footfall> b);

}  // namespace limber
