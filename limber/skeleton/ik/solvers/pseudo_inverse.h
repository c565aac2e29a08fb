// The smallest step that, to first order, reaches the targets.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// Moore-Penrose by the eigenvectors of J * J^T; directions in which the effectors hardly move are left out (Whitney
// 1969; Maciejewski, Klein 1989).
std::unique_ptr<IkIteration> makePseudoInverse(const IkSystem& system);

}  // namespace limber
