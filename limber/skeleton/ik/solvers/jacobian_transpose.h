// The Jacobian's transpose instead of its inverse.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// Steps down the gradient of the cost (Wolovich, Elliott 1984), as far as would be best were effectors to move linearly
// (Buss 2004), and together with the step before, so that steps do not zigzag (Stiefel 1952). Cheap steps, many of
// them.
std::unique_ptr<IkIteration> makeJacobianTranspose(const IkSystem& system);

}  // namespace limber
