// Sample poses as recipes: a stance of the sample person, or a pose of the sample animal.
#pragma once

#include "limber/samples/figure.h"

namespace limber {

Stance standStance(), walkStance(), runStance(), sitStance(), crouchStance(), kneelStance(), reachStance(),
    pointStance(), waveStance(), cheerStance(), jumpStance(), bowStance();

// Of quadrupedSkeleton().
Pose quadrupedStand(const Skeleton&quadruped), quadrupedWalk(const Skeleton&quadruped),
    quadrupedSit(const Skeleton&quadruped), quadrupedLie(const Skeleton&quadruped),
    quadrupedStretch(const Skeleton&quadruped), quadrupedHowl(const Skeleton&quadruped);

}  // namespace limber
