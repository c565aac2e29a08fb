// Many effectors at once on a body, its root moving if allowed.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// Damped least squares with strict priorities (Baerlocher, Boulic 2004), in which a joint that carries more of the body
// turns less for the same gain: arms reach before the trunk bends, and the root moves last.
std::unique_ptr<IkIteration> makeWholeBody(const IkSystem& system);

}  // namespace limber
