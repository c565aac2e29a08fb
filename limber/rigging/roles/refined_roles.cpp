#include "limber/rigging/roles/refined_roles.h"

#include <algorithm>
#include <string>
#include <vector>

#include "limber/rigging/roles/placed_joints.h"
#include "limber/rigging/roles/roled_templates.h"
#include "limber/rigging/templates/humanoid_landmarks.h"
#include "limber/rigging/templates/quadruped_landmarks.h"

namespace limber {

namespace {

// Expected errors that a landmark may lie from the reading. On makers left out, errors over what is expected of them are
// 1.3 times as large on four legs as on two.
constexpr double kReachOnTwo = 2, kReachOnFour = 2.5;
constexpr double kMinReach = 0.03;  // heights

void moveFingers(const std::string& side, const Vec3& displacement, RoleReading& reading) {
  for (const std::string& role : reading.roles()) {
    if (role.starts_with("finger_") && role.ends_with(side)) reading.move(role, displacement);
  }
}

}  // namespace

void refineRoles(std::string_view plan, const BodyVolume& body, RoleReading& reading) {
  if (plan != "upright" && plan != "four") return;
  RoledSkeleton made = templateWithRoles(*findTemplate(plan == "four" ? "quadruped" : "humanoid"), reading);
  const std::vector<TemplateJoint>& joints = made.skeleton.joints;
  TemplatePins pins(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const bool isRole = joints[j].role != TemplateRole::kTip && made.roles[j] && made.roles[j]->isRole();
    if (isRole && reading.isKnown(made.roles[j]->from)) pins[j] = reading.position(*made.roles[j]);
  }
  const std::vector<Vec3> read = placedJoints(made, reading, pins);
  std::vector<Vec3> positions = read;
  if (plan == "four") {
    refineQuadruped(made.skeleton, body, reading.frame(), pins, positions);
  } else {
    refineHumanoid(made.skeleton, body, reading.frame(), pins, positions);
  }
  const double reach = plan == "four" ? kReachOnFour : kReachOnTwo;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].role == TemplateRole::kTip || pins[j] || !made.roles[j] || !made.roles[j]->isRole()) continue;
    const std::string& role = made.roles[j]->from;
    const Vec3 displacement = positions[j] - read[j];
    if (displacement.norm() > std::max(reach * reading.expectedError(*made.roles[j]), kMinReach)) continue;
    reading.move(role, displacement);
    if (role.starts_with("fore_end")) moveFingers(role.substr(role.size() - 2), displacement, reading);
  }
}

}  // namespace limber
