// A skeleton to pull at: root - trunk - two arms of three joints, the first along +X at y = 2. Not installed.
#pragma once

#include <string>

#include "limber/skeleton/skeleton.h"

namespace limber::testing {

inline constexpr Index kShoulder = 2, kElbow = 3, kHand = 4, kOtherHand = 7;

inline Skeleton twoArmedBody(BoneShape shape) {
  Skeleton skeleton;
  skeleton.boneShape = shape;
  const auto add = [&](std::optional<Index> parent, const Vec3& at) {
    Joint joint;
    joint.name = "joint_" + std::to_string(skeleton.joints.size());
    joint.parent = parent;
    joint.rest.translation = at;
    skeleton.joints.push_back(joint);
    return skeleton.jointCount() - 1;
  };
  const Index trunk = add(add(std::nullopt, {0, 1, 0}), {0, 1, 0});
  for (const double side : {1.0, -1.0}) add(add(add(trunk, {0.5 * side, 0, 0}), {side, 0, 0.1}), {side, 0, 0});
  return skeleton;
}

}  // namespace limber::testing
