// A person who walks, waves and bends, and the same person with another skeleton: made in code for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "limber/ik/ik_skeletons.h"
#include "limber/ik/rotation.h"
#include "limber/retarget/retarget_clip.h"
#include "limber/skeleton/humanoid_names.h"

namespace limber::testing {

inline Quat turn(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * kPi / 180, axis.normalized()));
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
    const int stands = leftLift > 0 ? 1 : 0;
    const Index foot = stands == 0 ? leftFoot : rightFoot;
    std::vector<Affine> globals = poseGlobals(person, pose);
    if (standing != stands) {
      if (standing < 0) {
        planted = globals[foot].translation();
      } else {
        // Where the new standing foot is, with the body still carried by the old one.
        const Index old = standing == 0 ? leftFoot : rightFoot;
        planted += globals[foot].translation() - globals[old].translation();
      }
      planted.y() = restGlobals(person)[foot].translation().y();
      standing = stands;
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

inline Skeleton inRestPose(Skeleton skeleton, const std::map<std::string, Quat>& turns) {
  for (const auto& [name, rotation] : turns) {
    Quat& rest = skeleton.joints[skeleton.find(name).value()].rest.rotation;
    rest = rotation * rest;
  }
  return skeleton;
}

inline Skeleton scaled(Skeleton skeleton, double factor) {
  for (Joint& joint : skeleton.joints) joint.rest.translation *= factor;
  return skeleton;
}

// A joint more on the way from the parent of `child` to it.
inline Skeleton withJointBefore(const Skeleton& skeleton, const std::string& child, const std::string& name) {
  Skeleton longer;
  const Index at = skeleton.find(child).value();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Joint joint = skeleton.joints[j];
    if (j == at) {
      Joint link = joint;
      link.name = name;
      link.rest.translation *= 0.4;
      link.rest.rotation = Quat::Identity();
      longer.joints.push_back(link);
      joint.parent = at;
      joint.rest.translation *= 0.6;
    } else if (joint.parent && *joint.parent >= at) {
      joint.parent = *joint.parent + 1;
    }
    longer.joints.push_back(joint);
  }
  return longer;
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

// The same on a root on the ground, on which these joints hang, too.
inline Skeleton onTheGround(const Skeleton& skeleton, const std::vector<std::string>& loose) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  Skeleton longer;
  longer.joints.push_back({"ground", std::nullopt, {}});
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Joint joint = skeleton.joints[j];
    joint.parent = joint.parent ? *joint.parent + 1 : 0;
    if (std::find(loose.begin(), loose.end(), joint.name) != loose.end()) {
      joint.parent = 0;
      joint.rest = decompose(globals[j]);
    }
    longer.joints.push_back(joint);
  }
  return longer;
}

// Ankles are the last joints of its legs.
inline Skeleton withoutToes(const Skeleton& skeleton) {
  Skeleton shorter;
  std::vector<Index> kept(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Joint joint = skeleton.joints[j];
    if (joint.name == "leftToes" || joint.name == "rightToes") continue;
    kept[j] = shorter.jointCount();
    if (joint.parent) joint.parent = kept[*joint.parent];
    shorter.joints.push_back(joint);
  }
  return shorter;
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

// At the end; the parent is one that is there, or "".
inline void addJoint(Skeleton& skeleton, const std::string& name, const std::string& parent, const Vec3& offset) {
  Joint& joint = skeleton.joints.emplace_back();
  joint.name = name;
  joint.parent = skeleton.find(parent);
  joint.rest.translation = offset;
}

// A body with a neck, a tail that hangs down, and four legs of two bones and a paw; the thigh's share of the leg's
// metre.
inline Skeleton quadruped(double thigh) {
  Skeleton skeleton;
  const auto add = [&](const std::string& name, const std::string& parent, const Vec3& offset) {
    addJoint(skeleton, name, parent, offset);
  };
  add("b0", "", Vec3(0, 1, 0));
  add("b1", "b0", Vec3(0, 0, 0.8));
  add("n0", "b1", Vec3(0, 0.3, 0.3));
  add("n1", "n0", Vec3(0, 0.1, 0.3));
  add("tail1", "b0", Vec3(0, 0, -0.1));
  add("tail2", "tail1", Vec3(0, -0.1, -0.6));
  add("tail3", "tail2", Vec3(0, -0.75, -0.2));
  for (const std::string at : {"b0", "b1"}) {
    for (const double side : {1.0, -1.0}) {
      const std::string leg = at + (side > 0 ? "Left" : "Right");
      add(leg + "One", at, Vec3(0.2 * side, -0.05, 0));
      add(leg + "Two", leg + "One", Vec3(0, -0.9 * thigh, 0.02));
      add(leg + "Three", leg + "Two", Vec3(0, -0.9 * (1 - thigh), -0.02));
      add(leg + "Four", leg + "Three", Vec3(0, -0.04, 0.1));
    }
  }
  return skeleton;
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

// One with all four legs, the trunk and the tail on a joint over the middle of the body.
inline Skeleton quadrupedOnOneJoint() {
  const Skeleton animal = quadruped(0.5);
  const Vec3 middle(0, 1.3, 0.4);
  const std::vector<Affine> globals = restGlobals(animal);
  Skeleton other;
  addJoint(other, "body", "", middle);
  for (Index j = 0; j < animal.jointCount(); ++j) {
    const Joint& joint = animal.joints[j];
    const bool moves = !joint.parent || joint.name.ends_with("One") || joint.name == "tail1";
    addJoint(other, joint.name, moves ? "body" : animal.joints[*joint.parent].name,
             moves ? Vec3(globals[j].translation() - middle) : joint.rest.translation);
  }
  return other;
}

// Metres that the feet's joints move along the ground once the source's have stood still for a tenth of a second: these
// feet stop all at once, and what is at speed when it is planted needs a moment.
inline double slidWay(const Skeleton& person, const PoseSequence& motion, const Skeleton& other,
                      const PoseSequence& result) {
  double way = 0;
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
      way += std::hypot(moved.x(), moved.z());
    }
  }
  return way;
}

// The largest angle, in degrees, between the directions in which the parts of both point, over all frames.
inline double worstDirection(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& target) {
  double worst = 0;
  BodyFrame a, b;
  for (std::size_t f = 0; f < source.poses.size(); ++f) {
    setup.sourceKinematics.globals(source.poses[f], a);
    setup.targetKinematics.globals(target.poses[f], b);
    for (const JointMatch& match : setup.map.matches) {
      const auto above = humanoidParent(match.part);
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
