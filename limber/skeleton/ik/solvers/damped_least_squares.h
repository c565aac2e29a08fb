// Damped least squares: a step that balances reaching the targets against turning far.
#pragma once

#include <memory>
#include <vector>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// (J * J^T + damping * I)^-1 by Cholesky. The damping is a fraction of the squared distance left to go, so that it
// needs no constant of the model's size and vanishes as the targets are reached (Sugihara 2011; Wampler 1986; Nakamura,
// Hanafusa 1986).
std::unique_ptr<IkIteration> makeDampedLeastSquares(const IkSystem& system);

// The same with a weight of each node's movement (#nodes, 0 or more) and another fraction.
std::unique_ptr<IkIteration> makeDampedIteration(const IkSystem& system, std::vector<double> gains, double fraction);

}  // namespace limber
