// Any skeleton: trees of all shapes with joints anywhere, read as a body and matched with another.
#include <cstdint>
#include <cstring>

#include "limber/character/matching/skeleton_map.h"
#include "limber/core/error.h"

namespace {

constexpr std::size_t kMaxJoints = 400;

// Each joint takes 14 bytes: its parent (a joint before it, or none), a position, and a letter of its name.
limber::Skeleton skeletonFrom(const std::uint8_t* data, std::size_t size) {
  limber::Skeleton skeleton;
  constexpr std::size_t kStride = 14;
  constexpr const char* kWords[] = {"Hips",  "Spine", "LeftArm", "RightArm", "leg.L",
                                    "leg.R", "Head",  "tail",    "joint",    "wing_l"};
  for (std::size_t at = 0; at + kStride <= size && skeleton.joints.size() < kMaxJoints; at += kStride) {
    limber::Joint joint;
    const auto number = skeleton.jointCount();
    if (number > 0 && data[at] != 0) joint.parent = static_cast<limber::Index>(data[at] * 7 + data[at + 1]) % number;
    float position[3];
    std::memcpy(position, data + at + 2, sizeof position);
    joint.rest.translation = {static_cast<double>(position[0]), static_cast<double>(position[1]),
                              static_cast<double>(position[2])};
    joint.name = std::string(kWords[data[at + 1] % 10]) + std::to_string(number);
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const limber::Skeleton one = skeletonFrom(data, size), other = skeletonFrom(data + size / 3, size - size / 3);
    const limber::Anatomy anatomy = limber::readAnatomy(one);
    for (const limber::Part& part : anatomy.parts) {
      if (part.joints.empty() || !(part.confidence >= 0 && part.confidence <= 1 + 1e-9)) __builtin_trap();
    }
    limber::checkSkeletonMap(limber::matchSkeletons(one, other), one, other);
  } catch (const limber::Error&) {
  }
  return 0;
}
