#include "limber/session/drag/standing_feet.h"

#include <algorithm>

namespace limber {

namespace {

constexpr double kStanceWithin = 0.05;  // of the leg's length: a foot this much higher than at rest is still planted

bool isLimb(const Part& part) {
  return part.kind == PartKind::kLeg || part.kind == PartKind::kArm || part.kind == PartKind::kWing;
}

// The foot of a leg, or the last of its joints.
Index footOf(const Part& leg) {
  return leg.end.value_or(leg.joints.back());
}

double lengthAlong(const Part& part, const std::vector<Affine>& globals) {
  double length = 0;
  for (std::size_t i = 1; i < part.joints.size(); ++i) {
    length += (globals[part.joints[i]].translation() - globals[part.joints[i - 1]].translation()).norm();
  }
  return length;
}

const Part* legOf(const Anatomy& anatomy, Index foot) {
  for (const Part& part : anatomy.parts) {
    if (part.kind == PartKind::kLeg && !part.joints.empty() && footOf(part) == foot) return &part;
  }
  return nullptr;
}

bool isBodyWithLimbs(const Anatomy& anatomy) {
  return anatomy.confidence >= kDoubtful && std::any_of(anatomy.parts.begin(), anatomy.parts.end(), isLimb);
}

// Whether a handle is below two that can turn, or more.
bool hasChains(const Skeleton& handles) {
  if (handles.boneShape != BoneShape::kSphere) return false;
  for (Index j = 0; j < handles.jointCount(); ++j) {
    const std::optional<Index> base = limbBase(handles, j);
    if (base && *base != *handles.joints[j].parent) return true;
  }
  return false;
}

}  // namespace

bool hasLimbs(const RiggedModel& rig) {
  return isBodyWithLimbs(rig.anatomy()) || hasChains(rig.skeleton());
}

std::vector<PinnedTarget> standingFeet(const RiggedModel& rig, const Pose& pose) {
  const Skeleton& skeleton = rig.skeleton();
  const Anatomy& anatomy = rig.anatomy();
  const std::vector<Affine> rest = restGlobals(skeleton), posed = poseGlobals(skeleton, pose);
  std::vector<PinnedTarget> feet;
  if (!isBodyWithLimbs(anatomy)) return feet;
  for (const Part& part : anatomy.parts) {
    if (part.kind != PartKind::kLeg || part.joints.empty()) continue;
    const Index foot = footOf(part);
    if (!limbBase(skeleton, foot)) continue;
    const double risen = anatomy.axes.up.dot(posed[foot].translation() - rest[foot].translation());
    if (risen > kStanceWithin * lengthAlong(part, rest)) continue;
    feet.push_back({foot, posed[foot].translation(), decompose(posed[foot]).rotation});
  }
  return feet;
}

std::vector<PinnedTarget> pinnedDuringDrag(const RiggedModel& rig, const Pose& pose,
                                           const std::vector<PinnedTarget>& targets, Index dragged) {
  std::vector<PinnedTarget> pinned;
  for (const PinnedTarget& target : targets) {
    const Part* leg = legOf(rig.anatomy(), target.joint);
    if (!leg || !isInLimbAbove(rig.skeleton(), dragged, target.joint)) {
      pinned.push_back(target);
    } else if (leg->toes) {
      pinned.push_back({*leg->toes, poseGlobals(rig.skeleton(), pose)[*leg->toes].translation(), std::nullopt});
    }
  }
  return pinned;
}

bool isInLimbAbove(const Skeleton& skeleton, Index above, Index joint) {
  const std::optional<Index> base = limbBase(skeleton, joint);
  if (!base || above == joint) return false;
  for (Index j = joint; j != *base;) {
    j = *skeleton.joints[j].parent;
    if (j == above) return true;
  }
  return false;
}

}  // namespace limber
