// Skeletons to try solvers on, for tests, benchmarks and the evaluation.
#pragma once

#include <vector>

#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// `joints` joints along +Y, evenly spaced, `length` metres from the first to the last. At least 2 joints.
Skeleton straightChain(Index joints, double length);

// 60 joints, 1.7 m tall, in T-pose, facing +Z, its left at +X: the humanoid bones of VRM 1.0 with its names (all 55),
// and five ends: the head's top, the hands' and the toes' tips.
Skeleton practiceHumanoid();

// Its hands, feet and head, in this order, as effectors where they stand in rest pose.
std::vector<IkTarget> practiceHumanoidTargets(const Skeleton& humanoid);

}  // namespace limber
