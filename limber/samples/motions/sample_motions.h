// Motions that limber makes itself, so that retargeting can be tried with no download.
#pragma once

#include <span>
#include <string_view>

#include "limber/skeleton/motion.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct SampleMotion {
  std::string_view name;     // "walk"
  std::string_view summary;  // one line for --help
  double seconds;            // of one repetition
  Skeleton (*skeleton)();
  Pose (*at)(const Skeleton& skeleton, double seconds);
};

std::span<const SampleMotion> sampleMotions();

// The motion of that name, in metres: on the ground y = 0, facing +Z, three repetitions at 60 frames a second, the last
// frame posed as the first. Toes on the ground stand still. Throws Error kBadArgument that lists the names there are.
Motion makeSampleMotion(std::string_view name);

}  // namespace limber
