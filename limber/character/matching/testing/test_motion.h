// A person who walks, waves and bends, and the same person with another skeleton: made in code for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/character/matching/retarget_setup.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber::testing {

// Without the joints whose names have one of these words; what is attached to them stays where it is. Of identities as rest rotations.
inline Skeleton without(const Skeleton& person, const std::vector<std::string>& words) {
  Skeleton less;
  std::vector<std::optional<Index>> kept(person.joints.size());  // or the nearest above that is
  const std::vector<Affine> globals = restGlobals(person);
  for (Index j = 0; j < person.jointCount(); ++j) {
    Joint joint = person.joints[j];
    if (joint.parent) kept[j] = kept[*joint.parent];
    const auto isNamed = [&](const std::string& word) { return joint.name.find(word) != std::string::npos; };
    if (std::any_of(words.begin(), words.end(), isNamed)) continue;
    joint.parent = kept[j];
    const Vec3 above =
        joint.parent ? globals[person.find(less.joints[*joint.parent].name).value()].translation() : Vec3(Vec3::Zero());
    joint.rest.translation = globals[j].translation() - above;
    kept[j] = less.jointCount();
    less.joints.push_back(joint);
  }
  return less;
}

// The practice humanoid (T-pose, all rotations identities) walks forward, its standing foot exactly still on the
// ground, while every joint of trunk, arms and hands turns.
inline PoseSequence walk(const Skeleton& person, std::size_t frames = 120, double framesPerSecond = 60) {
  PoseSequence sequence;
  sequence.frameSeconds = 1 / framesPerSecond;
  const auto joint = [&](const char* name) { return person.find(name).value(); };
  const Index hips = joint("hips"), leftFoot = joint("leftFoot"), rightFoot = joint("rightFoot");
  Vec3 planted = Vec3::Zero();
  int standing = -1;
  for (std::size_t f = 0; f < frames; ++f) {
    Pose pose = restPose(person);
    const double phase = 2 * kPi * static_cast<double>(f) / framesPerSecond;
    const double swing = 22 * std::sin(phase);
    const auto legs = [&](const std::string& side, double angle, double knee) {
      pose.locals[joint((side + "UpperLeg").c_str())].rotation = turn(-Vec3::UnitX(), angle + knee / 2);
      pose.locals[joint((side + "LowerLeg").c_str())].rotation = turn(Vec3::UnitX(), knee);
      pose.locals[joint((side + "Foot").c_str())].rotation = turn(-Vec3::UnitX(), knee / 2 - angle);
    };
    const double leftLift = std::max(0.0, std::cos(phase)), rightLift = std::max(0.0, -std::cos(phase));
    legs("left", swing, 10 + 45 * leftLift);
    legs("right", -swing, 10 + 45 * rightLift);
    for (const char* part : {"spine", "chest", "neck", "leftUpperArm", "rightLowerArm", "leftHand", "head"}) {
      const double slow = phase * 0.7 + static_cast<double>(part[0]);
      pose.locals[joint(part)].rotation = fromRotationVector(0.3 * Vec3(std::sin(slow), std::cos(1.3 * slow), 0.4));
    }
    pose.locals[joint("rightUpperArm")].rotation = turn(Vec3::UnitZ(), 40 + 20 * std::sin(phase));
    // The foot that is not lifted stays where it is.
    const int stance = leftLift > 0 ? 1 : 0;
    const Index foot = stance == 0 ? leftFoot : rightFoot;
    std::vector<Affine> globals = poseGlobals(person, pose);
    if (standing != stance) {
      if (standing < 0) {
        planted = globals[foot].translation();
      } else {
        // Where the new standing foot is, with the body still carried by the old one.
        const Index old = standing == 0 ? leftFoot : rightFoot;
        planted += globals[foot].translation() - globals[old].translation();
      }
      planted.y() = restGlobals(person)[foot].translation().y();
      standing = stance;
    }
    pose.locals[hips].translation += planted - globals[foot].translation();
    sequence.poses.push_back(std::move(pose));
  }
  return sequence;
}

// The same skeleton with other local axes: every joint's own frame turned, differently for each.
inline Skeleton withOtherAxes(Skeleton skeleton) {
  std::vector<Quat> turns;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const double n = 1.0 + j;
    turns.push_back(fromRotationVector(2 * Vec3(std::sin(n), std::sin(2.7 * n), std::sin(5.1 * n))));
    Transform& rest = skeleton.joints[j].rest;
    const Quat above = skeleton.joints[j].parent ? turns[*skeleton.joints[j].parent] : Quat::Identity();
    rest.translation = above.conjugate() * rest.translation;
    rest.rotation = above.conjugate() * rest.rotation * turns[j];
  }
  return skeleton;
}

// A motion together with the skeleton that it moves.
struct MovedSkeleton {
  Skeleton skeleton;
  PoseSequence motion;
};

// The same motion of a skeleton without rotations at rest, written as programs do that zero their joints' axes: at rest
// all bones lie along +X, if `mirrored` those of joints called right... along -X; the hips' axes are turned by `hips`.
inline MovedSkeleton withZeroedAxes(const Skeleton& person, const PoseSequence& motion, bool mirrored,
                                    const Quat& hips) {
  std::vector<Vec3> tips(person.jointCount(), Vec3::UnitX());
  for (Index j = person.jointCount(); j-- > 1;)
    tips[person.joints[j].parent.value()] = person.joints[j].rest.translation;
  MovedSkeleton flat{person, motion};
  std::vector<Quat> axes;
  for (Index j = 0; j < person.jointCount(); ++j) {
    const Joint& joint = person.joints[j];
    const double sign = mirrored && joint.name.starts_with("right") ? -1 : 1;
    axes.push_back(joint.parent ? shortestRotation(sign * Vec3::UnitX(), tips[j]) : hips);
    const Quat above = joint.parent ? axes[*joint.parent] : Quat::Identity();
    Transform& rest = flat.skeleton.joints[j].rest;
    rest.translation = above.conjugate() * rest.translation;
    for (Pose& pose : flat.motion.poses) {
      Transform& local = pose.locals[j];
      local.translation = above.conjugate() * local.translation;
      local.rotation = (above.conjugate() * local.rotation * axes[j]).normalized();
    }
  }
  return flat;
}

// The motion turned about the origin.
inline PoseSequence turnedMotion(PoseSequence motion, const Quat& turn) {
  for (Pose& pose : motion.poses) {
    pose.locals[0].translation = turn * pose.locals[0].translation;
    pose.locals[0].rotation = turn * pose.locals[0].rotation;
  }
  return motion;
}

inline Skeleton scaled(Skeleton skeleton, double factor) {
  for (Joint& joint : skeleton.joints) joint.rest.translation *= factor;
  return skeleton;
}

// A person with a hock in each shin, a hand's breadth behind the line from knee to foot, as an upright dinosaur's.
inline Skeleton withHocks(Skeleton person) {
  for (const std::string side : {"left", "right"}) {
    person = withJointBefore(person, side + "Foot", side + "Hock");
    const Vec3 back(0, 0, -0.1);
    person.joints[person.find(side + "Hock").value()].rest.translation += back;
    person.joints[person.find(side + "Foot").value()].rest.translation -= back;
  }
  return person;
}

// Ankles are the last joints of its legs.
inline Skeleton withoutToes(const Skeleton& person) {
  return without(person, {"Toes"});
}

// As if the joints' names said nothing.
inline SkeletonMap matchByForm(const Skeleton& source, const Skeleton& target) {
  return matchSkeletons(nameless(source, "p"), nameless(target));
}

// Unreal's names for VRM's.
inline Skeleton renamed(Skeleton skeleton) {
  const std::map<std::string, std::string> names = {{"hips", "pelvis"},
                                                    {"spine", "spine_01"},
                                                    {"chest", "spine_02"},
                                                    {"upperChest", "spine_03"},
                                                    {"neck", "neck_01"},
                                                    {"leftUpperArm", "upperarm_l"},
                                                    {"leftLowerArm", "lowerarm_l"},
                                                    {"leftHand", "hand_l"},
                                                    {"leftUpperLeg", "thigh_l"},
                                                    {"leftLowerLeg", "calf_l"},
                                                    {"leftFoot", "foot_l"},
                                                    {"leftToes", "ball_l"},
                                                    {"rightUpperArm", "upperarm_r"},
                                                    {"rightLowerArm", "lowerarm_r"},
                                                    {"rightUpperLeg", "thigh_r"},
                                                    {"rightLowerLeg", "calf_r"}};
  for (Joint& joint : skeleton.joints) {
    if (const auto found = names.find(joint.name); found != names.end()) joint.name = found->second;
  }
  return skeleton;
}

// Longer shins, shorter thighs and a wider pelvis than the source's: joint angles alone make the feet slide.
inline Skeleton oddlyBuilt() {
  Skeleton person = practiceHumanoid();
  for (Joint& joint : person.joints) {
    if (joint.name == "leftFoot" || joint.name == "rightFoot") joint.rest.translation *= 1.4;
    if (joint.name == "leftLowerLeg" || joint.name == "rightLowerLeg") joint.rest.translation *= 0.8;
    if (joint.name == "leftUpperLeg" || joint.name == "rightUpperLeg") joint.rest.translation.x() *= 1.5;
  }
  const double lower = restGlobals(practiceHumanoid())[person.find("leftFoot").value()].translation().y() -
                       restGlobals(person)[person.find("leftFoot").value()].translation().y();
  person.joints[0].rest.translation.y() += lower;
  return person;
}

// Legs of an animal that bend at the knee to the front and less at the hock to the back.
inline Skeleton quadrupedWithHocks() {
  Skeleton animal;
  for (Joint joint : quadruped(0.5).joints) {
    if (joint.parent) joint.parent = animal.find(quadruped(0.5).joints[*joint.parent].name);
    if (joint.name.ends_with("Two")) joint.rest.translation.z() = 0.06;
    if (joint.name.ends_with("Three")) {
      Joint& hock = animal.joints.emplace_back(joint);
      hock.name = joint.name.substr(0, joint.name.find("Three")) + "Hock";
      hock.rest.translation = Vec3(0, -0.25, -0.11);
      joint.parent = animal.find(hock.name);
      joint.rest.translation = Vec3(0, -0.2, 0.05);
    }
    animal.joints.push_back(joint);
  }
  return animal;
}

// A quadruped with hips at b0, and a trunk, a neck and a tail of so many joints, called spine1 to spineN along both
// trunk and neck.
inline Skeleton chainedAnimal(int trunk, int neck, int tail) {
  const Skeleton simple = quadruped(0.5);
  Skeleton made;
  const auto chain = [&](const std::string& stem, int first, int count, std::string parent, const Vec3& displacement) {
    for (int i = first; i < first + count; ++i) {
      addJoint(made, stem + std::to_string(i), parent, displacement / count);
      parent = stem + std::to_string(i);
    }
    return parent;
  };
  made.joints.push_back(simple.joints[0]);
  const std::string chest = chain("spine", 1, trunk, "b0", Vec3(0, 0, 0.8));
  const std::string throat = chain("spine", trunk + 1, neck, chest, Vec3(0, 0.3, 0.3));
  addJoint(made, "Head", throat, Vec3(0, 0.1, 0.1));
  chain("tail", 1, tail, "b0", Vec3(0, -0.2, -0.7));
  for (const Joint& joint : simple.joints) {
    if (!joint.name.ends_with("One") && !joint.name.ends_with("Two") && !joint.name.ends_with("Three")) continue;
    const std::string parent = simple.joints[joint.parent.value()].name;
    addJoint(made, joint.name, parent == "b1" ? chest : parent, joint.rest.translation);
  }
  return made;
}

// What a flying animal's joints are called, and how many make up its parts.
struct FlyerBuild {
  const char *wing, *leg, *spine, *head, *tail;
  int spineJoints, wingJoints, tailJoints;
};
inline constexpr FlyerBuild kGull = {"wing", "leg", "spine", "head", "tail", 4, 5, 3},
                            kBat = {"Fluegel_Wing", "Hind_leg", "Rumpf", "The Head", "Schwanz", 2, 3, 4},
                            kNamelessBird = {"a", "b", "c", "d", "e", 4, 4, 3};

// Hips on a root, a trunk forward, wings to the sides at its end, legs down, a tail behind.
inline Skeleton flyer(const FlyerBuild& build, double degrees = 0) {
  Skeleton made;
  addJoint(made, "origin", "", Vec3::Zero());
  made.joints[0].rest.rotation = turn(Vec3::UnitY(), degrees);
  addJoint(made, "carrier", "origin", Vec3(0, 0.5, 0));
  const auto chain = [&](const std::string& stem, int count, std::string parent, const Vec3& first,
                         const Vec3& displacement) {
    for (int i = 1; i <= count; ++i) {
      addJoint(made, stem + std::to_string(i), parent, i == 1 ? first : Vec3(displacement / (count - 1)));
      parent = stem + std::to_string(i);
    }
    return parent;
  };
  const std::string chest = chain(build.spine, build.spineJoints, "carrier", Vec3(0, 0, 0.1), Vec3(0, 0.1, 0.5));
  addJoint(made, build.head, chest, Vec3(0, 0.1, 0.2));
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "L" : "R";
    chain(build.wing + name, build.wingJoints, chest, Vec3(0.1 * side, 0, 0), Vec3(1.5 * side, 0, -0.2));
    chain(build.leg + name, 3, "carrier", Vec3(0.1 * side, 0, 0), Vec3(0, -0.45, 0.05));
  }
  chain(build.tail, build.tailJoints, "carrier", Vec3(0, 0, -0.1), Vec3(0, 0, -0.5));
  return made;
}

// Names of the source's joints in the match that moves that joint of the target.
inline std::vector<std::string> followedBy(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                                           const std::string& joint) {
  std::vector<std::string> names;
  for (const JointMatch& match : map.matches) {
    if (std::find(match.target.begin(), match.target.end(), target.find(joint)) == match.target.end()) continue;
    for (const Index each : match.source) names.push_back(source.joints[each].name);
  }
  return names;
}

// The match of a part of that name, none where it is not matched.
inline const JointMatch* matchOf(const SkeletonMap& map, const std::string& part) {
  return map.find(bodyPartNamed(part).value());
}

// Metres that the feet's joints move along the ground once the source's have stood still for a tenth of a second: these
// feet stop all at once, and what is at speed when it is planted needs a moment.
inline double slideDistance(const Skeleton& person, const PoseSequence& motion, const Skeleton& other,
                            const PoseSequence& result) {
  double pathLength = 0;
  for (const char* foot : {"leftFoot", "rightFoot"}) {
    const Index from = person.find(foot).value(), to = other.find(foot).value();
    int still = 0;
    for (std::size_t f = 1; f < motion.poses.size(); ++f) {
      const auto step = [&](const Skeleton& skeleton, const PoseSequence& frames, Index joint) -> Vec3 {
        return poseGlobals(skeleton, frames.poses[f])[joint].translation() -
               poseGlobals(skeleton, frames.poses[f - 1])[joint].translation();
      };
      still = step(person, motion, from).norm() < 1e-4 ? still + 1 : 0;
      if (still <= 6) continue;
      const Vec3 moved = step(other, result, to);
      pathLength += std::hypot(moved.x(), moved.z());
    }
  }
  return pathLength;
}

// The bone that a person's head, eye, limb or finger goes on from.
inline std::optional<BodyPart> partAbove(const BodyPart& part) {
  if (part.kind == PartKind::kHead) return body_part::kNeck;
  if (part.kind == PartKind::kEye || part.kind == PartKind::kJaw) return body_part::kHead;
  if (part.kind == PartKind::kFinger && part.piece == 0) return body_part::arm(part.side, Segment::kEnd);
  BodyPart above = part;
  if (part.kind == PartKind::kFinger) {
    --above.piece;
    return above;
  }
  const bool begins = part.segment == Segment::kWhole || part.segment == Segment::kBase;
  if ((part.kind != PartKind::kArm && part.kind != PartKind::kLeg) || begins) return std::nullopt;
  if (part.kind == PartKind::kLeg && part.segment == Segment::kUpper) return body_part::kPelvis;
  const int before = static_cast<int>(part.segment) - (part.segment == Segment::kEnd ? 2 : 1);  // people have no hocks
  above.segment = static_cast<Segment>(before);
  return above;
}

// The largest angle, in degrees, between the directions in which the parts of both point, over all frames.
inline double worstDirection(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& target) {
  double worst = 0;
  BodyFrame a, b;
  for (std::size_t f = 0; f < source.poses.size(); ++f) {
    setup.sourceKinematics.globals(source.poses[f], a);
    setup.targetKinematics.globals(target.poses[f], b);
    for (const JointMatch& match : setup.map.matches) {
      const auto above = partAbove(match.part);
      const JointMatch* parent = above ? setup.map.find(*above) : nullptr;
      if (!parent) continue;
      const Vec3 from = a.positions[match.source.front()] - a.positions[parent->source.front()];
      const Vec3 to = b.positions[match.target.front()] - b.positions[parent->target.front()];
      worst = std::max(worst, std::atan2(from.cross(to).norm(), from.dot(to)) * 180 / kPi);
    }
  }
  return worst;
}

}  // namespace limber::testing
