// The templates that limber knows, as tables. Sides stand once, for the left; the right is mirrored.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

namespace {

constexpr TemplateRole kPlaced = TemplateRole::kPlaced, kBetween = TemplateRole::kBetween, kTip = TemplateRole::kTip;

struct Row {
  std::string_view name, parent;
  double x, y, z;
  TemplateRole role;
};

// Positions: means over artists' rigs (docs/template-rigs.md names them).
constexpr Row kHumanoid[] = {
    {"hips", "", 0, 0.50, 0, kPlaced},
    {"spine", "hips", 0, 0.565, 0, kBetween},
    {"chest", "spine", 0, 0.645, 0, kBetween},
    {"upperChest", "chest", 0, 0.73, 0, kPlaced},
    {"neck", "upperChest", 0, 0.80, 0, kPlaced},
    {"head", "neck", 0, 0.86, 0, kPlaced},
    {"headTip", "head", 0, 0.98, 0, kTip},
    {"leftShoulder", "upperChest", 0.035, 0.76, 0.015, kBetween},
    {"leftUpperArm", "leftShoulder", 0.09, 0.775, 0, kPlaced},
    {"leftLowerArm", "leftUpperArm", 0.21, 0.73, 0, kPlaced},
    {"leftHand", "leftLowerArm", 0.33, 0.68, 0.01, kPlaced},
    {"leftHandTip", "leftHand", 0.43, 0.64, 0.02, kTip},
    {"leftUpperLeg", "hips", 0.065, 0.495, 0, kPlaced},
    {"leftLowerLeg", "leftUpperLeg", 0.075, 0.275, 0, kPlaced},
    {"leftFoot", "leftLowerLeg", 0.08, 0.05, -0.02, kPlaced},
    {"leftToes", "leftFoot", 0.085, 0.012, 0.05, kBetween},
    {"leftToesTip", "leftToes", 0.09, 0.01, 0.09, kTip},
};

constexpr Row kHandFingers[] = {
    {"leftThumbMetacarpal", "leftHand", 0.345, 0.68, 0.025, kBetween},
    {"leftThumbProximal", "leftThumbMetacarpal", 0.365, 0.67, 0.037, kBetween},
    {"leftThumbDistal", "leftThumbProximal", 0.38, 0.66, 0.045, kBetween},
    {"leftIndexProximal", "leftHand", 0.382, 0.658, 0.03, kBetween},
    {"leftIndexIntermediate", "leftIndexProximal", 0.405, 0.648, 0.033, kBetween},
    {"leftIndexDistal", "leftIndexIntermediate", 0.419, 0.642, 0.035, kBetween},
    {"leftMiddleProximal", "leftHand", 0.385, 0.657, 0.016, kBetween},
    {"leftMiddleIntermediate", "leftMiddleProximal", 0.41, 0.647, 0.017, kBetween},
    {"leftMiddleDistal", "leftMiddleIntermediate", 0.425, 0.641, 0.018, kBetween},
    {"leftRingProximal", "leftHand", 0.382, 0.657, 0.003, kBetween},
    {"leftRingIntermediate", "leftRingProximal", 0.405, 0.647, 0.002, kBetween},
    {"leftRingDistal", "leftRingIntermediate", 0.419, 0.641, 0.001, kBetween},
    {"leftLittleProximal", "leftHand", 0.376, 0.657, -0.01, kBetween},
    {"leftLittleIntermediate", "leftLittleProximal", 0.393, 0.648, -0.012, kBetween},
    {"leftLittleDistal", "leftLittleIntermediate", 0.404, 0.642, -0.013, kBetween},
};

constexpr Row kQuadruped[] = {
    {"hips", "", 0, 0.66, -0.4, kPlaced},
    {"spine", "hips", 0, 0.67, -0.24, kBetween},
    {"spine1", "spine", 0, 0.66, -0.07, kBetween},
    {"chest", "spine1", 0, 0.63, 0.1, kPlaced},
    {"neck", "chest", 0, 0.72, 0.28, kPlaced},
    {"neck1", "neck", 0, 0.8, 0.35, kBetween},
    {"head", "neck1", 0, 0.88, 0.42, kPlaced},
    {"headTip", "head", 0, 0.82, 0.66, kTip},
    {"tail", "hips", 0, 0.64, -0.52, kPlaced},
    {"tail1", "tail", 0, 0.61, -0.61, kBetween},
    {"tail2", "tail1", 0, 0.58, -0.7, kBetween},
    {"tailTip", "tail2", 0, 0.55, -0.8, kTip},
    {"leftFrontShoulder", "chest", 0.06, 0.62, 0.15, kBetween},
    {"leftFrontUpperLeg", "leftFrontShoulder", 0.11, 0.58, 0.19, kPlaced},
    {"leftFrontLowerLeg", "leftFrontUpperLeg", 0.12, 0.36, 0.15, kPlaced},
    {"leftFrontFoot", "leftFrontLowerLeg", 0.12, 0.12, 0.17, kPlaced},
    {"leftFrontToes", "leftFrontFoot", 0.12, 0.045, 0.2, kBetween},
    {"leftFrontFootTip", "leftFrontToes", 0.12, 0.01, 0.22, kTip},
    {"leftHindUpperLeg", "hips", 0.1, 0.56, -0.36, kPlaced},
    {"leftHindLowerLeg", "leftHindUpperLeg", 0.12, 0.38, -0.31, kPlaced},
    {"leftHindFoot", "leftHindLowerLeg", 0.12, 0.2, -0.43, kPlaced},
    {"leftHindToes", "leftHindFoot", 0.12, 0.05, -0.4, kBetween},
    {"leftHindFootTip", "leftHindToes", 0.12, 0.01, -0.36, kTip},
};

constexpr Row kBird[] = {
    {"hips", "", 0, 0.5, -0.1, kPlaced},
    {"chest", "hips", 0, 0.58, 0.08, kPlaced},
    {"neck", "chest", 0, 0.7, 0.22, kPlaced},
    {"head", "neck", 0, 0.85, 0.32, kPlaced},
    {"headTip", "head", 0, 0.83, 0.5, kTip},
    {"tail", "hips", 0, 0.45, -0.3, kPlaced},
    {"tailTip", "tail", 0, 0.4, -0.6, kTip},
    {"leftUpperWing", "chest", 0.12, 0.62, 0.08, kPlaced},
    {"leftLowerWing", "leftUpperWing", 0.4, 0.64, 0.06, kPlaced},
    {"leftWingHand", "leftLowerWing", 0.75, 0.62, 0.02, kPlaced},
    {"leftWingTip", "leftWingHand", 1.15, 0.6, -0.1, kTip},
    {"leftUpperLeg", "hips", 0.09, 0.4, -0.06, kPlaced},
    {"leftLowerLeg", "leftUpperLeg", 0.1, 0.25, -0.04, kPlaced},
    {"leftFoot", "leftLowerLeg", 0.1, 0.07, -0.06, kPlaced},
    {"leftFootTip", "leftFoot", 0.1, 0.01, 0.06, kTip},
};

constexpr std::string_view kLeft = "left", kRight = "right";

bool ofLeft(std::string_view name) {
  return name.substr(0, kLeft.size()) == kLeft;
}

std::string rightName(std::string_view name) {
  return ofLeft(name) ? std::string(kRight) + std::string(name.substr(kLeft.size())) : std::string(name);
}

void addRow(TemplateSkeleton& skeleton, const Row& row, bool right) {
  TemplateJoint joint;
  joint.name = right ? rightName(row.name) : std::string(row.name);
  if (!row.parent.empty()) joint.parent = skeleton.find(right ? rightName(row.parent) : std::string(row.parent));
  joint.position = Vec3(right ? -row.x : row.x, row.y, row.z);
  joint.role = row.role;
  skeleton.joints.push_back(std::move(joint));
}

TemplateSkeleton made(std::string_view name, std::string_view summary, std::span<const Row> rows,
                      std::span<const Row> more = {}) {
  TemplateSkeleton skeleton{std::string(name), std::string(summary), {}};
  std::vector<Row> all(rows.begin(), rows.end());
  all.insert(all.end(), more.begin(), more.end());
  for (const Row& row : all) {
    if (!ofLeft(row.name)) addRow(skeleton, row, false);
  }
  for (const bool right : {false, true}) {
    for (const Row& row : all) {
      if (ofLeft(row.name)) addRow(skeleton, row, right);
    }
  }
  for (TemplateJoint& joint : skeleton.joints) {
    if (!ofLeft(joint.name)) continue;
    joint.mirror = skeleton.find(rightName(joint.name));
    skeleton.joints[*joint.mirror].mirror = skeleton.find(joint.name);
  }
  return skeleton;
}

}  // namespace

std::span<const TemplateSkeleton> templateSkeletons() {
  static const std::array<TemplateSkeleton, 4> kTemplates = {
      made("humanoid", "a person: 22 joints, named as VRM 1.0 does", kHumanoid),
      made("humanoid-fingers", "a person with 15 finger joints to each hand", kHumanoid, kHandFingers),
      made("quadruped", "a four-legged animal with neck and tail", kQuadruped),
      made("bird", "a bird with wings spread, or another winged biped", kBird),
  };
  return kTemplates;
}

const TemplateSkeleton& findTemplate(std::string_view name) {
  std::string known;
  for (const TemplateSkeleton& skeleton : templateSkeletons()) {
    if (skeleton.name == name) return skeleton;
    known += (known.empty() ? "" : ", ") + skeleton.name;
  }
  throw Error(ErrorCode::kBadArgument, fmt::format("no template is called '{}'", name), {}, "there are: " + known);
}

}  // namespace limber
