#include "limber/character/matching/neutral_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limber/character/matching/loose_joints.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

struct PoseAngles {
  // Radians; 15 to 40 degrees; a foot follows a shin that is turned by more; set by hand. A foot about as long as its
  // shin does not if the leg comes down from the hip as straight: it ends in a hock, and rests as birds' do.
  double footGoesAlong = 25 * kPi / 180;
  double hock = 0.75;                // foot over shin; 0.6 to 0.9; set by hand on a walking machine with a bird's legs
  double bent = 1.03;                // length over distance from end to end; 1.01 to 1.1; of a bent chain; set by hand
  double nearAxis = 20 * kPi / 180;  // radians; 10 to 30 degrees; from an axis that is meant; set by hand
  // Radians from upright; 15 to 45 and 30 to 60 degrees; a trunk, and a neck, that lean by more are bent: artists build
  // upright ones with less; set by hand on statues.
  double stoops = 25 * kPi / 180, bows = 45 * kPi / 180;
};
constexpr PoseAngles kPoseAngles;
// Lengths of people's arms and legs over that from the hips to the neck; 0.4 to 2 and 0.6 to 3; what artists
// build, with a margin; set by hand.
struct Range {
  double least, most;
  bool has(double value) const { return value > least && value < most; }
};
constexpr Range kArms{0.6, 1.5}, kLegs{0.8, 2.1};
// Radians; 90 to 130 degrees; least angle at the hips between the head and the feet of an upright person; set by hand.
constexpr double kOpposite = 100 * kPi / 180;

using body_part::arm;
using body_part::leg;
constexpr BodyPart kHips = body_part::kPelvis, kTrunk = body_part::kTrunk, kNeck = body_part::kNeck,
                   kHead = body_part::kHead;

// The axis of space that the direction is nearest to.
Vec3 nearestAxis(const Vec3& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0 ? -Vec3::Unit(largest) : Vec3(Vec3::Unit(largest));
}

Vec3 snapped(const Vec3& direction) {
  const Vec3 axis = nearestAxis(direction);
  return axis.dot(direction.normalized()) > std::cos(kPoseAngles.nearAxis) ? axis : Vec3(direction.normalized());
}

Vec3 sumOf(const std::vector<Vec3>& directions) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& each : directions) sum += each;
  return sum;
}

// Displacements from the hips to the head and to each foot, as far as they are there.
struct Stance {
  Vec3 head = Vec3::Zero();
  std::vector<Vec3> feet;
  Vec3 bothFeet() const { return sumOf(feet); }
  bool isWhole() const { return !head.isZero() && !feet.empty(); }
};
Stance stanceOf(const Skeleton& skeleton, const Pose& pose, const SkeletonMap& map, MapSide side) {
  const std::vector<Affine> globals = poseGlobals(skeleton, pose);
  const std::optional<Index> hips = firstOfPart(map, side, kHips), head = firstOfPart(map, side, kHead);
  Stance stance;
  const std::vector<Index>* trunk = jointsOfPart(map, side, kTrunk);
  if (!map.isBiped() || !hips || !(head || trunk)) return stance;
  const Vec3 from = globals[*hips].translation();
  stance.head = globals[head ? *head : trunk->back()].translation() - from;
  for (const Side each : kSides) {
    if (const std::optional<Index> foot = firstOfPart(map, side, leg(each, Segment::kEnd)))
      stance.feet.push_back(globals[*foot].translation() - from);
  }
  return stance;
}

double angleOf(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// From the right hip to the left one, and from shoulder to shoulder, as far as they are there.
std::vector<Vec3> leftsOf(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& positions) {
  std::vector<Vec3> lefts;
  for (const auto limb : {leg, arm}) {
    const std::optional<Index> one = firstOfPart(map, side, limb(Side::kLeft, Segment::kUpper, 0)),
                               other = firstOfPart(map, side, limb(Side::kRight, Segment::kUpper, 0));
    if (one && other) lefts.push_back(positions[*one] - positions[*other]);
  }
  return lefts;
}

// How far a person is from standing straight and upright, in radians: the trunk from +Y, each leg from the line of the
// trunk, and the shoulders from the line of the hips.
double bendOf(const Stance& stance, const std::vector<Vec3>& lefts) {
  double bend = angleOf(stance.head, Vec3::UnitY());
  for (const Vec3& foot : stance.feet) bend += angleOf(foot, -stance.head);
  return lefts.size() == 2 ? bend + angleOf(lefts[0], lefts[1]) : bend;
}

// A person in a frame of a motion, turned about the hips to face +Z. Gravity says what is up if the person is upright;
// a person who crawls or lies is turned upright along the trunk.
Pose facingAhead(const Skeleton& skeleton, Pose pose, const SkeletonMap& map, MapSide side) {
  const std::vector<Vec3> positions = posePositions(skeleton, pose);
  std::vector<Vec3> lefts = leftsOf(map, side, positions);
  for (Vec3& each : lefts) each.normalize();  // for hips that are turned against the shoulders: the mean direction
  const Vec3 trunk = stanceOf(skeleton, pose, map, side).head, level = sumOf(lefts);
  const Vec3 up = angleOf(trunk, Vec3::UnitY()) < kPoseAngles.stoops ? Vec3(Vec3::UnitY()) : Vec3(trunk.normalized());
  const Vec3 left = level - level.dot(up) * up;
  if (!(left.norm() > 1e-6 * level.norm())) return pose;
  Mat3 axes;
  axes << left.normalized(), up, left.normalized().cross(up);
  const Quat turn(Mat3(axes.transpose()));
  const Vec3 hips = positions[firstOfPart(map, side, kHips).value()];
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent) continue;
    Transform& local = pose.locals[j];
    local.translation = hips + turn * (local.translation - hips);
    local.rotation = (turn * local.rotation).normalized();
  }
  return pose;
}

// Of people, from left and right limbs, and from the hips to the head.
std::optional<Quat> bodyFrame(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& positions) {
  const auto at = [&](const BodyPart& part) -> std::optional<Vec3> {
    const std::optional<Index> joint = firstOfPart(map, side, part);
    return joint ? std::optional(positions[*joint]) : std::nullopt;
  };
  Vec3 left = sumOf(leftsOf(map, side, positions)), up = Vec3::Zero();
  const std::optional<Vec3> hips = at(kHips);
  for (const BodyPart& part : {kTrunk, kNeck, kHead}) {
    if (hips && at(part)) up += *at(part) - *hips;
  }
  for (const Side each : kSides) {
    const std::optional<Vec3> foot = at(leg(each, Segment::kEnd));
    if (hips && foot) up += *hips - *foot;
  }
  if (left.norm() < 1e-9 || up.norm() < 1e-9 || left.cross(up).norm() < 1e-6 * left.norm() * up.norm()) {
    return std::nullopt;
  }
  up = nearestAxis(up);  // gravity goes along an axis, whatever the back's bend
  left = snapped((left - left.dot(up) * up).normalized());
  left = (left - left.dot(up) * up).normalized();
  Mat3 axes;
  axes << left, up, left.cross(up);
  return Quat(axes).conjugate();
}

// Of others: level, and along an axis of space where they nearly are.
Quat frameAlong(const Axes& axes) {
  const Vec3 up = snapped(axes.up), ahead = snapped(axes.front), forward = (ahead - ahead.dot(up) * up).normalized();
  Mat3 rows;
  rows << up.cross(forward), up, forward;
  return Quat(rows).conjugate();
}

// Limb bones, where they point in the neutral pose, and where they end.
struct LimbBone {
  BodyPart part, end;
  Vec3 direction;
};
std::vector<LimbBone> limbBones() {
  std::vector<LimbBone> bones;
  for (const Side side : kSides) {
    const Vec3 outward((side == Side::kLeft ? 1.0 : -1.0) * Vec3::UnitX()), down(-Vec3::UnitY());
    bones.push_back({arm(side, Segment::kUpper), arm(side, Segment::kMiddle), outward});
    bones.push_back({arm(side, Segment::kMiddle), arm(side, Segment::kEnd), outward});
    bones.push_back({leg(side, Segment::kUpper), leg(side, Segment::kMiddle), down});
    bones.push_back({leg(side, Segment::kMiddle), leg(side, Segment::kEnd), down});
  }
  return bones;
}

// Loose joints, with what hangs on them, are where their carriers have them.
void carry(const Skeleton& skeleton, std::span<const LooseJoint> loose, const std::vector<Vec3>& rest,
           const std::vector<Quat>& turns, std::vector<Vec3>& positions) {
  for (const auto& [joint, carrier, matched] : loose) {
    const Vec3 displacement = positions[carrier] + turns[carrier] * (rest[joint] - rest[carrier]) - positions[joint];
    for (Index j = joint; j < skeleton.jointCount(); ++j) {
      if (isAncestorOrSelf(skeleton, joint, j)) positions[j] += displacement;
    }
  }
}

// A joint's bone in rest pose, and where it points in the neutral pose if it is off by more than the tolerance.
struct Aim {
  Vec3 rest, neutral;
  double tolerance = 0;
};
using Aims = std::vector<std::optional<Aim>>;  // #J

void aimLimbs(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& rest, Aims& aims) {
  for (const LimbBone& bone : limbBones()) {
    const std::optional<Index> joint = firstOfPart(map, side, bone.part), end = firstOfPart(map, side, bone.end);
    if (joint && end && (rest[*end] - rest[*joint]).norm() > 1e-9) {
      aims[*joint] = Aim{rest[*end] - rest[*joint], bone.direction};
    }
  }
}

// The length of the path through the first joints of parts; nothing where one is missing.
double pathThrough(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& rest,
                   const std::array<BodyPart, 3>& parts) {
  double length = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::optional<Index> from = firstOfPart(map, side, parts[i - 1]), to = firstOfPart(map, side, parts[i]);
    if (!from || !to) return 0;
    length += (rest[*to] - rest[*from]).norm();
  }
  return length;
}

// The trunk's joints from the hips to the neck (or head); empty where it does not reach there.
std::vector<Index> trunkOf(const SkeletonMap& map, MapSide side) {
  const std::optional<Index> hips = firstOfPart(map, side, kHips), neck = firstOfPart(map, side, kNeck),
                             head = firstOfPart(map, side, kHead);
  if (!hips || (!neck && !head)) return {};
  std::vector<Index> joints = {*hips};
  if (const std::vector<Index>* trunk = jointsOfPart(map, side, kTrunk)) {
    joints.insert(joints.end(), trunk->begin(), trunk->end());
  }
  joints.push_back(neck ? *neck : *head);
  return joints;
}

// A person who stoops at rest (a statue, say) is set upright: the hips turn the whole trunk, its middle the rest of the
// bend, the neck a head that is bowed. Trunks and necks that lean less, and all of those whose limbs are not human (a
// dinosaur's), keep their rest pose.
void aimBentTrunk(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& rest, Aims& aims) {
  const std::vector<Index> trunk = trunkOf(map, side);
  double length = 0;
  for (std::size_t i = 1; i < trunk.size(); ++i) length += (rest[trunk[i]] - rest[trunk[i - 1]]).norm();
  for (const Side each : kSides) {
    const auto lengthOf = [&](const auto& limb) {
      return pathThrough(
          map, side, rest,
          {limb(each, Segment::kUpper, 0), limb(each, Segment::kMiddle, 0), limb(each, Segment::kEnd, 0)});
    };
    if (!(kArms.has(lengthOf(arm) / length) && kLegs.has(lengthOf(leg) / length))) return;
  }
  const Vec3 up = Vec3::UnitY();
  const std::optional<Index> neck = firstOfPart(map, side, kNeck), head = firstOfPart(map, side, kHead);
  if (neck && head) aims[*neck] = Aim{rest[*head] - rest[*neck], up, kPoseAngles.bows};
  const Index hips = trunk.front(), middle = trunk[trunk.size() / 2], top = trunk.back();
  if (angleOf(rest[top] - rest[hips], up) < kPoseAngles.stoops) return;
  aims[hips] = Aim{rest[top] - rest[hips], up};
  if (middle != hips && middle != top) aims[middle] = Aim{rest[top] - rest[middle], up, kPoseAngles.stoops};
}

}  // namespace

const std::vector<Index>* jointsOfPart(const SkeletonMap& map, MapSide side, const BodyPart& part) {
  const JointMatch* match = map.find(part);
  if (!match) return nullptr;
  return side == MapSide::kSource ? &match->source : &match->target;
}

std::optional<Index> firstOfPart(const SkeletonMap& map, MapSide side, const BodyPart& part) {
  const std::vector<Index>* joints = jointsOfPart(map, side, part);
  return joints ? std::optional(joints->front()) : std::nullopt;
}

std::vector<Index> matchedJoints(const SkeletonMap& map, MapSide side) {
  std::vector<Index> joints;
  for (const JointMatch& match : map.matches) {
    const std::vector<Index>& part = side == MapSide::kSource ? match.source : match.target;
    joints.insert(joints.end(), part.begin(), part.end());
  }
  return joints;
}

bool isUpright(const Skeleton& skeleton, const Pose& pose, const SkeletonMap& map, MapSide side) {
  const Stance stance = stanceOf(skeleton, pose, map, side);
  if (!stance.isWhole()) return true;
  const auto isOpposite = [&](const Vec3& foot) { return angleOf(stance.head, foot) > kOpposite; };
  if (hasForm(skeleton, pose)) return stance.bothFeet().isZero() || isOpposite(stance.bothFeet());
  return std::all_of(stance.feet.begin(), stance.feet.end(), isOpposite);
}

Pose uprightPose(const Skeleton& skeleton, std::span<const Pose> motion, const SkeletonMap& map, MapSide side) {
  const Pose rest = restPose(skeleton);
  if (isUpright(skeleton, rest, map, side)) return rest;
  const Pose* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Pose& pose : motion) {
    const Stance stance = stanceOf(skeleton, pose, map, side);
    const double bend = bendOf(stance, leftsOf(map, side, posePositions(skeleton, pose)));
    if (!stance.isWhole() || !(bend < least)) continue;
    least = bend;
    best = &pose;
  }
  return best ? facingAhead(skeleton, *best, map, side) : rest;
}

NeutralPose neutralPose(const Skeleton& skeleton, const Pose& resting, const SkeletonMap& map, MapSide side,
                        const Axes& axes) {
  const std::vector<Vec3> rest = posePositions(skeleton, resting);
  const std::optional<Quat> ofLimbs = map.isBiped() ? bodyFrame(map, side, rest) : std::nullopt;
  return neutralPoseIn(ofLimbs ? *ofLimbs : frameAlong(axes), skeleton, resting, map, side);
}

NeutralPose neutralPoseIn(const Quat& toBody, const Skeleton& skeleton, const Pose& resting, const SkeletonMap& map,
                          MapSide side) {
  NeutralPose pose;
  pose.toBody = toBody;
  std::vector<Vec3> rest = posePositions(skeleton, resting);
  std::vector<Quat> restRotations;
  std::vector<Quat> turns(skeleton.jointCount(), Quat::Identity());
  Aims aims(skeleton.jointCount());
  std::vector<bool> isFoot(skeleton.jointCount()), isStanding(skeleton.jointCount());
  for (Vec3& position : rest) position = pose.toBody * position;
  std::vector<LooseJoint> loose;
  if (map.isBiped()) {
    aimLimbs(map, side, rest, aims);
    aimBentTrunk(map, side, rest, aims);
    loose = looseJoints(skeleton, map, side, rest);
    for (const Side each : kSides) {
      const std::optional<Index> foot = firstOfPart(map, side, leg(each, Segment::kEnd));
      if (!foot) continue;
      isFoot[*foot] = true;
      const std::optional<Index> hip = firstOfPart(map, side, leg(each, Segment::kUpper)),
                                 knee = firstOfPart(map, side, leg(each, Segment::kMiddle)),
                                 toes = toesOf(skeleton, map, side, each, rest);
      if (!hip || !knee || !toes) continue;
      const bool hock = (rest[*toes] - rest[*foot]).norm() > kPoseAngles.hock * (rest[*foot] - rest[*knee]).norm();
      isStanding[*foot] = hock && angleOf(rest[*toes] - rest[*hip], -Vec3::UnitY()) < kPoseAngles.footGoesAlong;
    }
  }

  pose.positions.resize(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const Quat parentRest = joint.parent ? restRotations[*joint.parent] : pose.toBody;
    restRotations.push_back((parentRest * resting.locals[j].rotation).normalized());
    const Quat above = joint.parent ? turns[*joint.parent] : Quat::Identity();
    turns[j] = above;
    if (aims[j] && angleOf(above * aims[j]->rest, aims[j]->neutral) >= aims[j]->tolerance) {
      turns[j] = (shortestRotation(above * aims[j]->rest, aims[j]->neutral) * above).normalized();
    }
    const bool free = isStanding[j] || angleBetween(Quat::Identity(), above) < kPoseAngles.footGoesAlong;
    if (isFoot[j] && free) turns[j] = Quat::Identity();
    pose.rotations.push_back((turns[j] * restRotations[j]).normalized());
    pose.positions[j] =
        joint.parent ? Vec3(pose.positions[*joint.parent] + above * (rest[j] - rest[*joint.parent])) : rest[j];
  }
  carry(skeleton, loose, rest, turns, pose.positions);
  pose.restPositions = std::move(rest);
  return pose;
}

Vec3 pelvisOf(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& positions) {
  const std::optional<Index> left = firstOfPart(map, side, leg(Side::kLeft, Segment::kUpper)),
                             right = firstOfPart(map, side, leg(Side::kRight, Segment::kUpper));
  if (map.isBiped() && left && right) return 0.5 * (positions[*left] + positions[*right]);
  const std::optional<Index> hips = firstOfPart(map, side, kHips);
  if (hips && !map.jointByJoint) return positions[*hips];
  const JointMatch& first = map.matches.front();
  return positions[side == MapSide::kSource ? first.source.front() : first.target.front()];
}

std::optional<Index> toesOf(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, Side each,
                            std::span<const Vec3> rest) {
  const std::optional<Index> toes = firstOfPart(map, side, leg(each, Segment::kToes)),
                             foot = firstOfPart(map, side, leg(each, Segment::kEnd));
  if (!map.isBiped()) return std::nullopt;
  if (toes || !foot) return toes;
  std::optional<Index> tip;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Vec3 displacement = rest[j] - rest[*foot];
    if (skeleton.joints[j].parent != foot || displacement.z() <= 0 || displacement.y() >= 0) continue;
    if (!tip || rest[j].z() > rest[*tip].z()) tip = j;
  }
  return tip;
}

bool isBent(std::span<const Index> joints, Index end, std::span<const Vec3> positions) {
  double pathLength = (positions[end] - positions[joints.back()]).norm();
  for (std::size_t i = 1; i < joints.size(); ++i)
    pathLength += (positions[joints[i]] - positions[joints[i - 1]]).norm();
  return pathLength > kPoseAngles.bent * (positions[end] - positions[joints.front()]).norm();
}

std::vector<Index> soleJoints(const SkeletonMap& map, MapSide side) {
  std::vector<Index> joints;
  if (!map.isBiped()) return joints;
  for (const Segment segment : {Segment::kEnd, Segment::kToes}) {
    for (const Side each : kSides) {
      if (const std::optional<Index> foot = firstOfPart(map, side, leg(each, segment))) joints.push_back(*foot);
    }
  }
  return joints;
}

}  // namespace limber
