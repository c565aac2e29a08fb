// The analytic solution for two bones: upper arm and forearm, thigh and shin.
#pragma once

#include <memory>
#include <optional>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// Positions as they are, in one space. Neither bone has length 0.
struct TwoBone {
  Vec3 start, middle, end;
  Vec3 target;               // for `end`
  std::optional<Vec3> pole;  // the middle bends towards this point; none: to the side to which it bends now
  Vec3 straightNormal =
      Vec3::UnitX();  // normal of the bend where the bones are straight and the pole, if any, does not say
};

// Rotations in that space. The start joint's new global rotation is start * old, the middle's is middle * old (`middle`
// contains what it takes over from the start). The middle joint turns about the normal of its bend only. A target out
// of reach stretches or folds the bones towards it.
struct TwoBoneTurns {
  Quat start, middle;
};

// Law of cosines; no trigonometry, no allocation, about 100 ns.
TwoBoneTurns solveTwoBone(const TwoBone& bones);

// Where these turns bring the middle and the end, in half the time.
struct TwoBonePositions {
  Vec3 middle, end;
};
TwoBonePositions twoBonePositions(const TwoBone& bones);

// The method: each target moves its joint, its parent and its grandparent (the base; the default base is the
// grandparent's root, so name it). Orientations turn the effector's own joint. Refuses effectors that have joints in
// common or have not exactly two bones.
std::unique_ptr<IkIteration> makeTwoBone(const IkSystem& system);

}  // namespace limber
