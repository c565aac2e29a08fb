#include "limber/rigging/roles/roled_templates.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/rigging/templates/standing_skeleton.h"

namespace limber {

namespace {

bool hasRaisedHeels(const RoleReading& reading) {
  return reading.has("hind_hock.L") && reading.has("hind_hock.R");
}

// Of skeletons without heels of their own: feet are at the heels, toes where the feet were.
void raiseHeels(RoledSkeleton& made) {
  const auto isHeel = [](const auto& role) { return role && role->from.starts_with("hind_hock"); };
  if (std::any_of(made.roles.begin(), made.roles.end(), isHeel)) return;
  for (std::optional<RolePosition>& role : made.roles) {
    if (!role || !role->isRole()) continue;
    const std::string side = role->from.substr(role->from.size() - 2);
    if (role->from == "hind_end" + side) {
      role = atRole("hind_hock" + side);
    } else if (role->from == "hind_toes" + side) {
      role = atRole("hind_end" + side);
    }
  }
}

}  // namespace

RoledSkeleton withRoles(TemplateSkeleton skeleton, std::vector<std::optional<RolePosition>> roles) {
  RoledSkeleton made = {std::move(skeleton), std::move(roles)};
  made.roles.resize(made.skeleton.joints.size());
  for (std::size_t j = 0; j < made.roles.size(); ++j) {
    TemplateJoint& joint = made.skeleton.joints[j];
    if (joint.role == TemplateRole::kTip) {
      made.roles[j] = joint.parent ? made.roles[*joint.parent] : std::nullopt;
    } else {
      joint.role = made.roles[j] ? TemplateRole::kPlaced : TemplateRole::kBetween;
    }
  }
  return made;
}

RoledSkeleton templateWithRoles(const TemplateSkeleton& skeleton, const RoleReading& reading) {
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  const Skeleton rest = standingSkeleton(skeleton, positions, {});
  std::vector<std::optional<RolePosition>> roles = jointRoles(rest, readAnatomy(rest));
  // Tips are among the template's joints, and no joints of the rest pose.
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].role == TemplateRole::kTip) roles.insert(roles.begin() + j, std::nullopt);
  }
  RoledSkeleton made = withRoles(skeleton, std::move(roles));
  if (hasRaisedHeels(reading)) raiseHeels(made);
  return made;
}

// Oriented as templates are.
RoledSkeleton ownWithRoles(const Skeleton& skeleton, std::string_view name) {
  const Anatomy anatomy = readAnatomy(skeleton);
  Mat3 axes;
  axes << anatomy.axes.left().transpose(), anatomy.axes.up.transpose(), anatomy.axes.front.transpose();
  Skeleton standing = skeleton;
  for (Joint& joint : standing.joints) {
    if (joint.parent) continue;
    joint.rest.translation = axes * joint.rest.translation;
    joint.rest.rotation = Quat(axes) * joint.rest.rotation;
  }
  return withRoles(templateFrom(standing, name), jointRoles(standing, anatomy));
}

}  // namespace limber
