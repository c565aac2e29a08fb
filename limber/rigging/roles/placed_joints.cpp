#include "limber/rigging/roles/placed_joints.h"

#include <optional>

#include "limber/rigging/templates/joints_between.h"

namespace limber {

namespace {

constexpr double kTipBeyond = 0.5;  // of a bone: its end beyond the joint, where no sample says

// Beyond the last joint of a limb: the end of its bone.
Vec3 tipOf(const RoledSkeleton& made, Index tip, const RoleReading& reading, const std::vector<Vec3>& positions) {
  const Index joint = made.skeleton.joints[tip].parent.value();
  const std::optional<Index> above = made.skeleton.joints[joint].parent;
  const Vec3 bone = above ? Vec3(positions[joint] - positions[*above]) : Vec3(0, 0.1, 0);
  if (made.roles[joint]) {
    if (const auto end = reading.boneEnd(partOfRole(made.roles[joint]->to), positions[joint])) return *end;
  }
  return positions[joint] + kTipBeyond * bone;
}

}  // namespace

std::vector<Vec3> placedJoints(RoledSkeleton& made, const RoleReading& reading, const TemplatePins& pins) {
  std::vector<TemplateJoint>& joints = made.skeleton.joints;
  std::vector<Vec3> positions;  // of a skeleton that is no body's: as it is, as high as the model
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (pins[j] && joints[j].role != TemplateRole::kTip) joints[j].role = TemplateRole::kPlaced;
    const bool isRead = joints[j].role == TemplateRole::kPlaced && !pins[j];
    positions.push_back(isRead ? reading.position(*made.roles[j]) : pins[j].value_or(joints[j].position));
  }
  placeBetween(made.skeleton, positions);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].role != TemplateRole::kTip || pins[j]) continue;
    if (joints[*joints[j].parent].role == TemplateRole::kPlaced) {
      positions[j] = tipOf(made, static_cast<Index>(j), reading, positions);
    }
  }
  placeBetween(made.skeleton, positions);
  return positions;
}

}  // namespace limber
