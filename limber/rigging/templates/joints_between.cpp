#include "limber/rigging/templates/joints_between.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/core/rotation.h"

namespace limber {

void placeBetween(const TemplateSkeleton& skeleton, std::vector<Vec3>& positions) {
  const Index count = skeleton.jointCount();
  const auto between = [&](Index j) { return skeleton.joints[j].role == TemplateRole::kBetween; };
  // The placed joint above each joint, and below it: a joint between that leads to none goes along with the bone that
  // the placed joint above it has.
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
  const auto highest = std::max_element(
      skeleton.joints.begin(), skeleton.joints.end(), [](const TemplateJoint& a, const TemplateJoint& b) {
        const bool known[] = {a.role != TemplateRole::kBetween, b.role != TemplateRole::kBetween};
        return known[0] == known[1] ? a.position.y() < b.position.y() : known[1];
      });
  for (Index j = 0; j < count; ++j) {
    if (!between(j)) continue;
    if (!above[j]) {
      // Above all that are placed: what is on the ground stays there.
      const Vec3& found = positions[highest - skeleton.joints.begin()];
      positions[j] =
          found + found.y() / std::max(highest->position.y(), 1e-6) * (skeleton.joints[j].position - highest->position);
      continue;
    }
    const Vec3 &from = skeleton.joints[*above[j]].position, &start = positions[*above[j]];
    const Vec3 offset = skeleton.joints[j].position - from;
    const std::optional<Index> end = below[j] ? below[j] : firstBelow[*above[j]];
    if (!end) {
      positions[j] = start + offset;
      continue;
    }
    const Vec3 bone = skeleton.joints[*end].position - from, found = positions[*end] - start;
    const double squared = std::max(bone.squaredNorm(), 1e-12);
    const double part = offset.dot(bone) / squared;
    const double scale = std::sqrt(found.squaredNorm() / squared);
    positions[j] = start + part * found + scale * (shortestRotation(bone, found) * (offset - part * bone));
  }
}

}  // namespace limber
