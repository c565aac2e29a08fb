// When which foot comes down in a motion: the moments by which steps are matched.
#pragma once

#include <vector>

#include "limber/motion/mix/ground_frame.h"

namespace limber {

struct Footfall {
  Index foot = 0;  // the leg's end
  double seconds = 0;
};

// A foot comes down where it is furthest ahead of the pelvis, in the direction in which the body goes (Zeni, Richards,
// Higginson 2008, Two simple methods for determining gait events during treadmill and overground walking using
// kinematic data); one that goes on the spot goes ahead. It has to swing by a fifth of the hips' height there and back.
// Without heights or speeds, so runs, whose contacts are too short for a ContactTrack (of pab_run.fbx it finds none of
// the right foot), and walks on the spot are read as walks are. In time; a parabola through three frames tells it finer
// than frames are. None for a body without legs or that takes no steps.
std::vector<Footfall> footfallsOf(const MixBody& body, const PoseSequence& frames);

}  // namespace limber
