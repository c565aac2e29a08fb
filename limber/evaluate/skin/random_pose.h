// Poses drawn at random, the same on every machine.
#pragma once

#include <cstdint>

#include "limber/skeleton/pose.h"

namespace limber {

// Steele, Lea, Flood 2014 (SplitMix64): state += 0x9E3779B97F4A7C15, then a mix of the state. Written out here so that
// a seed means the same numbers everywhere, which std::uniform_real_distribution does not promise.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  double uniform();   // [0, 1), 53 bits
  Vec3 unitVector();  // even over the sphere: points of a cube until one lies in the ball

 private:
  std::uint64_t state_;
};

// The rest pose with each joint turned, after its rest rotation, about a random axis by an angle even in
// [0, mostRadians]. Draws an axis, then an angle, joint after joint.
Pose randomPose(const Skeleton& skeleton, double maxRadians, SplitMix& random);

}  // namespace limber
