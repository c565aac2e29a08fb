#include "limber/rigging/templates/figure_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "limber/rigging/templates/joints_between.h"

namespace limber {

namespace {

// People and statues of people match by 8 to 10.5, anything else by less than 6.
constexpr double kMatchOfDoubt = 6.6, kMatchSpread = 1.2, kCostOfDoubt = 1.8;
constexpr double kFitGrid = 1.0 / 8192;  // heights
constexpr double kMinLimb = 0.1;         // match of a limb, from which it counts as matched

constexpr std::array<std::array<const char*, 4>, kFigureLimbs> kLimbJoints = {
    {{"leftUpperArm", "leftLowerArm", "leftHand", "leftHandTip"},
     {"rightUpperArm", "rightLowerArm", "rightHand", "rightHandTip"},
     {"leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToesTip"},
     {"rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToesTip"}}};
constexpr std::array<const char*, 5> kTrunkJoints = {"hips", "upperChest", "neck", "head", "headTip"};

// In the order of kTrunkJoints, where people have them.
std::array<Vec3, 5> trunkPositions(const Figure& figure) {
  return {figure.pelvisJoint(), figure.waist() + 0.4 * (figure.neckBase() - figure.waist()), figure.neckJoint(),
          figure.skullBase(), figure.head - 1.1 * figure.headRadius * figure.neck};
}

AnatomicalFrame frameOf(const Figure& figure, const AnatomicalFrame& body) {
  const Vec3 up = body.axes.row(1).transpose();
  Vec3 front = figure.chest.col(2) + figure.pelvis.col(2);
  front -= front.dot(up) * up;
  if (front.norm() < 0.2) front = -up.cross(figure.pelvis.col(0));  // it lies on its back or belly
  front.normalize();
  AnatomicalFrame frame = body;
  frame.axes.row(0) = up.cross(front).transpose();
  frame.axes.row(2) = front.transpose();
  const Vec3 hips = figure.hips();
  frame.origin = hips - (hips - body.origin).dot(up) * up;
  frame.asymmetry = 1;
  return frame;
}

}  // namespace

bool isHumanoid(const TemplateSkeleton& skeleton) {
  const auto has = [&](const char* joint) { return skeleton.find(joint).has_value(); };
  return std::all_of(kTrunkJoints.begin(), kTrunkJoints.end(), has) &&
         std::all_of(kLimbJoints.begin(), kLimbJoints.end(),
                     [&](const auto& limb) { return std::all_of(limb.begin(), limb.end(), has); });
}

std::vector<FigurePin> figurePins(const TemplateSkeleton& skeleton, const TemplatePins& pins,
                                  const AnatomicalFrame& frame) {
  using Part = FigurePin::Joint;
  std::vector<FigurePin> pinned;
  const auto tell = [&](const char* name, Part joint, int limb) {
    const std::optional<Vec3>& pin = pins[skeleton.find(name).value()];
    if (pin) pinned.push_back({joint, limb, frame.fromBody(*pin)});
  };
  tell("head", Part::kHead, 0);
  tell("neck", Part::kNeck, 0);
  tell("hips", Part::kHips, 0);
  constexpr Part kInOrder[] = {Part::kRoot, Part::kMiddle, Part::kAnkle, Part::kTip};
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    for (std::size_t j = 0; j < kLimbJoints[limb].size(); ++j) tell(kLimbJoints[limb][j], kInOrder[j], limb);
  }
  return pinned;
}

TemplateFit fitOfFigure(const TemplateSkeleton& skeleton, const MatchedFigure& figure, const TemplatePins& pins,
                        const AnatomicalFrame& frame) {
  const Index count = skeleton.jointCount();
  TemplateFit fit;
  fit.skeleton = skeleton;
  for (const TemplateJoint& joint : skeleton.joints) fit.skeleton.standing.push_back(joint.position);
  fit.frame = frameOf(figure.figure, frame);
  fit.pins.resize(count);
  std::vector<Vec3>& positions = fit.embedding.positions;
  positions.assign(count, Vec3::Zero());
  fit.embedding.costs.assign(count, 0.0);
  const auto put = [&](const char* joint, const Vec3& position) {
    // On a grid: sines differ in their last bits between machines' libraries, rigs must not.
    positions[skeleton.find(joint).value()] =
        (fit.frame.toBody(position) / kFitGrid).array().round().matrix() * kFitGrid;
  };
  const std::array<Vec3, 5> trunk = trunkPositions(figure.figure);
  for (std::size_t j = 0; j < trunk.size(); ++j) put(kTrunkJoints[j], trunk[j]);
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    const LimbPositions of = figure.figure.positions(limb);
    const std::array<Vec3, 4> inOrder = {of.root, of.middle, of.ankle, of.tip};
    for (std::size_t j = 0; j < inOrder.size(); ++j) put(kLimbJoints[limb][j], inOrder[j]);
  }
  placeBetween(skeleton, positions);
  for (Index j = 0; j < count; ++j) {
    if (!pins[j]) continue;
    fit.pins[j] = fit.frame.toBody(frame.fromBody(*pins[j]));
    const Vec3 moved = *fit.pins[j] - positions[j];
    positions[j] = *fit.pins[j];
    // Ends go along, and the legs with the hips.
    for (Index other = 0; other < count; ++other) {
      const bool isEnd = skeleton.joints[other].role == TemplateRole::kTip;
      const bool isLegOfHips = !skeleton.joints[j].parent && skeleton.joints[other].mirror;
      if (pins[other] || !(isEnd || isLegOfHips)) continue;
      if (placedAbove(skeleton, other) == j) positions[other] += moved;
    }
  }
  for (Index j = 0; j < count; ++j) fit.skeleton.joints[j].position = positions[j];
  fit.limbs = limbChains(fit.skeleton);
  for (TemplateLimb& chain : fit.limbs) {
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      const Index root = *skeleton.find(kLimbJoints[limb][0]);
      const bool isIt = std::find(chain.joints.begin(), chain.joints.end(), root) != chain.joints.end();
      if (isIt) chain.hasMatch = figure.limbs[limb] > kMinLimb;
    }
  }
  fit.cost = kCostOfDoubt * std::exp((kMatchOfDoubt - figure.total) / kMatchSpread);
  return fit;
}

}  // namespace limber
