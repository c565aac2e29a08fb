#include "limber/evaluate/rig/rig_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/assignment.h"
#include "limber/document/asset.h"
#include "limber/evaluate/rig/body_joints.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

constexpr int kBonePoints = 100;
constexpr double kPaired = 0.05;  // longest sides within which two joints may be a pair

// Bones of a person that every artist's skeleton means alike.
constexpr std::string_view kCompared[] = {
    "hips",         "spine",    "chest",         "neck",          "head",      "leftUpperArm",
    "leftLowerArm", "leftHand", "rightUpperArm", "rightLowerArm", "rightHand", "leftUpperLeg",
    "leftLowerLeg", "leftFoot", "rightUpperLeg", "rightLowerLeg", "rightFoot"};
double nearest(const Vec3& point, const std::vector<Vec3>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& other : points) least = std::min(least, (other - point).squaredNorm());
  return std::sqrt(least);
}

std::vector<Vec3> pointsAlong(const BodyFigure& figure) {
  if (figure.bones.empty()) return figure.joints;
  std::vector<Vec3> points;
  for (const BoneLine& bone : figure.bones) {
    for (int i = 0; i < kBonePoints; ++i) points.push_back(bone.a + i / (kBonePoints - 1.0) * (bone.b - bone.a));
  }
  return points;
}

double meanNearest(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double sum = 0;
  for (const Vec3& point : from) sum += nearest(point, to);
  return sum / static_cast<double>(from.size());
}

Index pairsWithin(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double reach) {
  // Pairs beyond reach cost so much that none is taken instead of one within.
  const double far = 1e3 * reach * static_cast<double>(a.size() + b.size());
  std::vector<std::vector<double>> costs(a.size(), std::vector<double>(b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double distance = (a[i] - b[k]).norm();
      costs[i][k] = distance <= reach ? distance : far;
    }
  }
  Index pairs = 0;
  const std::vector<std::optional<Index>> partner = cheapestPairs(costs);
  for (std::size_t i = 0; i < a.size(); ++i) pairs += partner[i] && costs[i][*partner[i]] < far;
  return pairs;
}

RigDistances distancesOf(const BodyFigure& predicted, const BodyFigure& truth, double side) {
  RigDistances d;
  d.joints = static_cast<Index>(predicted.joints.size());
  d.truthJoints = static_cast<Index>(truth.joints.size());
  if (d.joints == 0 || d.truthJoints == 0) return d;
  const std::vector<Vec3> points = pointsAlong(predicted), truthPoints = pointsAlong(truth);
  const auto both = [&](const std::vector<Vec3>& a, const std::vector<Vec3>& b, const std::vector<Vec3>& c,
                        const std::vector<Vec3>& e) { return 50 * (meanNearest(a, b) + meanNearest(c, e)) / side; };
  d.jointToJoint = both(predicted.joints, truth.joints, truth.joints, predicted.joints);
  d.jointToBone = both(predicted.joints, truthPoints, truth.joints, points);
  d.boneToBone = both(points, truthPoints, truthPoints, points);
  const double pairs = pairsWithin(predicted.joints, truth.joints, kPaired * side);
  d.precision = pairs / d.joints;
  d.recall = pairs / d.truthJoints;
  d.iou = pairs / (d.joints + d.truthJoints - pairs);
  return d;
}

std::optional<Vec3> positionOf(std::string_view bone, const std::vector<HumanoidJoint>& named,
                               const std::vector<Affine>& globals) {
  for (const HumanoidJoint& joint : named) {
    if (joint.bone == bone) return Vec3(globals[joint.joint].translation());
  }
  return std::nullopt;
}

// The extent of the box along the axis that comes nearest to the direction from feet to head; its longest side where
// these are not known.
double heightOf(const Box& box, const std::vector<HumanoidJoint>& named, const std::vector<Affine>& globals) {
  const std::optional<Vec3> head = positionOf("head", named, globals), foot = positionOf("leftFoot", named, globals);
  if (!head || !foot) return box.longestSide();
  int axis = 0;
  (*head - *foot).cwiseAbs().maxCoeff(&axis);
  return box.size()[axis];
}

void compareNamed(const SkinnedModel& predicted, const SkinnedModel& truth, const Box& box, RigComparison& result) {
  const std::vector<HumanoidJoint> own = humanoidJoints(predicted.skeleton), given = humanoidJoints(truth.skeleton);
  const std::vector<Affine> ownGlobals = restGlobals(predicted.skeleton), givenGlobals = restGlobals(truth.skeleton);
  const double height = heightOf(box, given, givenGlobals);
  for (const std::string_view bone : kCompared) {
    std::optional<Vec3> a = positionOf(bone, own, ownGlobals), b = positionOf(bone, given, givenGlobals);
    if (!a || !b) continue;
    // A trunk of two bones has the second at the chest or at its upper end: artists call either the chest.
    if (bone == "chest" && !positionOf("upperChest", given, givenGlobals)) {
      const std::optional<Vec3> upper = positionOf("upperChest", own, ownGlobals);
      if (upper && (*upper - *b).norm() < (*a - *b).norm()) a = upper;
    }
    result.named.push_back({std::string(bone), 100 * (*a - *b).norm() / height});
  }
  for (const NamedJointError& error : result.named) {
    result.namedMean += error.percent / static_cast<double>(result.named.size());
    result.namedWorst = std::max(result.namedWorst, error.percent);
  }
}

}  // namespace

RigComparison compareRigs(const SkinnedModel& predicted, const SkinnedModel& truth) {
  Box box;
  for (const Triangle& t : truth.mesh.triangles) {
    for (const Index v : t) box.add(truth.mesh.position(v));
  }
  const double side = box.longestSide() > 0 ? box.longestSide() : 1;
  const std::vector<bool> own(predicted.skeleton.jointCount(), true), given = countedJoints(truth);
  RigComparison result;
  result.all = distancesOf(figureOf(predicted.skeleton, own), figureOf(truth.skeleton, given), side);
  result.withoutFingers = distancesOf(figureOf(predicted.skeleton, bodyJoints(predicted.skeleton, own)),
                                      figureOf(truth.skeleton, bodyJoints(truth.skeleton, given)), side);
  compareNamed(predicted, truth, box, result);
  return result;
}

RigComparison compareRigs(const Character& predicted, const Character& truth) {
  return compareRigs(readSkinnedModel(predicted), readSkinnedModel(truth));
}

double insideFraction(const SkinnedModel& model) {
  const WindingNumber winding(model.mesh);
  double inside = 0;
  for (const Affine& global : restGlobals(model.skeleton)) inside += winding.exactAt(global.translation()) > 0.5;
  return model.skeleton.joints.empty() ? 0 : inside / model.skeleton.jointCount();
}

}  // namespace limber
