#include "limber/matching/neutral_pose.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/ik/rotation.h"
#include "limber/matching/loose_joints.h"
#include "limber/matching/quadruped.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// A foot goes along with a shin that is turned by more. One that is about as long as its shin does not where the leg
// comes down from the hip as straight: it ends in a hock, and stands as birds' do.
constexpr double kFootGoesAlong = 25 * kPi / 180;
constexpr double kHock = 0.75;  // foot over shin
constexpr double kBent = 1.03;  // times the way from end to end
constexpr double kNearAxis = 20 * kPi / 180;
// A trunk, and a neck, that lean by more are bent: artists build upright ones with less.
constexpr double kStoops = 25 * kPi / 180;
constexpr double kBows = 45 * kPi / 180;
// What arms and legs of people are long, over the way from the hips to the neck.
struct Range {
  double least, most;
  bool has(double value) const { return value > least && value < most; }
};
constexpr Range kArms{0.6, 1.5}, kLegs{0.8, 2.1};
constexpr double kOpposite = 100 * kPi / 180;  // between the ways from the hips to the head and to the feet, at least

std::optional<Index> firstOf(const SkeletonMap& map, MapSide side, std::string_view part) {
  const std::vector<Index>* joints = jointsOfPart(map, side, part);
  return joints ? std::optional(joints->front()) : std::nullopt;
}

// The axis of space that the direction is nearest to.
Vec3 nearestAxis(const Vec3& direction) {
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0 ? -Vec3::Unit(largest) : Vec3(Vec3::Unit(largest));
}

Vec3 snapped(const Vec3& direction) {
  const Vec3 axis = nearestAxis(direction);
  return axis.dot(direction.normalized()) > std::cos(kNearAxis) ? axis : Vec3(direction.normalized());
}

// Which ways lead from the hips to the head and to the feet, as far as they are there.
struct Stance {
  Vec3 head = Vec3::Zero(), feet = Vec3::Zero();
};
Stance stanceOf(const Skeleton& skeleton, const Pose& pose, const SkeletonMap& map, MapSide side) {
  const std::vector<Affine> globals = poseGlobals(skeleton, pose);
  const std::optional<Index> hips = firstOf(map, side, "hips"), head = firstOf(map, side, "head");
  Stance stance;
  if (!hips || !head) return stance;
  const Vec3 from = globals[*hips].translation();
  stance.head = globals[*head].translation() - from;
  for (const char* part : {"leftFoot", "rightFoot"}) {
    if (const std::optional<Index> foot = firstOf(map, side, part)) stance.feet += globals[*foot].translation() - from;
  }
  return stance;
}

double angleOf(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Of people, from left and right limbs, and from the hips to the head.
std::optional<Quat> bodyFrame(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& positions) {
  const auto at = [&](std::string_view part) -> std::optional<Vec3> {
    const std::optional<Index> joint = firstOf(map, side, part);
    return joint ? std::optional(positions[*joint]) : std::nullopt;
  };
  Vec3 left = Vec3::Zero(), up = Vec3::Zero();
  for (const auto& [one, other] :
       {std::pair{"leftUpperLeg", "rightUpperLeg"}, std::pair{"leftUpperArm", "rightUpperArm"}}) {
    if (at(one) && at(other)) left += *at(one) - *at(other);
  }
  const std::optional<Vec3> hips = at("hips");
  for (const char* part : {"trunk", "neck", "head"}) {
    if (hips && at(part)) up += *at(part) - *hips;
  }
  for (const char* part : {"leftFoot", "rightFoot"}) {
    if (hips && at(part)) up += *hips - *at(part);
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

// Of what stands upright on four legs; other animals face +Z.
Quat quadrupedFrame(const Skeleton& skeleton, const std::vector<Vec3>& positions) {
  const std::optional<Quadruped> animal = readQuadruped(skeleton, positions);
  const Vec3 forward = animal ? snapped(animal->forward) : Vec3(Vec3::UnitZ());
  Mat3 axes;
  axes << Vec3::UnitY().cross(forward), Vec3::UnitY(), forward;
  return Quat(axes).conjugate();
}

// Limb bones, where they point in the neutral pose, and where they end.
struct LimbBone {
  std::string_view part, end;
  Vec3 direction;
};
std::array<LimbBone, 8> limbBones() {
  const Vec3 left = Vec3::UnitX(), right = -Vec3::UnitX(), down = -Vec3::UnitY();
  return {{{"leftUpperArm", "leftLowerArm", left},
           {"leftLowerArm", "leftHand", left},
           {"rightUpperArm", "rightLowerArm", right},
           {"rightLowerArm", "rightHand", right},
           {"leftUpperLeg", "leftLowerLeg", down},
           {"leftLowerLeg", "leftFoot", down},
           {"rightUpperLeg", "rightLowerLeg", down},
           {"rightLowerLeg", "rightFoot", down}}};
}

// Loose joints, with what hangs on them, are where their carriers have them.
void carry(const Skeleton& skeleton, std::span<const LooseJoint> loose, const std::vector<Vec3>& rest,
           const std::vector<Quat>& turns, std::vector<Vec3>& positions) {
  for (const auto& [joint, carrier, matched] : loose) {
    const Vec3 way = positions[carrier] + turns[carrier] * (rest[joint] - rest[carrier]) - positions[joint];
    for (Index j = joint; j < skeleton.jointCount(); ++j) {
      if (isAncestorOrSelf(skeleton, joint, j)) positions[j] += way;
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
    const std::optional<Index> joint = firstOf(map, side, bone.part), end = firstOf(map, side, bone.end);
    if (joint && end && (rest[*end] - rest[*joint]).norm() > 1e-9) {
      aims[*joint] = Aim{rest[*end] - rest[*joint], bone.direction};
    }
  }
}

// The way through the first joints of parts; nothing where one is missing.
double wayThrough(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& rest,
                  const std::array<std::string_view, 3>& parts) {
  double length = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::optional<Index> from = firstOf(map, side, parts[i - 1]), to = firstOf(map, side, parts[i]);
    if (!from || !to) return 0;
    length += (rest[*to] - rest[*from]).norm();
  }
  return length;
}

// The trunk's joints from the hips to the neck (or head); empty where it does not reach there.
std::vector<Index> trunkOf(const SkeletonMap& map, MapSide side) {
  const std::optional<Index> hips = firstOf(map, side, "hips"), neck = firstOf(map, side, "neck"),
                             head = firstOf(map, side, "head");
  if (!hips || (!neck && !head)) return {};
  std::vector<Index> joints = {*hips};
  if (const std::vector<Index>* trunk = jointsOfPart(map, side, "trunk")) {
    joints.insert(joints.end(), trunk->begin(), trunk->end());
  }
  joints.push_back(neck ? *neck : *head);
  return joints;
}

// One who stoops at rest (a statue, say) stands up: the hips turn the whole trunk, its middle what is still bent, the
// neck a head that is bowed. Trunks and necks that lean less, and all of those whose limbs are no person's (a
// dinosaur's), stand as they were built.
void aimBentTrunk(const SkeletonMap& map, MapSide side, const std::vector<Vec3>& rest, Aims& aims) {
  const std::vector<Index> trunk = trunkOf(map, side);
  double length = 0;
  for (std::size_t i = 1; i < trunk.size(); ++i) length += (rest[trunk[i]] - rest[trunk[i - 1]]).norm();
  for (const std::string limb : {"left", "right"}) {
    const double arm = wayThrough(map, side, rest, {limb + "UpperArm", limb + "LowerArm", limb + "Hand"}),
                 leg = wayThrough(map, side, rest, {limb + "UpperLeg", limb + "LowerLeg", limb + "Foot"});
    if (!(kArms.has(arm / length) && kLegs.has(leg / length))) return;
  }
  const Vec3 up = Vec3::UnitY();
  const std::optional<Index> neck = firstOf(map, side, "neck"), head = firstOf(map, side, "head");
  if (neck && head) aims[*neck] = Aim{rest[*head] - rest[*neck], up, kBows};
  const Index hips = trunk.front(), middle = trunk[trunk.size() / 2], top = trunk.back();
  if (angleOf(rest[top] - rest[hips], up) < kStoops) return;
  aims[hips] = Aim{rest[top] - rest[hips], up};
  if (middle != hips && middle != top) aims[middle] = Aim{rest[top] - rest[middle], up, kStoops};
}

}  // namespace

const std::vector<Index>* jointsOfPart(const SkeletonMap& map, MapSide side, std::string_view part) {
  const JointMatch* match = map.find(part);
  if (!match) return nullptr;
  return side == MapSide::kSource ? &match->source : &match->target;
}

std::vector<Index> matchedJoints(const SkeletonMap& map, MapSide side) {
  std::vector<Index> joints;
  for (const JointMatch& match : map.matches) {
    const std::vector<Index>& part = side == MapSide::kSource ? match.source : match.target;
    joints.insert(joints.end(), part.begin(), part.end());
  }
  return joints;
}

bool standsUpright(const Skeleton& skeleton, const Pose& pose, const SkeletonMap& map, MapSide side) {
  const Stance stance = stanceOf(skeleton, pose, map, side);
  return stance.head.isZero() || stance.feet.isZero() || angleOf(stance.head, stance.feet) > kOpposite;
}

Pose uprightPose(const Skeleton& skeleton, std::span<const Pose> motion, const SkeletonMap& map, MapSide side) {
  const Pose rest = restPose(skeleton);
  if (standsUpright(skeleton, rest, map, side)) return rest;
  const Pose* best = &rest;
  double least = kPi;
  for (const Pose& pose : motion) {
    const Stance stance = stanceOf(skeleton, pose, map, side);
    const double off = angleOf(stance.head, Vec3::UnitY()) + angleOf(stance.feet, -Vec3::UnitY());
    if (!(off < least)) continue;
    least = off;
    best = &pose;
  }
  return *best;
}

NeutralPose neutralPose(const Skeleton& skeleton, const Pose& resting, const SkeletonMap& map, MapSide side) {
  NeutralPose pose;
  std::vector<Vec3> rest;
  std::vector<Quat> restRotations;
  for (const Affine& global : poseGlobals(skeleton, resting)) rest.push_back(global.translation());
  const std::optional<Quat> person = bodyFrame(map, side, rest);
  pose.toBody = person ? *person : quadrupedFrame(skeleton, rest);
  std::vector<Quat> turns(skeleton.jointCount(), Quat::Identity());
  Aims aims(skeleton.jointCount());
  std::vector<bool> isFoot(skeleton.jointCount()), stands(skeleton.jointCount());
  for (Vec3& position : rest) position = pose.toBody * position;
  aimLimbs(map, side, rest, aims);
  aimBentTrunk(map, side, rest, aims);
  const std::vector<LooseJoint> loose =
      map.find("hips") ? looseJoints(skeleton, map, side, rest) : std::vector<LooseJoint>();
  for (const std::string leg : {"left", "right"}) {
    const std::optional<Index> foot = firstOf(map, side, leg + "Foot");
    if (!foot) continue;
    isFoot[*foot] = true;
    const std::optional<Index> hip = firstOf(map, side, leg + "UpperLeg"), knee = firstOf(map, side, leg + "LowerLeg"),
                               toes = toesOf(skeleton, map, side, leg, rest);
    if (!hip || !knee || !toes) continue;
    const bool hock = (rest[*toes] - rest[*foot]).norm() > kHock * (rest[*foot] - rest[*knee]).norm();
    stands[*foot] = hock && angleOf(rest[*toes] - rest[*hip], -Vec3::UnitY()) < kFootGoesAlong;
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
    const bool free = stands[j] || angleBetween(Quat::Identity(), above) < kFootGoesAlong;
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
  const std::optional<Index> left = firstOf(map, side, "leftUpperLeg"), right = firstOf(map, side, "rightUpperLeg");
  if (left && right) return 0.5 * (positions[*left] + positions[*right]);
  if (const std::optional<Index> hips = firstOf(map, side, "hips")) return positions[*hips];
  const JointMatch& first = map.matches.front();
  return positions[side == MapSide::kSource ? first.source.front() : first.target.front()];
}

std::optional<Index> toesOf(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, std::string_view leg,
                            std::span<const Vec3> rest) {
  const std::string name(leg);
  const std::optional<Index> toes = firstOf(map, side, name + "Toes"), foot = firstOf(map, side, name + "Foot");
  if (toes || !foot) return toes;
  std::optional<Index> tip;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Vec3 way = rest[j] - rest[*foot];
    if (skeleton.joints[j].parent != foot || way.z() <= 0 || way.y() >= 0) continue;
    if (!tip || rest[j].z() > rest[*tip].z()) tip = j;
  }
  return tip;
}

bool isBent(std::span<const Index> joints, Index end, std::span<const Vec3> positions) {
  double way = (positions[end] - positions[joints.back()]).norm();
  for (std::size_t i = 1; i < joints.size(); ++i) way += (positions[joints[i]] - positions[joints[i - 1]]).norm();
  return way > kBent * (positions[end] - positions[joints.front()]).norm();
}

std::vector<Index> soleJoints(const SkeletonMap& map, MapSide side) {
  std::vector<Index> joints;
  for (const char* part : {"leftFoot", "rightFoot", "leftToes", "rightToes"}) {
    if (const std::optional<Index> foot = firstOf(map, side, part)) joints.push_back(*foot);
  }
  return joints;
}

}  // namespace limber
