// Particle IK: joints are particles, bones are distances between them.
#pragma once

#include <memory>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

// After Hecker and others 2008 (Spore): joints become particles joined by distance constraints, relaxed one after the
// other (Jakobsen 2001). First those above several effectors, the spine, which limbs that are too short pull along;
// then each limb, its tip pinned at the target. Rotations are fitted to the particles and bent into limits
// (GoalIteration).
std::unique_ptr<IkIteration> makeParticleIk(const IkSystem& system);

}  // namespace limber
