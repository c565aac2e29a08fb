// Motions that limber makes itself, so that retargeting can be tried with no download.
#pragma once

#include <span>
#include <string_view>

#include "limber/samples/figure.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct SampleMotion {
  std::string_view name;     // "walk"
  std::string_view summary;  // one line for --help
  double seconds;            // of one repetition
  Stance (*at)(double seconds);
};

std::span<const SampleMotion> sampleMotions();

// The motion of that name: a person of figureSkeleton() on the ground y = 0, facing +Z, three repetitions at 60 frames
// a second, the last frame posed as the first. Planted feet stand still. Throws Error kBadArgument that lists the names
// there are.
Motion makeSampleMotion(std::string_view name);

}  // namespace limber
