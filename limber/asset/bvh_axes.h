// Which axis of a BVH points up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "limber/asset/bvh_hierarchy.h"
#include "limber/asset/bvh_line.h"

namespace limber {

// Heads lie above feet along Z, clearly, and on the other side of the joint that carries both: in a rest pose that has
// all bones along one axis (rest_form.h) they do not.
inline bool standsAlongZ(const std::vector<BvhJoint>& joints) {
  const auto names = [](const std::string& name, std::string_view part) {
    for (std::size_t at = 0; at + part.size() <= name.size(); ++at) {
      if (isWord(std::string_view(name).substr(at, part.size()), part)) return true;
    }
    return false;
  };
  std::vector<Vec3> places(joints.size());
  std::array<Vec3, 2> sums = {Vec3::Zero(), Vec3::Zero()};  // heads, feet
  std::array<double, 2> counts = {0, 0};
  std::vector<double> below(joints.size(), 0);  // heads and feet
  for (std::size_t j = 0; j < joints.size(); ++j) {
    places[j] = joints[j].offset;
    if (joints[j].parent) places[j] += places[*joints[j].parent];
    const std::string& name = joints[j].name;
    const bool foot = names(name, "foot") || names(name, "toe") || names(name, "ankle");
    if (!foot && !names(name, "head")) continue;
    sums[foot] += places[j];
    counts[foot] += 1;
    below[j] += 1;
  }
  if (counts[0] == 0 || counts[1] == 0) return false;
  for (std::size_t j = joints.size(); j-- > 0;) {
    if (joints[j].parent) below[*joints[j].parent] += below[j];
  }
  const auto carrier = std::find(below.rbegin(), below.rend(), counts[0] + counts[1]);
  const Vec3 head = sums[0] / counts[0], feet = sums[1] / counts[1], upwards = head - feet;
  if (carrier != below.rend()) {
    const double height = places[static_cast<std::size_t>(below.rend() - carrier) - 1].z();
    if (head.z() < height || feet.z() > height) return false;
  }
  constexpr double kClearly = 4;  // people stand within a few degrees of it; a beast's head lies before its feet, too
  return upwards.z() > kClearly * std::hypot(upwards.x(), upwards.y());
}

}  // namespace limber
