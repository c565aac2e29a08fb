#include "limber/evaluate/motion/known_answers.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "limber/character/anatomy/anatomy.h"
#include "limber/character/matching/plain_skeleton.h"
#include "limber/core/text/numbers.h"
#include "limber/motion/limbs/roughness.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {

namespace {

constexpr double kSmaller = 0.6;
constexpr double kReposedArms = 0.7, kReposedLegs = 0.12;  // radians, about the axis that the body faces along
constexpr double kAlike = 0.01;                            // of the body's size, between a joint and its mirror image's

Skeleton nameless(Skeleton body) {
  for (Index j = 0; j < body.jointCount(); ++j) body.joints[j].name = fmt::format("q{}", j);
  return body;
}

// Each limb turned where it begins, outwards or inwards.
Skeleton reposed(Skeleton body) {
  const std::vector<Affine> globals = restGlobals(body);
  const SkeletonMap parts = matchSkeletons(body, body);
  const Vec3 front = readAnatomy(body).axes.front;
  for (const Side side : kSides) {
    for (const PartKind kind : {PartKind::kArm, PartKind::kLeg}) {
      const JointMatch* limb = parts.find({kind, side, 0, Segment::kUpper, 0});
      if (!limb) continue;
      Joint& joint = body.joints[limb->target.front()];
      const Quat above = joint.parent ? Quat(globals[*joint.parent].rotation()) : Quat::Identity();
      const double angle = (kind == PartKind::kArm ? kReposedArms : kReposedLegs) * (side == Side::kLeft ? -1 : 1);
      const Quat turn(Eigen::AngleAxisd(angle, front));
      joint.rest.rotation = (above.conjugate() * turn * above * joint.rest.rotation).normalized();
    }
  }
  return body;
}

Skeleton scaled(Skeleton body, double factor) {
  for (Joint& joint : body.joints) joint.rest.translation *= factor;
  return body;
}

Skeleton mirrored(Skeleton body) {
  for (Joint& joint : body.joints) {
    if (joint.parent) continue;
    joint.rest.translation.x() = -joint.rest.translation.x();
    // mirror * R = (mirror * R * mirror) * mirror: the mirrored rotation, and a negative scale along x.
    const Quat& r = joint.rest.rotation;
    joint.rest.rotation = Quat(r.w(), r.x(), -r.y(), -r.z());
    joint.rest.scale.x() = -joint.rest.scale.x();
  }
  return body;
}

// Whether each joint has one where its mirror image is.
bool isSymmetric(const Skeleton& body) {
  const std::vector<Vec3> rest = restPositions(body);
  Box box;
  for (const Vec3& position : rest) box.add(position);
  return std::all_of(rest.begin(), rest.end(), [&](const Vec3& position) {
    return std::any_of(rest.begin(), rest.end(), [&](const Vec3& other) {
      return (Vec3(-position.x(), position.y(), position.z()) - other).norm() < kAlike * box.diagonal();
    });
  });
}

// Else nothing tells up from down: recordings' rest poses may have all bones along one axis.
bool hasHeadAndFeetApart(const Skeleton& body) {
  const std::vector<Vec3> rest = restPositions(body);
  const SkeletonMap parts = matchSkeletons(body, body);
  const JointMatch *head = parts.find(body_part::kHead), *pelvis = parts.find(body_part::kPelvis);
  if (!head || !pelvis) return true;
  const Vec3 middle = rest[pelvis->target.back()], up = rest[head->target.back()] - middle;
  return std::all_of(std::begin(kSides), std::end(kSides), [&](Side side) {
    const JointMatch* foot = parts.find(body_part::leg(side, Segment::kEnd));
    return !foot || up.dot(rest[foot->target.back()] - middle) < 0;
  });
}

}  // namespace

std::vector<KnownAnswer> knownAnswers(const Skeleton& motion) {
  std::vector<KnownAnswer> answers = {
      {"own", motion}, {"renamed", nameless(motion)}, {"scaled", scaled(motion, kSmaller), kSmaller}};
  if (hasHeadAndFeetApart(motion)) answers.push_back({"reposed", reposed(motion)});
  if (isSymmetric(motion)) answers.push_back({"mirrored", mirrored(motion)});
  return answers;
}

double errorOfAnswer(const RetargetMethod& method, const Skeleton& motion, const PoseSequence& frames,
                     const KnownAnswer& answer, const RetargetOptions& options) {
  const PlainSkeleton from(motion), to(answer.body);
  const PoseSequence source = from.plain(frames);
  const RetargetSetup setup(from.skeleton(), to.skeleton(), matchSkeletons(from.skeleton(), to.skeleton()), options,
                            &source);
  const PoseSequence result = to.original(retargetFrames(method, setup, source));
  const double height = standingHeight(setup, MapSide::kTarget);
  // A recording's ground need not be that of its rest pose; a retargeted motion is put on the target's ground.
  const Vec3 ground = (setup.targetGround - answer.scale * setup.sourceGround) * Vec3::UnitY();
  double worst = 0;
  for (std::size_t f = 0; f < frames.poses.size(); ++f) {
    const std::vector<Vec3> right = posePositions(motion, frames.poses[f]),
                            given = posePositions(answer.body, result.poses[f]);
    for (const JointMatch& match : setup.map.matches) {
      if (match.source.size() != match.target.size()) continue;
      for (std::size_t i = 0; i < match.source.size(); ++i) {
        worst =
            std::max(worst, (given[match.target[i]] - ground - answer.scale * right[match.source[i]]).norm() / height);
      }
    }
  }
  return worst;
}

}  // namespace limber
