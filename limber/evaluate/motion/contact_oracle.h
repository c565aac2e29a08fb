// When a point of a body rests, read off a whole motion: the detector of the judge (retarget_judge.h), which has no
// code in common with the contact detection of retargeting.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

struct RestOptions {
  double spread = 0.015;  // heights, above 0: sum of the box's sides that a resting point stays in
  double seconds = 0.1;   // for so long at least: a foot's contact in a run takes 0.15 to 0.25 (Novacheck 1998)
  double height = 0.035;  // heights over where the point is when standing, at most
};

// Of each frame whether the point rests in it. Dispersion threshold, as gaze is parted into fixations (Salvucci,
// Goldberg 2000, I-DT): a window of `seconds` in which the point stays within `spread` grows as long as it does. No
// speeds, so a recording's trembling counts by its size alone, and a slow drift as one rest after the other.
//
// path   of each frame, over the body's height
// above  of each frame, over where the point is when standing, heights; empty: at any height
// cuts   of each frame whether the motion jumped to it
std::vector<bool> restingFrames(std::span<const Vec3> path, std::span<const double> above,
                                const std::vector<bool>& cuts, double frameSeconds, const RestOptions& options = {});

// How well contacts that were found agree with those that are meant. A frame agrees with any within `slack` frames.
struct ContactAgreement {
  double found = 0, foundRight = 0;  // frames, and those of them that are meant
  double meant = 0, meantFound = 0;

  void count(const std::vector<bool>& meantFrames, const std::vector<bool>& foundFrames, std::size_t slack);
  double precision() const { return found > 0 ? foundRight / found : 1; }
  double recall() const { return meant > 0 ? meantFound / meant : 1; }
};

}  // namespace limber
