// Selectively damped least squares: each singular direction as far as it is sensible.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// Buss, Kim: Selectively Damped Least Squares for Inverse Kinematics, 2005, with the singular vectors from J * J^T.
std::unique_ptr<IkIteration> makeSelectivelyDamped(const IkSystem& system);

}  // namespace limber
