#include "limber/rigging/bent_template.h"

#include <algorithm>

#include "limber/ik/humanoid_limits.h"
#include "limber/ik/ik_solver.h"

namespace limber {

namespace {

constexpr double kSizes[] = {0.8, 1, 1.25, 1.55, 1.95, 2.4};  // of the whole template, against the body's height
constexpr double kBentCost = 0.3;                             // bodies mostly stand
constexpr Index kRestarts = 2;
constexpr double kNearRest = 0.05;  // gain towards the standing pose

Skeleton skeletonOf(const TemplateSkeleton& from, const std::vector<Vec3>& standing, double size) {
  Skeleton skeleton;
  for (const TemplateJoint& joint : from.joints) {
    Joint own;
    own.name = joint.name;
    own.parent = joint.parent;
    own.rest.translation = size * standing[skeleton.joints.size()];
    if (joint.parent) own.rest.translation -= size * standing[*joint.parent];
    skeleton.joints.push_back(std::move(own));
  }
  return skeleton;
}

// The root where the pinned joints of the standing body are nearest to their pins.
void startNear(std::span<const IkTarget> targets, const Skeleton& skeleton, Pose& pose) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  Vec3 off = Vec3::Zero();
  for (const IkTarget& target : targets) off += target.position - globals[target.joint].translation();
  pose.locals.front().translation += off / static_cast<double>(targets.size());
}

}  // namespace

std::vector<TemplateVariant> bentToPins(const TemplateSkeleton& skeleton, const TemplatePins& pins,
                                        const std::vector<Vec3>& found) {
  std::vector<IkTarget> targets;
  const bool even = pinnedEvenly(skeleton, pins);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    IkTarget target;
    target.joint = j;
    if (pins[j]) {
      target.position = *pins[j];
      // To the last bit: even targets have even answers.
      if (even) {
        const Vec3 other = pins[skeleton.joints[j].mirror.value_or(j)]->cwiseProduct(Vec3(-1, 1, 1));
        target.position = 0.5 * (target.position + other);
      }
    } else if (!found.empty() && skeleton.joints[j].role == TemplateRole::kPlaced) {
      target.position = found[j];
      target.priority = 1;
    } else {
      continue;
    }
    targets.push_back(std::move(target));
  }
  std::vector<Vec3> places = skeleton.standing;
  if (!skeleton.bent()) {
    for (const TemplateJoint& joint : skeleton.joints) places.push_back(joint.place);
  }
  std::vector<TemplateVariant> variants;
  if (targets.empty()) return variants;
  for (const double size : kSizes) {
    const Skeleton standing = skeletonOf(skeleton, places, size);
    const JointLimits limits = humanoidLimits(standing, humanoidJointsByName(standing));
    Pose pose = restPose(standing);
    startNear(targets, standing, pose);
    IkOptions options;
    options.rootMotion = RootMotion::kTranslate;
    options.referenceGain = kNearRest;
    options.restarts = kRestarts;
    solveIk(findIkMethod("whole-body"), standing, pose, targets, &limits, options);
    TemplateVariant variant = {skeleton, kBentCost};
    variant.skeleton.standing = places;
    const std::vector<Affine> globals = poseGlobals(standing, pose);
    for (Index j = 0; j < skeleton.jointCount(); ++j) variant.skeleton.joints[j].place = globals[j].translation();
    variants.push_back(std::move(variant));
  }
  return variants;
}

}  // namespace limber
