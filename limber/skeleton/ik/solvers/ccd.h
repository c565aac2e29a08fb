// Cyclic coordinate descent: one joint after the other turns so that its effectors come nearest to their targets.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// From the tips to the bases (as usual: the tips bend most), or from the bases to the tips. A joint above several
// effectors takes the rotation best for all of them by weight. Joints with one or two axes turn about those by the best
// angle. With limits a rotation that would not bring the effectors nearer is not made. Cost: O(nodes * effectors) for
// each iteration, one sweep.
std::unique_ptr<IkIteration> makeCcdBackward(const IkSystem& system);
std::unique_ptr<IkIteration> makeCcdForward(const IkSystem& system);

}  // namespace limber
