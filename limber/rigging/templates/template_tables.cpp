// The templates that limber knows, as tables. Sides stand once, for the left; the right is mirrored.
#include <algorithm>
#include <array>
#include <utility>

#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

namespace {

constexpr TemplateRole kTip = TemplateRole::kTip;

struct Row {
  std::string_view name, parent;
  double x, y, z;
  TemplateRole role = TemplateRole::kPlaced;
};

// Positions: means over artists' rigs (docs/template-rigs.md names them).
constexpr Row kHumanoid[] = {
    {"hips", "", 0, 0.50, 0},
    {"spine", "hips", 0, 0.565, 0},
    {"chest", "spine", 0, 0.645, 0},
    {"upperChest", "chest", 0, 0.73, 0},
    {"neck", "upperChest", 0, 0.80, 0},
    {"head", "neck", 0, 0.86, 0},
    {"headTip", "head", 0, 0.98, 0, kTip},
    {"leftShoulder", "upperChest", 0.035, 0.76, 0.015},
    {"leftUpperArm", "leftShoulder", 0.09, 0.775, 0},
    {"leftLowerArm", "leftUpperArm", 0.21, 0.73, 0},
    {"leftHand", "leftLowerArm", 0.33, 0.68, 0.01},
    {"leftHandTip", "leftHand", 0.43, 0.64, 0.02, kTip},
    {"leftUpperLeg", "hips", 0.065, 0.495, 0},
    {"leftLowerLeg", "leftUpperLeg", 0.075, 0.275, 0},
    {"leftFoot", "leftLowerLeg", 0.08, 0.05, -0.02},
    {"leftToes", "leftFoot", 0.085, 0.012, 0.05},
    {"leftToesTip", "leftToes", 0.09, 0.01, 0.09, kTip},
};

constexpr Row kHandFingers[] = {
    {"leftThumbMetacarpal", "leftHand", 0.345, 0.68, 0.025},
    {"leftThumbProximal", "leftThumbMetacarpal", 0.365, 0.67, 0.037},
    {"leftThumbDistal", "leftThumbProximal", 0.38, 0.66, 0.045},
    {"leftIndexProximal", "leftHand", 0.382, 0.658, 0.03},
    {"leftIndexIntermediate", "leftIndexProximal", 0.405, 0.648, 0.033},
    {"leftIndexDistal", "leftIndexIntermediate", 0.419, 0.642, 0.035},
    {"leftMiddleProximal", "leftHand", 0.385, 0.657, 0.016},
    {"leftMiddleIntermediate", "leftMiddleProximal", 0.41, 0.647, 0.017},
    {"leftMiddleDistal", "leftMiddleIntermediate", 0.425, 0.641, 0.018},
    {"leftRingProximal", "leftHand", 0.382, 0.657, 0.003},
    {"leftRingIntermediate", "leftRingProximal", 0.405, 0.647, 0.002},
    {"leftRingDistal", "leftRingIntermediate", 0.419, 0.641, 0.001},
    {"leftLittleProximal", "leftHand", 0.376, 0.657, -0.01},
    {"leftLittleIntermediate", "leftLittleProximal", 0.393, 0.648, -0.012},
    {"leftLittleDistal", "leftLittleIntermediate", 0.404, 0.642, -0.013},
};

constexpr Row kQuadruped[] = {
    {"hips", "", 0, 0.66, -0.4},
    {"spine", "hips", 0, 0.67, -0.24},
    {"spine1", "spine", 0, 0.66, -0.07},
    {"chest", "spine1", 0, 0.63, 0.1},
    {"neck", "chest", 0, 0.72, 0.28},
    {"neck1", "neck", 0, 0.8, 0.35},
    {"head", "neck1", 0, 0.88, 0.42},
    {"headTip", "head", 0, 0.82, 0.66, kTip},
    {"tail", "hips", 0, 0.64, -0.52},
    {"tail1", "tail", 0, 0.61, -0.61},
    {"tail2", "tail1", 0, 0.58, -0.7},
    {"tailTip", "tail2", 0, 0.55, -0.8, kTip},
    {"leftFrontShoulder", "chest", 0.06, 0.62, 0.15},
    {"leftFrontUpperLeg", "leftFrontShoulder", 0.11, 0.58, 0.19},
    {"leftFrontLowerLeg", "leftFrontUpperLeg", 0.12, 0.36, 0.15},
    {"leftFrontFoot", "leftFrontLowerLeg", 0.12, 0.12, 0.17},
    {"leftFrontToes", "leftFrontFoot", 0.12, 0.045, 0.2},
    {"leftFrontFootTip", "leftFrontToes", 0.12, 0.01, 0.22, kTip},
    {"leftHindUpperLeg", "hips", 0.1, 0.56, -0.36},
    {"leftHindLowerLeg", "leftHindUpperLeg", 0.12, 0.38, -0.31},
    {"leftHindFoot", "leftHindLowerLeg", 0.12, 0.2, -0.43},
    {"leftHindToes", "leftHindFoot", 0.12, 0.05, -0.4},
    {"leftHindFootTip", "leftHindToes", 0.12, 0.01, -0.36, kTip},
};

constexpr Row kBird[] = {
    {"hips", "", 0, 0.5, -0.1},
    {"chest", "hips", 0, 0.58, 0.08},
    {"neck", "chest", 0, 0.7, 0.22},
    {"head", "neck", 0, 0.85, 0.32},
    {"headTip", "head", 0, 0.83, 0.5, kTip},
    {"tail", "hips", 0, 0.45, -0.3},
    {"tailTip", "tail", 0, 0.4, -0.6, kTip},
    {"leftUpperWing", "chest", 0.12, 0.62, 0.08},
    {"leftLowerWing", "leftUpperWing", 0.4, 0.64, 0.06},
    {"leftWingHand", "leftLowerWing", 0.75, 0.62, 0.02},
    {"leftWingTip", "leftWingHand", 1.15, 0.6, -0.1, kTip},
    {"leftUpperLeg", "hips", 0.09, 0.4, -0.06},
    {"leftLowerLeg", "leftUpperLeg", 0.1, 0.25, -0.04},
    {"leftFoot", "leftLowerLeg", 0.1, 0.07, -0.06},
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

TemplateSkeleton made(std::string_view name, std::span<const Row> rows, std::span<const Row> more = {}) {
  TemplateSkeleton skeleton{std::string(name), {}};
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
      made("humanoid", kHumanoid),
      made("humanoid-fingers", kHumanoid, kHandFingers),
      made("quadruped", kQuadruped),
      made("bird", kBird),
  };
  return kTemplates;
}

const TemplateSkeleton* findTemplate(std::string_view name) {
  for (const TemplateSkeleton& skeleton : templateSkeletons()) {
    if (skeleton.name == name) return &skeleton;
  }
  return nullptr;
}

}  // namespace limber
