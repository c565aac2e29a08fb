// Poses that limber makes itself, for people and for animals on four legs.
#pragma once

#include <span>
#include <string_view>

#include "limber/skeleton/portable_pose.h"

namespace limber {

struct SamplePose {
  std::string_view name;     // "wave"
  std::string_view summary;  // one line for --help
  Skeleton (*skeleton)();
  Pose (*pose)(const Skeleton& skeleton);
};

std::span<const SamplePose> samplePoses();

// The pose of that name: metres, on the ground y = 0, facing +Z. Throws Error kBadArgument that lists the names there
// are.
PortablePose makeSamplePose(std::string_view name);

}  // namespace limber
