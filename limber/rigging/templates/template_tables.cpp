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
  double lengthSpread, turnSpread;
};

// Positions and spreads: means and deviations over artists' rigs (docs/template-rigs.md names them).
constexpr Row kHumanoid[] = {
    {"hips", "", 0, 0.50, 0, kPlaced, 0, 0},
    {"spine", "hips", 0, 0.565, 0, kBetween, 0, 0},
    {"chest", "spine", 0, 0.645, 0, kBetween, 0, 0},
    {"upperChest", "chest", 0, 0.73, 0, kPlaced, 0.3, 0.25},
    {"neck", "upperChest", 0, 0.80, 0, kPlaced, 0.4, 0.3},
    {"head", "neck", 0, 0.86, 0, kPlaced, 0.4, 0.35},
    {"headTip", "head", 0, 0.98, 0, kTip, 0.6, 0.35},
    {"leftShoulder", "upperChest", 0.035, 0.76, 0.015, kBetween, 0, 0},
    {"leftUpperArm", "leftShoulder", 0.09, 0.775, 0, kPlaced, 0.4, 0.4},
    {"leftLowerArm", "leftUpperArm", 0.21, 0.73, 0, kPlaced, 0.3, 0.65},
    {"leftHand", "leftLowerArm", 0.33, 0.68, 0.01, kPlaced, 0.3, 0.65},
    {"leftHandTip", "leftHand", 0.43, 0.64, 0.02, kTip, 0.4, 0.7},
    {"leftUpperLeg", "hips", 0.065, 0.495, 0, kPlaced, 0.6, 0.5},
    {"leftLowerLeg", "leftUpperLeg", 0.075, 0.275, 0, kPlaced, 0.4, 0.3},
    {"leftFoot", "leftLowerLeg", 0.08, 0.05, -0.02, kPlaced, 0.4, 0.3},
    {"leftToes", "leftFoot", 0.085, 0.012, 0.05, kBetween, 0, 0},
    {"leftToesTip", "leftToes", 0.09, 0.01, 0.09, kTip, 0.4, 0.5},
};

constexpr Row kHandFingers[] = {
    {"leftThumbMetacarpal", "leftHand", 0.345, 0.68, 0.025, kBetween, 0, 0},
    {"leftThumbProximal", "leftThumbMetacarpal", 0.365, 0.67, 0.037, kBetween, 0, 0},
    {"leftThumbDistal", "leftThumbProximal", 0.38, 0.66, 0.045, kBetween, 0, 0},
    {"leftIndexProximal", "leftHand", 0.382, 0.658, 0.03, kBetween, 0, 0},
    {"leftIndexIntermediate", "leftIndexProximal", 0.405, 0.648, 0.033, kBetween, 0, 0},
    {"leftIndexDistal", "leftIndexIntermediate", 0.419, 0.642, 0.035, kBetween, 0, 0},
    {"leftMiddleProximal", "leftHand", 0.385, 0.657, 0.016, kBetween, 0, 0},
    {"leftMiddleIntermediate", "leftMiddleProximal", 0.41, 0.647, 0.017, kBetween, 0, 0},
    {"leftMiddleDistal", "leftMiddleIntermediate", 0.425, 0.641, 0.018, kBetween, 0, 0},
    {"leftRingProximal", "leftHand", 0.382, 0.657, 0.003, kBetween, 0, 0},
    {"leftRingIntermediate", "leftRingProximal", 0.405, 0.647, 0.002, kBetween, 0, 0},
    {"leftRingDistal", "leftRingIntermediate", 0.419, 0.641, 0.001, kBetween, 0, 0},
    {"leftLittleProximal", "leftHand", 0.376, 0.657, -0.01, kBetween, 0, 0},
    {"leftLittleIntermediate", "leftLittleProximal", 0.393, 0.648, -0.012, kBetween, 0, 0},
    {"leftLittleDistal", "leftLittleIntermediate", 0.404, 0.642, -0.013, kBetween, 0, 0},
};

constexpr Row kQuadruped[] = {
    {"hips", "", 0, 0.66, -0.4, kPlaced, 0, 0},
    {"spine", "hips", 0, 0.67, -0.24, kBetween, 0, 0},
    {"spine1", "spine", 0, 0.66, -0.07, kBetween, 0, 0},
    {"chest", "spine1", 0, 0.63, 0.1, kPlaced, 0.4, 0.4},
    {"neck", "chest", 0, 0.72, 0.28, kPlaced, 0.5, 0.5},
    {"neck1", "neck", 0, 0.8, 0.35, kBetween, 0, 0},
    {"head", "neck1", 0, 0.88, 0.42, kPlaced, 0.5, 0.6},
    {"headTip", "head", 0, 0.82, 0.66, kTip, 0.5, 0.8},
    {"tail", "hips", 0, 0.64, -0.52, kPlaced, 0.6, 0.6},
    {"tail1", "tail", 0, 0.61, -0.61, kBetween, 0, 0},
    {"tail2", "tail1", 0, 0.58, -0.7, kBetween, 0, 0},
    {"tailTip", "tail2", 0, 0.55, -0.8, kTip, 0.7, 0.9},
    {"leftFrontShoulder", "chest", 0.06, 0.62, 0.15, kBetween, 0, 0},
    {"leftFrontUpperLeg", "leftFrontShoulder", 0.11, 0.58, 0.19, kPlaced, 0.5, 0.6},
    {"leftFrontLowerLeg", "leftFrontUpperLeg", 0.12, 0.36, 0.15, kPlaced, 0.4, 0.4},
    {"leftFrontFoot", "leftFrontLowerLeg", 0.12, 0.12, 0.17, kPlaced, 0.4, 0.35},
    {"leftFrontToes", "leftFrontFoot", 0.12, 0.045, 0.2, kBetween, 0, 0},
    {"leftFrontFootTip", "leftFrontToes", 0.12, 0.01, 0.22, kTip, 0.5, 0.6},
    {"leftHindUpperLeg", "hips", 0.1, 0.56, -0.36, kPlaced, 0.5, 0.8},
    {"leftHindLowerLeg", "leftHindUpperLeg", 0.12, 0.38, -0.31, kPlaced, 0.4, 0.4},
    {"leftHindFoot", "leftHindLowerLeg", 0.12, 0.2, -0.43, kPlaced, 0.4, 0.4},
    {"leftHindToes", "leftHindFoot", 0.12, 0.05, -0.4, kBetween, 0, 0},
    {"leftHindFootTip", "leftHindToes", 0.12, 0.01, -0.36, kTip, 0.5, 0.6},
};

constexpr Row kBird[] = {
    {"hips", "", 0, 0.5, -0.1, kPlaced, 0, 0},
    {"chest", "hips", 0, 0.58, 0.08, kPlaced, 0.5, 0.5},
    {"neck", "chest", 0, 0.7, 0.22, kPlaced, 0.5, 0.5},
    {"head", "neck", 0, 0.85, 0.32, kPlaced, 0.6, 0.6},
    {"headTip", "head", 0, 0.83, 0.5, kTip, 0.6, 0.8},
    {"tail", "hips", 0, 0.45, -0.3, kPlaced, 0.5, 0.5},
    {"tailTip", "tail", 0, 0.4, -0.6, kTip, 0.6, 0.6},
    {"leftUpperWing", "chest", 0.12, 0.62, 0.08, kPlaced, 0.5, 0.6},
    {"leftLowerWing", "leftUpperWing", 0.4, 0.64, 0.06, kPlaced, 0.5, 0.6},
    {"leftWingHand", "leftLowerWing", 0.75, 0.62, 0.02, kPlaced, 0.5, 0.6},
    {"leftWingTip", "leftWingHand", 1.15, 0.6, -0.1, kTip, 0.5, 0.6},
    {"leftUpperLeg", "hips", 0.09, 0.4, -0.06, kPlaced, 0.5, 0.6},
    {"leftLowerLeg", "leftUpperLeg", 0.1, 0.25, -0.04, kPlaced, 0.5, 0.5},
    {"leftFoot", "leftLowerLeg", 0.1, 0.07, -0.06, kPlaced, 0.5, 0.5},
    {"leftFootTip", "leftFoot", 0.1, 0.01, 0.06, kTip, 0.5, 0.6},
};

// The same in flight: a long body low over its legs, wings that span more than it is high.
constexpr Row kFlyingBird[] = {
    {"hips", "", 0, 0.66, -0.2, kPlaced, 0, 0},
    {"chest", "hips", 0, 0.66, 0.2, kPlaced, 0.8, 0.7},
    {"neck", "chest", 0, 0.7, 0.5, kPlaced, 0.8, 0.7},
    {"head", "neck", 0, 0.78, 0.75, kPlaced, 1, 0.8},
    {"headTip", "head", 0, 0.74, 1.1, kTip, 1, 1.1},
    {"tail", "hips", 0, 0.72, -0.5, kPlaced, 0.8, 0.7},
    {"tailTip", "tail", 0, 0.78, -1.1, kTip, 1, 0.8},
    {"leftUpperWing", "chest", 0.14, 0.66, 0.28, kPlaced, 0.8, 0.8},
    {"leftLowerWing", "leftUpperWing", 0.8, 0.9, 0.25, kPlaced, 0.8, 0.8},
    {"leftWingHand", "leftLowerWing", 1.5, 0.9, 0, kPlaced, 0.8, 0.8},
    {"leftWingTip", "leftWingHand", 2.3, 0.85, -0.4, kTip, 0.8, 0.8},
    {"leftUpperLeg", "hips", 0.09, 0.58, -0.3, kPlaced, 0.8, 0.8},
    {"leftLowerLeg", "leftUpperLeg", 0.14, 0.4, -0.28, kPlaced, 0.8, 0.7},
    {"leftFoot", "leftLowerLeg", 0.12, 0.08, -0.28, kPlaced, 0.8, 0.7},
    {"leftFootTip", "leftFoot", 0.12, 0.02, -0.05, kTip, 0.8, 0.8},
};

// How bodies differ from the humanoid as a whole: toys and cartoons have short legs, large heads, long arms. What is
// rarer costs more.
struct Build {
  double legs;   // their length
  double trunk;  // height of all below the head, after that
  double arms;   // their length, after that
  double cost;
};
constexpr Build kBuilds[] = {
    {1, 1, 1, 0},          {0.7, 1, 1, 0},         {0.4, 1, 1, 0},        {0.7, 0.75, 1, 0.1},   {0.4, 0.75, 1, 0.1},
    {0.4, 0.55, 1, 0.1},   {0.85, 0.87, 1.7, 0.2}, {1, 1, 1.7, 0.2},      {0.7, 0.75, 1.7, 0.2}, {0.4, 0.75, 1.7, 0.2},
    {0.4, 0.55, 1.7, 0.2}, {0.85, 0.87, 2.8, 0.3}, {0.7, 0.75, 2.8, 0.3}, {0.4, 0.75, 2.8, 0.3},
};

// How animals differ from the quadruped: cows, cats and wolves carry their heads level with their backs.
constexpr double kLongAnimal = 1.35;
constexpr double kRareAnimal = 0.05;
const Vec3 kLowHead(0, 0.04, 0.2), kLowHeadTip(0, -0.06, 0.25);  // from the neck, from the head

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
  joint.lengthSpread = row.lengthSpread;
  joint.turnSpread = row.turnSpread;
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

namespace {

// Animals that carry their heads low, and such as are long for their height. Needs a neck, a head and its tip in front.
std::vector<TemplateVariant> animalVariants(const TemplateSkeleton& skeleton, Index neck, Index head, Index tip) {
  std::vector<TemplateVariant> variants;
  for (const bool low : {false, true}) {
    for (const double length : {1.0, kLongAnimal}) {
      TemplateVariant variant = {skeleton, low || length > 1 ? kRareAnimal : 0};
      std::vector<TemplateJoint>& joints = variant.skeleton.joints;
      if (low) {
        joints[head].position = joints[neck].position + kLowHead;
        joints[tip].position = joints[head].position + kLowHeadTip;
      }
      for (TemplateJoint& joint : joints) joint.position.z() *= length;
      variants.push_back(std::move(variant));
    }
  }
  return variants;
}

bool isBird(const TemplateSkeleton& skeleton) {
  const TemplateSkeleton& bird = findTemplate("bird");
  return skeleton.jointCount() == bird.jointCount() &&
         std::equal(skeleton.joints.begin(), skeleton.joints.end(), bird.joints.begin(),
                    [](const TemplateJoint& a, const TemplateJoint& b) { return a.name == b.name; });
}

}  // namespace

std::vector<TemplateVariant> templateVariants(const TemplateSkeleton& skeleton) {
  if (isBird(skeleton)) return {{skeleton, 0}, {made(skeleton.name, skeleton.summary, kFlyingBird), 0}};
  const std::optional<Index> neck = skeleton.find("neck"), head = skeleton.find("head"), tip = skeleton.find("headTip");
  if (skeleton.find("leftFrontUpperLeg") && neck && head && tip) return animalVariants(skeleton, *neck, *head, *tip);
  const std::optional<Index> hips = skeleton.find("hips"),
                             arms[] = {skeleton.find("leftUpperArm"), skeleton.find("rightUpperArm")};
  if (!hips || !arms[0] || !arms[1] || !skeleton.find("leftUpperLeg") || !skeleton.find("neck")) return {{skeleton, 0}};
  const double hipY = skeleton.joints[*hips].position.y();
  std::vector<TemplateVariant> variants;
  for (const Build& build : kBuilds) {
    TemplateVariant variant = {skeleton, build.cost};
    std::vector<TemplateJoint>& joints = variant.skeleton.joints;
    for (TemplateJoint& joint : joints) {
      if (joint.role == TemplateRole::kTip && !joint.mirror) continue;  // the top of the head stays
      double& y = joint.position.y();
      y = y < hipY ? build.legs * y : y - (1 - build.legs) * hipY;
      y *= build.trunk;
    }
    for (const std::optional<Index>& arm : arms) {
      const Vec3 shoulder = joints[*arm].position;
      std::vector<bool> below(joints.size(), false);
      for (Index j = *arm + 1; j < variant.skeleton.jointCount(); ++j) {
        below[j] = joints[j].parent && (*joints[j].parent == *arm || below[*joints[j].parent]);
        if (below[j]) joints[j].position = shoulder + build.arms * (joints[j].position - shoulder);
      }
    }
    variants.push_back(std::move(variant));
  }
  return variants;
}

}  // namespace limber
