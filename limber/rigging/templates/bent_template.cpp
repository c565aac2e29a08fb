#include "limber/rigging/templates/bent_template.h"

#include <algorithm>

#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"

namespace limber {

namespace {

constexpr double kSizes[] = {0.8, 1, 1.25, 1.55, 1.95, 2.4};
constexpr double kBentCost = 0.3;     // bodies mostly stand
constexpr double kTurnedCost = 1;     // of bones at right angles to how they stand
constexpr double kGrid = 1.0 / 8192;  // heights
constexpr Index kRestarts = 2;
constexpr double kNearRest = 0.05;  // gain towards the standing pose

std::vector<Vec3> standingPositions(const TemplateSkeleton& skeleton) {
  if (skeleton.bent()) return skeleton.standing;
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  return positions;
}

Skeleton skeletonOf(const TemplateSkeleton& from, const std::vector<Vec3>& positions, double size) {
  Skeleton skeleton;
  for (Index j = 0; j < from.jointCount(); ++j) {
    Joint joint;
    joint.name = from.joints[j].name;
    joint.parent = from.joints[j].parent;
    joint.rest.translation = size * positions[j];
    if (joint.parent) joint.rest.translation -= size * positions[*joint.parent];
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

std::vector<IkTarget> ikTargets(const TemplateSkeleton& skeleton, std::span<const BendTarget> targets) {
  TemplatePins firm(skeleton.jointCount());
  for (const BendTarget& target : targets) {
    if (target.firm) firm[target.joint] = target.position;
  }
  const bool even = pinnedEvenly(skeleton, firm);
  std::vector<IkTarget> result;
  for (const BendTarget& from : targets) {
    IkTarget target;
    target.joint = from.joint;
    target.position = from.position;
    target.priority = from.firm ? 0 : 1;
    // To the last bit: even targets have even answers.
    if (from.firm && even) {
      const Vec3 other = firm[skeleton.joints[from.joint].mirror.value_or(from.joint)]->cwiseProduct(Vec3(-1, 1, 1));
      target.position = 0.5 * (from.position + other);
    }
    result.push_back(std::move(target));
  }
  return result;
}

// The root where the joints of the standing body are nearest to their targets.
void startNear(std::span<const IkTarget> targets, const Skeleton& skeleton, Pose& pose) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  Vec3 off = Vec3::Zero();
  for (const IkTarget& target : targets) off += target.position - globals[target.joint].translation();
  pose.locals.front().translation += off / static_cast<double>(targets.size());
}

// 1 - cos of the angles that bones are turned by from how they stand, in the mean.
double meanTurn(const TemplateSkeleton& skeleton) {
  double turn = 0;
  Index bones = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) continue;
    const Index parent = *skeleton.joints[j].parent;
    const Vec3 bone = skeleton.joints[j].position - skeleton.joints[parent].position,
               standing = skeleton.standing[j] - skeleton.standing[parent];
    turn += 1 - bone.normalized().dot(standing.normalized());
    ++bones;
  }
  return bones > 0 ? turn / static_cast<double>(bones) : 0;
}

}  // namespace

TemplateVariant bentTemplate(const TemplateSkeleton& skeleton, std::span<const BendTarget> targets, double size) {
  TemplateVariant variant = {skeleton, kBentCost};
  variant.skeleton.standing = standingPositions(skeleton);
  const Skeleton standing = skeletonOf(skeleton, variant.skeleton.standing, size);
  const JointLimits limits = humanoidLimits(standing, jointsCalledAsBones(standing));
  const std::vector<IkTarget> wanted = ikTargets(skeleton, targets);
  Pose pose = restPose(standing);
  startNear(wanted, standing, pose);
  IkOptions options;
  options.rootMotion = RootMotion::kTranslate;
  options.referenceGain = kNearRest;
  options.restarts = kRestarts;
  solveIk(findIkMethod("whole-body"), standing, pose, wanted, &limits, options);
  const std::vector<Affine> globals = poseGlobals(standing, pose);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    // On a grid: sines differ in their last bits between machines' libraries, rigs must not.
    variant.skeleton.joints[j].position = (globals[j].translation() / kGrid).array().round().matrix() * kGrid;
  }
  variant.cost += kTurnedCost * meanTurn(variant.skeleton);
  return variant;
}

double sizeOf(const TemplateSkeleton& skeleton) {
  if (!skeleton.bent()) return 1;
  double bones = 0, standing = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) continue;
    const Index parent = *skeleton.joints[j].parent;
    bones += (skeleton.joints[j].position - skeleton.joints[parent].position).norm();
    standing += (skeleton.standing[j] - skeleton.standing[parent]).norm();
  }
  return standing > 0 ? bones / standing : 1;
}

std::vector<TemplateVariant> bentToPins(const TemplateSkeleton& skeleton, const TemplatePins& pins) {
  std::vector<BendTarget> targets;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (pins[j]) targets.push_back({j, *pins[j], true});
  }
  std::vector<TemplateVariant> variants;
  if (targets.empty()) return variants;
  for (const double size : kSizes) variants.push_back(bentTemplate(skeleton, targets, size));
  return variants;
}

}  // namespace limber
