#include "limber/rigging/templates/joints_between.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/core/rotation.h"

namespace limber {

void placeBetween(const TemplateSkeleton& skeleton, std::vector<Vec3>& positions) {
  const Index count = skeleton.jointCount();
  // So is the tip of a joint between: nothing else tells where it is.
  std::vector<bool> isBetween(count);
  for (Index j = 0; j < count; ++j) {
    const TemplateJoint& joint = skeleton.joints[j];
    isBetween[j] = joint.role == TemplateRole::kBetween ||
                   (joint.role == TemplateRole::kTip && joint.parent && isBetween[*joint.parent]);
  }
  const auto between = [&](Index j) { return isBetween[j]; };
  // The placed joint above each joint, and below it: a joint between that leads to none goes along with the bone that
  // the placed joint above it has, or, where that is the last of its limb, with the bone to there.
  std::vector<std::optional<Index>> above(count), below(count), firstBelow(count);
  for (Index j = 0; j < count; ++j) {
    if (!skeleton.joints[j].parent) continue;
    const Index parent = *skeleton.joints[j].parent;
    above[j] = between(parent) ? above[parent] : std::optional(parent);
    if (!between(j) && above[j] && !firstBelow[*above[j]]) firstBelow[*above[j]] = j;
  }
  for (Index j = count; j-- > 0;) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const std::optional<Index> own = between(j) ? below[j] : std::optional(j);
    if (parent && between(*parent) && own) below[*parent] = own;
  }
  Index highest = 0;
  for (Index j = 1; j < count; ++j) {
    const bool isHigher = skeleton.joints[j].position.y() > skeleton.joints[highest].position.y();
    if (between(j) == between(highest) ? isHigher : between(highest)) highest = j;
  }
  for (Index j = 0; j < count; ++j) {
    if (!between(j)) continue;
    if (!above[j]) {
      // Above all that are placed: what is on the ground stays there.
      const Vec3 found = positions[highest], known = skeleton.joints[highest].position;
      positions[j] = found + found.y() / std::max(known.y(), 1e-6) * (skeleton.joints[j].position - known);
      continue;
    }
    const Vec3 &from = skeleton.joints[*above[j]].position, &start = positions[*above[j]];
    const Vec3 offset = skeleton.joints[j].position - from;
    const std::optional<Index> end = below[j] ? below[j] : firstBelow[*above[j]];
    const std::optional<Index> begin = end ? std::nullopt : above[*above[j]];
    if (!end && !begin) {
      positions[j] = start + offset;
      continue;
    }
    const Vec3 bone = end ? skeleton.joints[*end].position - from : from - skeleton.joints[*begin].position;
    const Vec3 found = end ? positions[*end] - start : start - positions[*begin];
    const double squared = std::max(bone.squaredNorm(), 1e-12);
    const double part = offset.dot(bone) / squared;
    // What ends a limb has the size of the body, not of one bone.
    const double scale = end ? std::sqrt(found.squaredNorm() / squared) : 1;
    const Vec3 along = end ? found : Vec3(std::sqrt(squared) * found.normalized());
    positions[j] = start + part * along + scale * (shortestRotation(bone, found) * (offset - part * bone));
  }
}

}  // namespace limber
