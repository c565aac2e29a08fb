// FABRIK: joints reach backward from the targets to the base and forward again, along straight lines.
#pragma once

#include <limits>
#include <memory>
#include <span>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

struct FabrikBone {
  FabrikBone() = default;
  explicit FabrikBone(double metres)
      : length(metres), perSquaredLength(metres > 0 ? 1 / (metres * metres) : std::numeric_limits<double>::max()) {
    linear = -1.25 * perSquaredLength;
    quadratic = 0.375 * perSquaredLength * perSquaredLength;
  }

  double length = 0;  // metres
  double perSquaredLength = std::numeric_limits<double>::max();
  double linear = 0, quadratic = 0;  // of length / distance near the length, as a series in the squared distance
};

// One unconstrained chain, positions only (Aristidou, Lasenby 2011). `positions` holds #n joints, the base first;
// `bones` #n - 1, bones[i] from joint i to i + 1. The last joint goes to `target` to within `tolerance`
// metres; a target out of reach stretches the chain towards it. The tip is pulled beyond the target by what the next
// iteration should leave, which halves the iterations. Returns those done. About 40 ns for each bone and iteration.
Index fabrikChain(std::span<Vec3> positions, std::span<const FabrikBone> bones, const Vec3& target, double tolerance,
                  Index budget);

// The method. A single free chain runs as above and is turned into rotations once, at the end. Everything else (trees,
// where a joint with several children goes to the weighted centroid of what they want; limits; stiffness;
// orientations; sliding joints) reaches backward by positions and forward by rotations, each best for all children of a
// joint and bent into its limits, so that every iteration ends in an allowed pose (after Aristidou, Chrysanthou,
// Lasenby 2016). A limited joint also twists to bring the effectors beyond the next joint nearer.
std::unique_ptr<IkIteration> makeFabrik(const IkSystem& system);

}  // namespace limber
