// Bones with masses, pulled to the targets by springs.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// After Sekiguchi, Takesue 2020: targets pull at their effectors by springs as strong as their weights, bones have
// masses, and each iteration is one implicit step of the motion without speed carried over: (M / t^2 + J^T K J) dq =
// J^T K e, t from the steps' success. M is the diagonal of the joint-space inertia at the reference pose, bones being
// rods as heavy as they are long. So light tips go first and what carries much follows.
std::unique_ptr<IkIteration> makeMassSpring(const IkSystem& system);

}  // namespace limber
