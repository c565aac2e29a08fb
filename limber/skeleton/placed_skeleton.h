// Skeletons by where their joints rest.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// Joints in one space, each after its parent; the rest pose turns nothing.
class PlacedSkeleton {
 public:
  // parent    its name; empty for a root
  // position  metres
  void add(const std::string& name, const std::string& parent, const Vec3& position) {
    Joint joint;
    joint.name = name;
    if (!parent.empty()) joint.parent = skeleton_.find(parent).value();
    joint.rest.translation = joint.parent ? Vec3(position - positions_[*joint.parent]) : position;
    positions_.push_back(position);
    skeleton_.joints.push_back(std::move(joint));
  }

  bool has(const std::string& name) const { return skeleton_.find(name).has_value(); }
  Skeleton take() { return std::move(skeleton_); }

 private:
  Skeleton skeleton_;
  std::vector<Vec3> positions_;  // #J
};

}  // namespace limber
