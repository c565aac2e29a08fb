// What a person expects of a body that is posed: limbs follow, and feet stay where they stand.
#pragma once

#include <vector>

#include "limber/session/drag/limb_pull.h"
#include "limber/session/rigged_model.h"

namespace limber {

// Whether limbs follow unless the user says otherwise: on a body, read with confidence, that has legs, arms or wings, and
// on handles of which at least one can be reached by turning two others or more.
bool hasLimbs(const RiggedModel& rig);

// Feet, paws and hooves that are no higher in `pose` than in the rest pose, pinned in position and rotation. World
// space.
std::vector<PinnedTarget> standingFeet(const RiggedModel& rig, const Pose& pose);

// The `targets` that stay pinned while `dragged` is moved. A foot whose own limb is dragged above it is released: it
// rolls over its toes if it has some, else its target is dropped.
std::vector<PinnedTarget> pinnedDuringDrag(const RiggedModel& rig, const Pose& pose,
                                           const std::vector<PinnedTarget>& targets, Index dragged);

// Whether `above` belongs to the limb that the target at `joint` is reached by, and is not that joint.
bool isInLimbAbove(const Skeleton& skeleton, Index above, Index joint);

}  // namespace limber
