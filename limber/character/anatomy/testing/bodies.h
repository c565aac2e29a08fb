// People under the names of several programs, and animals, made in code for tests: each joint with what it is.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limber/character/anatomy/body_part.h"
#include "limber/core/text/numbers.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber::testing {

// At the end; the parent is one that is there, or "".
inline void addJoint(Skeleton& skeleton, const std::string& name, const std::string& parent, const Vec3& offset) {
  Joint joint;
  joint.name = name;
  joint.parent = skeleton.find(parent);
  joint.rest.translation = offset;
  skeleton.joints.push_back(std::move(joint));
}

// The same, called by nothing that means a part of a body.
inline Skeleton nameless(Skeleton skeleton, const std::string& stem = "q") {
  for (Index j = 0; j < skeleton.jointCount(); ++j) skeleton.joints[j].name = stem + std::to_string(j);
  return skeleton;
}

inline Quat turn(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * kPi / 180, axis.normalized()));
}

inline Skeleton inRestPose(Skeleton skeleton, const std::map<std::string, Quat>& turns) {
  for (const auto& [name, rotation] : turns) {
    Quat& rest = skeleton.joints[skeleton.find(name).value()].rest.rotation;
    rest = rotation * rest;
  }
  return skeleton;
}

// Another joint on the path from the parent of `child` to it.
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

// The whole of it, about the origin.
inline Skeleton turnedAsAWhole(Skeleton skeleton, const Quat& turn) {
  for (Joint& joint : skeleton.joints) {
    if (joint.parent) continue;
    joint.rest.translation = turn * joint.rest.translation;
    joint.rest.rotation = turn * joint.rest.rotation;
  }
  return skeleton;
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

// A body with a neck, a tail that hangs down, and four legs of two bones and a paw; `thigh`: fraction of the leg's
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

// Up +Y, front +Z, left +X; all rotations are identities.
struct MadeBody {
  Skeleton skeleton;
  std::vector<BodyPart> parts;  // #J what each joint is; Segment::kWhole: no landmark

  // At a world position.
  void add(const std::string& name, const std::string& parent, const Vec3& at, const BodyPart& part) {
    Vec3 offset = at;
    for (std::optional<Index> up = skeleton.find(parent); up; up = skeleton.joints[*up].parent) {
      offset -= skeleton.joints[*up].rest.translation;
    }
    addJoint(skeleton, name, parent, offset);
    parts.push_back(part);
  }
};

enum class NameHabit { kVrm, kMixamo, kCmu, kUnreal, kBiped };
inline constexpr NameHabit kNameHabits[] = {NameHabit::kVrm, NameHabit::kMixamo, NameHabit::kCmu, NameHabit::kUnreal,
                                            NameHabit::kBiped};

// A person in T-pose, 1.7 m tall, of 22 joints and, where the habit names them, three ends.
inline MadeBody personWith(NameHabit habit) {
  struct Row {
    std::array<const char*, 5> names;  // by habit; "" where it has no such joint; * is replaced by the side
    int parent;                        // a row
    Vec3 at;                           // the left one's
    PartKind kind;
    Segment segment;
  };
  using enum PartKind;
  using enum Segment;
  static const std::vector<Row> kRows = {
      {{"hips", "mixamorig:Hips", "Hips", "pelvis", "Bip01 Pelvis"}, -1, {0, 0.95, 0}, kTrunk, kBase},
      {{"spine", "mixamorig:Spine", "LowerBack", "spine_01", "Bip01 Spine"}, 0, {0, 1.05, 0}, kTrunk, kWhole},
      {{"chest", "mixamorig:Spine1", "Spine", "spine_02", "Bip01 Spine1"}, 1, {0, 1.17, 0}, kTrunk, kWhole},
      {{"upperChest", "mixamorig:Spine2", "Spine1", "spine_03", "Bip01 Spine2"}, 2, {0, 1.29, 0}, kTrunk, kWhole},
      {{"neck", "mixamorig:Neck", "Neck", "neck_01", "Bip01 Neck"}, 3, {0, 1.44, 0}, kNeck, kWhole},
      {{"head", "mixamorig:Head", "Head", "head", "Bip01 Head"}, 4, {0, 1.52, 0}, kHead, kWhole},
      {{"", "mixamorig:HeadTop_End", "", "", "Bip01 HeadNub"}, 5, {0, 1.7, 0}, kHead, kWhole},
      {{"*Shoulder", "mixamorig:*Shoulder", "*Shoulder", "clavicle_*", "Bip01 * Clavicle"},
       3,
       {0.03, 1.4, 0},
       kArm,
       kBase},
      {{"*UpperArm", "mixamorig:*Arm", "*Arm", "upperarm_*", "Bip01 * UpperArm"}, 7, {0.17, 1.4, 0}, kArm, kUpper},
      {{"*LowerArm", "mixamorig:*ForeArm", "*ForeArm", "lowerarm_*", "Bip01 * Forearm"},
       8,
       {0.44, 1.4, 0},
       kArm,
       kMiddle},
      {{"*Hand", "mixamorig:*Hand", "*Hand", "hand_*", "Bip01 * Hand"}, 9, {0.68, 1.4, 0}, kArm, kEnd},
      {{"*UpperLeg", "mixamorig:*UpLeg", "*UpLeg", "thigh_*", "Bip01 * Thigh"}, 0, {0.09, 0.9, 0}, kLeg, kUpper},
      {{"*LowerLeg", "mixamorig:*Leg", "*Leg", "calf_*", "Bip01 * Calf"}, 11, {0.09, 0.49, 0}, kLeg, kMiddle},
      {{"*Foot", "mixamorig:*Foot", "*Foot", "foot_*", "Bip01 * Foot"}, 12, {0.09, 0.09, 0}, kLeg, kEnd},
      {{"*Toes", "mixamorig:*ToeBase", "*ToeBase", "ball_*", "Bip01 * Toe0"}, 13, {0.095, 0.025, 0.12}, kLeg, kToes},
      {{"", "mixamorig:*Toe_End", "", "", "Bip01 * Toe0Nub"}, 14, {0.095, 0.02, 0.19}, kLeg, kWhole},
  };
  const auto column = static_cast<std::size_t>(habit);
  const auto nameFor = [&](const Row& row, Side side) {
    std::string name = row.names[column];
    const std::size_t star = name.find('*');
    if (star == std::string::npos) return name;
    std::string word(nameOf(side));
    if (habit == NameHabit::kUnreal) word = word.substr(0, 1);
    if (habit == NameHabit::kBiped) word = side == Side::kLeft ? "L" : "R";
    if (habit == NameHabit::kMixamo || habit == NameHabit::kCmu) word = side == Side::kLeft ? "Left" : "Right";
    return name.replace(star, 1, word);
  };
  MadeBody body;
  for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
    for (const Row& row : kRows) {
      const bool isLimb = row.kind == kArm || row.kind == kLeg;
      if (isLimb == (side == Side::kCenter) || *row.names[column] == '\0') continue;
      const Vec3 at((side == Side::kRight ? -1 : 1) * row.at.x(), row.at.y(), row.at.z());
      const std::string parent = row.parent < 0 ? "" : nameFor(kRows[static_cast<std::size_t>(row.parent)], side);
      body.add(nameFor(row, side), parent, at, {row.kind, side, 0, row.segment, 0});
    }
  }
  return body;
}

inline Skeleton vrmPerson() {
  return personWith(NameHabit::kVrm).skeleton;
}

// The same with numbers for names, whose file declares its bones.
inline Skeleton declaredPerson() {
  Skeleton person = vrmPerson();
  for (const HumanoidJoint& called : jointsCalledAsBones(person)) {
    person.joints[called.joint].declaredBone = called.bone;
    person.joints[called.joint].name = "n" + std::to_string(called.joint);
  }
  return person;
}

// Of joints that go on from each other, each at `step` from the one before.
inline std::string addChain(MadeBody& body, const std::string& stem, int count, std::string parent, Vec3 at,
                            const Vec3& step, const BodyPart& part) {
  for (int i = 1; i <= count; ++i, at += step) {
    const std::string name = stem + std::to_string(i);
    body.add(name, parent, at, part);
    parent = name;
  }
  return parent;
}

// A dog, digitigrade, with ears, a jaw and a tail.
inline MadeBody dog() {
  MadeBody body;
  const auto center = [](PartKind kind, Segment segment = Segment::kWhole) {
    return BodyPart{kind, Side::kCenter, 0, segment, 0};
  };
  body.add("Pelvis", "", {0, 0.6, -0.35}, center(PartKind::kTrunk, Segment::kBase));
  const std::string chest =
      addChain(body, "Spine", 3, "Pelvis", {0, 0.62, -0.2}, {0, 0, 0.17}, center(PartKind::kTrunk));
  const std::string throat =
      addChain(body, "Neck", 2, chest, {0, 0.68, 0.28}, {0, 0.08, 0.08}, center(PartKind::kNeck));
  body.add("Head", throat, {0, 0.85, 0.43}, center(PartKind::kHead));
  body.add("Jaw", "Head", {0, 0.82, 0.47}, center(PartKind::kJaw));
  addChain(body, "Tail", 4, "Pelvis", {0, 0.62, -0.43}, {0, -0.05, -0.1}, center(PartKind::kTail));
  for (const Side side : kSides) {
    const double x = side == Side::kLeft ? 1 : -1;
    const std::string name = side == Side::kLeft ? "L_" : "R_";
    const auto leg = [&](Segment segment, Index pair) { return body_part::leg(side, segment, pair); };
    body.add(name + "Scapula", chest, {0.05 * x, 0.65, 0.16}, leg(Segment::kBase, 0));
    body.add(name + "UpperArm", name + "Scapula", {0.09 * x, 0.48, 0.26}, leg(Segment::kUpper, 0));
    body.add(name + "Forearm", name + "UpperArm", {0.09 * x, 0.36, 0.15}, leg(Segment::kMiddle, 0));
    body.add(name + "Hand", name + "Forearm", {0.09 * x, 0.13, 0.18}, leg(Segment::kWhole, 0));
    body.add(name + "Fingers", name + "Hand", {0.09 * x, 0.04, 0.2}, leg(Segment::kWhole, 0));
    body.add(name + "Thigh", "Pelvis", {0.08 * x, 0.55, -0.36}, leg(Segment::kUpper, 1));
    body.add(name + "Calf", name + "Thigh", {0.09 * x, 0.36, -0.27}, leg(Segment::kMiddle, 1));
    body.add(name + "Foot", name + "Calf", {0.09 * x, 0.18, -0.43}, leg(Segment::kHock, 1));
    body.add(name + "Toe", name + "Foot", {0.09 * x, 0.04, -0.4}, leg(Segment::kEnd, 1));
    body.add(name + "Ear", "Head", {0.06 * x, 0.93, 0.4}, {PartKind::kEar, side, 0, Segment::kWhole, 0});
  }
  return body;
}

// A crow with spread wings.
inline MadeBody crow() {
  MadeBody body;
  const auto center = [](PartKind kind, Segment segment = Segment::kWhole) {
    return BodyPart{kind, Side::kCenter, 0, segment, 0};
  };
  body.add("Hips", "", {0, 0.2, -0.05}, center(PartKind::kTrunk, Segment::kBase));
  const std::string chest = addChain(body, "Spine", 2, "Hips", {0, 0.22, 0}, {0, 0.02, 0.06}, center(PartKind::kTrunk));
  const std::string throat =
      addChain(body, "Neck", 2, chest, {0, 0.27, 0.1}, {0, 0.025, 0.02}, center(PartKind::kNeck));
  body.add("Head", throat, {0, 0.33, 0.14}, center(PartKind::kHead));
  body.add("Beak", "Head", {0, 0.32, 0.19}, center(PartKind::kHead));
  addChain(body, "Tail", 2, "Hips", {0, 0.19, -0.11}, {0, -0.01, -0.06}, center(PartKind::kTail));
  for (const Side side : kSides) {
    const double x = side == Side::kLeft ? 1 : -1;
    const std::string name = side == Side::kLeft ? "Left" : "Right";
    addChain(body, name + "Wing", 4, chest, {0.04 * x, 0.25, 0.06}, {0.12 * x, 0.005, -0.01},
             {PartKind::kWing, side, 0, Segment::kWhole, 0});
    body.add(name + "Thigh", "Hips", {0.04 * x, 0.17, -0.03}, body_part::leg(side, Segment::kUpper));
    body.add(name + "Shin", name + "Thigh", {0.045 * x, 0.12, 0.01}, body_part::leg(side, Segment::kMiddle));
    body.add(name + "Foot", name + "Shin", {0.045 * x, 0.05, -0.03}, body_part::leg(side, Segment::kWhole));
    body.add(name + "Toes", name + "Foot", {0.045 * x, 0.005, 0}, body_part::leg(side, Segment::kWhole));
  }
  return body;
}

// A snake that lies along its path, the root at the tail's tip; its middle may be read as a trunk or as a tail.
inline MadeBody snake() {
  MadeBody body;
  addChain(body, "Spine", 14, "", {0, 0.05, -0.7}, {0, 0, 0.1},
           {PartKind::kTrunk, Side::kCenter, 0, Segment::kWhole, 0});
  body.add("Head", "Spine14", {0, 0.06, 0.7}, body_part::kHead);
  body.add("Jaw", "Head", {0, 0.05, 0.74}, {PartKind::kJaw, Side::kCenter, 0, Segment::kWhole, 0});
  return body;
}

// A fish with two pairs of fins and one on its back.
inline MadeBody fish() {
  MadeBody body;
  const auto fin = [](Side side, Index pair) { return BodyPart{PartKind::kFin, side, pair, Segment::kWhole, 0}; };
  body.add("Body", "", {0, 0, 0}, body_part::kPelvis);
  body.add("Head", "Body", {0, 0, 0.25}, body_part::kHead);
  body.add("Jaw", "Head", {0, -0.03, 0.33}, {PartKind::kJaw, Side::kCenter, 0, Segment::kWhole, 0});
  addChain(body, "Tail", 4, "Body", {0, 0, -0.15}, {0, 0, -0.13}, body_part::kTail);
  for (const Side side : kSides) {
    const double x = side == Side::kLeft ? 1 : -1;
    const std::string name = side == Side::kLeft ? "_L" : "_R";
    body.add("PectoralFin1" + name, "Body", {0.06 * x, -0.03, 0.16}, fin(side, 0));
    body.add("PectoralFin2" + name, "PectoralFin1" + name, {0.16 * x, -0.05, 0.1}, fin(side, 0));
    body.add("PelvicFin1" + name, "Body", {0.04 * x, -0.08, -0.08}, fin(side, 1));
    body.add("PelvicFin2" + name, "PelvicFin1" + name, {0.07 * x, -0.14, -0.12}, fin(side, 1));
  }
  return body;
}

// Eight legs on one body, those in front the longest.
inline MadeBody spider() {
  MadeBody body;
  body.add("Body", "", {0, 0.15, 0}, body_part::kPelvis);
  body.add("Abdomen", "Body", {0, 0.17, -0.1}, body_part::kTrunk);
  body.add("Head", "Body", {0, 0.15, 0.1}, body_part::kHead);
  for (const Side side : kSides) {
    for (Index pair = 0; pair < 4; ++pair) {
      const double x = side == Side::kLeft ? 1 : -1, z = 0.06 - 0.04 * pair, ahead = 3 * z, reach = 1.6 - 0.2 * pair;
      const std::string name = std::string(side == Side::kLeft ? "L" : "R") + "_Leg" + std::to_string(pair + 1) + "_";
      body.add(name + "Coxa", "Body", {0.06 * x, 0.15, z}, body_part::leg(side, Segment::kUpper, pair));
      body.add(name + "Femur", name + "Coxa", {(0.06 + 0.14 * reach) * x, 0.25, z + 0.5 * reach * ahead},
               body_part::leg(side, Segment::kMiddle, pair));
      body.add(name + "Tarsus", name + "Femur", {(0.06 + 0.32 * reach) * x, 0.02, z + reach * ahead},
               body_part::leg(side, Segment::kEnd, pair));
    }
  }
  return body;
}

}  // namespace limber::testing
