#include "limber/skeleton/portable_pose.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

namespace limber {

namespace {

constexpr double kRounded = 1e-5;  // of lengths against the longest bone, of a quaternion's numbers and of scales

double longestBone(const Skeleton& skeleton) {
  double longest = 0;
  for (const Joint& joint : skeleton.joints) longest = std::max(longest, joint.rest.translation.norm());
  return longest;
}

bool restsAlike(const Transform& a, const Transform& b, double length) {
  return (a.translation - b.translation).norm() <= kRounded * length &&
         1 - std::abs(a.rotation.dot(b.rotation)) <= kRounded * kRounded &&
         (a.scale - b.scale).norm() <= kRounded * a.scale.norm();
}

std::string_view parentName(const Skeleton& skeleton, Index joint) {
  const std::optional<Index> parent = skeleton.joints[joint].parent;
  return parent ? std::string_view(skeleton.joints[*parent].name) : std::string_view();
}

}  // namespace

std::optional<Pose> poseByNames(const PortablePose& pose, const Skeleton& to) {
  const Skeleton& from = pose.skeleton;
  std::map<std::string_view, Index> named;
  for (Index j = 0; j < from.jointCount(); ++j) named.emplace(from.joints[j].name, j);
  const double length = longestBone(from);
  Pose result = restPose(to);
  Index known = 0;
  for (Index j = 0; j < to.jointCount(); ++j) {
    const auto found = named.find(to.joints[j].name);
    if (found == named.end()) continue;
    const Index joint = found->second;
    if (parentName(from, joint) != parentName(to, j)) return std::nullopt;
    if (!restsAlike(from.joints[joint].rest, to.joints[j].rest, length)) return std::nullopt;
    result.locals[j] = pose.pose.locals[joint];
    ++known;
  }
  if (2 * known <= std::max(from.jointCount(), to.jointCount())) return std::nullopt;
  return result;
}

}  // namespace limber
