// People in T-pose whose joints have the names of one program after the other, written out by hand from what the
// programs' own skeletons are known to hold: an oracle for the table of names.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/core/types.h"
#include "limber/skeleton/skeleton.h"

namespace limber::testing {

// What a program calls the joints: % is the side, # the number of a finger's joint.
struct TargetWords {
  std::string target, left, right;
  std::string root;                                                         // none: there is no root joint
  std::vector<std::string> trunk;                                           // from the hips to the head
  std::string clavicle, upperArm, lowerArm, hand, thigh, calf, foot, toes;  // empty: there is none
  std::vector<std::vector<std::string>> fingers;            // from the thumb on; of each finger from the palm on
  std::vector<std::pair<std::string, std::string>> others;  // a joint and the one that it is a child of
};

inline std::vector<std::vector<std::string>> countedFingers(const std::vector<std::string>& patterns) {
  std::vector<std::vector<std::string>> fingers;
  for (const std::string& pattern : patterns) {
    std::vector<std::string>& finger = fingers.emplace_back();
    for (const char* number : {"1", "2", "3"}) {
      std::string name = pattern;
      finger.push_back(name.replace(name.find('#'), 1, number));
    }
  }
  return fingers;
}

inline std::vector<std::vector<std::string>> unityFingers(const std::string& side, bool isGodot) {
  std::vector<std::vector<std::string>> fingers = {{side + (isGodot ? "ThumbMetacarpal" : "ThumbProximal"),
                                                    side + (isGodot ? "ThumbProximal" : "ThumbIntermediate"),
                                                    side + "ThumbDistal"}};
  for (const char* finger : {"Index", "Middle", "Ring", "Little"}) {
    std::vector<std::string>& names = fingers.emplace_back();
    for (const char* joint : {"Proximal", "Intermediate", "Distal"}) names.push_back(side + finger + joint);
  }
  return fingers;
}

inline TargetWords unrealWords(const std::string& target) {
  TargetWords words{
      target,
      "l",
      "r",
      "root",
      {"pelvis", "spine_01", "spine_02", "spine_03", "spine_04", "spine_05", "neck_01", "neck_02", "head"},
      "clavicle_%",
      "upperarm_%",
      "lowerarm_%",
      "hand_%",
      "thigh_%",
      "calf_%",
      "foot_%",
      "ball_%",
      countedFingers({"thumb_0#_%", "index_0#_%", "middle_0#_%", "ring_0#_%", "pinky_0#_%"}),
      {{"ik_foot_root", "root"},
       {"ik_foot_%", "ik_foot_root"},
       {"ik_hand_root", "root"},
       {"ik_hand_gun", "ik_hand_root"},
       {"ik_hand_%", "ik_hand_gun"},
       {"interaction", "root"},
       {"center_of_mass", "root"}}};
  for (const char* bone : {"upperarm", "lowerarm", "thigh", "calf"}) {
    for (const char* number : {"_twist_01_%", "_twist_02_%"}) {
      words.others.emplace_back(bone + std::string(number), bone + std::string("_%"));
    }
  }
  for (std::size_t f = 1; f < 5; ++f) {  // index_metacarpal_l carries index_01_l
    std::string palm = words.fingers[f].front();
    words.fingers[f].insert(words.fingers[f].begin(), palm.replace(palm.find("_01"), 3, "_metacarpal"));
  }
  return words;
}

inline std::vector<TargetWords> targetWords() {
  std::vector<TargetWords> all = {unrealWords("unreal"), unrealWords("metahuman")};
  all.back().others.emplace_back("thigh_correctiveRoot_%", "thigh_%");
  all.back().others.emplace_back("thigh_twistCor_01_%", "thigh_twist_01_%");
  for (const char* target : {"unity", "godot"}) {
    all.push_back({target,
                   "Left",
                   "Right",
                   "Root",
                   {"Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"},
                   "%Shoulder",
                   "%UpperArm",
                   "%LowerArm",
                   "%Hand",
                   "%UpperLeg",
                   "%LowerLeg",
                   "%Foot",
                   "%Toes",
                   unityFingers("%", target == std::string("godot")),
                   {}});
  }
  all.push_back({"vrm",
                 "left",
                 "right",
                 "",
                 {"hips", "spine", "chest", "upperChest", "neck", "head"},
                 "%Shoulder",
                 "%UpperArm",
                 "%LowerArm",
                 "%Hand",
                 "%UpperLeg",
                 "%LowerLeg",
                 "%Foot",
                 "%Toes",
                 unityFingers("%", true),
                 {}});
  all.push_back({"blender",
                 "L",
                 "R",
                 "",
                 {"hips", "spine", "chest", "upper_chest", "neck", "head"},
                 "shoulder.%",
                 "upper_arm.%",
                 "forearm.%",
                 "hand.%",
                 "thigh.%",
                 "shin.%",
                 "foot.%",
                 "toe.%",
                 countedFingers({"thumb.0#.%", "f_index.0#.%", "f_middle.0#.%", "f_ring.0#.%", "f_pinky.0#.%"}),
                 {}});
  all.push_back({"rigify",
                 "L",
                 "R",
                 "",
                 {"DEF-spine", "DEF-spine.001", "DEF-spine.002", "DEF-spine.003", "DEF-spine.004", "DEF-spine.005",
                  "DEF-spine.006"},
                 "DEF-shoulder.%",
                 "DEF-upper_arm.%",
                 "DEF-forearm.%",
                 "DEF-hand.%",
                 "DEF-thigh.%",
                 "DEF-shin.%",
                 "DEF-foot.%",
                 "DEF-toe.%",
                 countedFingers({"DEF-thumb.0#.%", "DEF-f_index.0#.%", "DEF-f_middle.0#.%", "DEF-f_ring.0#.%",
                                 "DEF-f_pinky.0#.%"}),
                 {{"DEF-upper_arm.%.001", "DEF-upper_arm.%"},
                  {"DEF-forearm.%.001", "DEF-forearm.%"},
                  {"DEF-thigh.%.001", "DEF-thigh.%"},
                  {"DEF-shin.%.001", "DEF-shin.%"}}});
  all.push_back({"mixamo",
                 "Left",
                 "Right",
                 "",
                 {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2", "mixamorig:Neck",
                  "mixamorig:Head"},
                 "mixamorig:%Shoulder",
                 "mixamorig:%Arm",
                 "mixamorig:%ForeArm",
                 "mixamorig:%Hand",
                 "mixamorig:%UpLeg",
                 "mixamorig:%Leg",
                 "mixamorig:%Foot",
                 "mixamorig:%ToeBase",
                 countedFingers({"mixamorig:%HandThumb#", "mixamorig:%HandIndex#", "mixamorig:%HandMiddle#",
                                 "mixamorig:%HandRing#", "mixamorig:%HandPinky#"}),
                 {{"mixamorig:HeadTop_End", "mixamorig:Head"}, {"mixamorig:%Toe_End", "mixamorig:%ToeBase"}}});
  for (const char* finger : {"Thumb", "Index", "Middle", "Ring", "Pinky"}) {
    const std::string stem = "mixamorig:%Hand" + std::string(finger);
    all.back().others.emplace_back(stem + "4", stem + "3");
  }
  all.push_back({"actorcore",
                 "L",
                 "R",
                 "RL_BoneRoot",
                 {"CC_Base_Hip", "CC_Base_Waist", "CC_Base_Spine01", "CC_Base_Spine02", "CC_Base_NeckTwist01",
                  "CC_Base_NeckTwist02", "CC_Base_Head"},
                 "CC_Base_%_Clavicle",
                 "CC_Base_%_Upperarm",
                 "CC_Base_%_Forearm",
                 "CC_Base_%_Hand",
                 "CC_Base_%_Thigh",
                 "CC_Base_%_Calf",
                 "CC_Base_%_Foot",
                 "CC_Base_%_ToeBase",
                 countedFingers(
                     {"CC_Base_%_Thumb#", "CC_Base_%_Index#", "CC_Base_%_Mid#", "CC_Base_%_Ring#", "CC_Base_%_Pinky#"}),
                 {{"CC_Base_%_ThighTwist01", "CC_Base_%_Thigh"},
                  {"CC_Base_%_CalfTwist01", "CC_Base_%_Calf"},
                  {"CC_Base_%_UpperarmTwist01", "CC_Base_%_Upperarm"},
                  {"CC_Base_%_ForearmTwist01", "CC_Base_%_Forearm"}}});
  all.push_back({"roblox",
                 "Left",
                 "Right",
                 "Root",
                 {"LowerTorso", "UpperTorso", "Head"},
                 "",
                 "%UpperArm",
                 "%LowerArm",
                 "%Hand",
                 "%UpperLeg",
                 "%LowerLeg",
                 "%Foot",
                 "",
                 {},
                 {}});
  return all;
}

inline TargetWords wordsOf(std::string_view target) {
  const std::vector<TargetWords> all = targetWords();
  return *std::find_if(all.begin(), all.end(), [&](const TargetWords& words) { return words.target == target; });
}

class TargetPerson {
 public:
  explicit TargetPerson(const TargetWords& words) : words_(words) {
    if (!words.root.empty()) add(words.root, "", Vec3::Zero());
    addTrunk();
    for (const bool isLeft : {true, false}) addLimbs(isLeft);
    for (const auto& [name, parent] : words.others) {
      for (const bool isLeft : {true, false}) {
        if (isLeft || name.find('%') != std::string::npos) addOther(sided(name, isLeft), sided(parent, isLeft));
      }
    }
  }

  // With what each joint of the body is, as a file of VRM says.
  Skeleton declared() const {
    Skeleton result = skeleton;
    for (std::size_t j = 0; j < boneOf_.size(); ++j) result.joints[j].declaredBone = boneOf_[j];
    return result;
  }

  Skeleton skeleton;
  // Joints of trunk, limbs and fingers, no others, root or bones of the palm.
  std::vector<Index> body;

 private:
  struct LimbJoint {
    std::string name;
    Vec3 position;  // on the left
    std::string bone;
  };

  std::string sided(std::string name, bool isLeft) const {
    if (const std::size_t at = name.find('%'); at != std::string::npos) {
      name.replace(at, 1, isLeft ? words_.left : words_.right);
    }
    return name;
  }

  void add(const std::string& name, const std::string& parent, const Vec3& position) {
    Joint joint;
    joint.name = name;
    joint.parent = skeleton.find(parent);
    joint.rest.translation = joint.parent ? Vec3(position - positions_[*joint.parent]) : position;
    skeleton.joints.push_back(joint);
    positions_.push_back(position);
  }

  void addBody(const std::string& name, const std::string& parent, const Vec3& position, std::string_view bone) {
    body.push_back(skeleton.jointCount());
    add(name, parent, position);
    boneOf_.resize(skeleton.joints.size());
    boneOf_.back() = bone;
  }

  // A little off its parent towards the parent's first child.
  void addOther(const std::string& name, const std::string& parent) {
    const Index at = *skeleton.find(parent);
    Vec3 offset(0, 0.05, 0);
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (skeleton.joints[j].parent == at && at > 0) offset = 0.3 * skeleton.joints[j].rest.translation;
    }
    add(name, parent, at == 0 && !words_.root.empty() ? Vec3::Zero() : Vec3(positions_[at] + offset));
  }

  // Joints of the neck; Rigify's spine.004 and spine.005 are.
  std::size_t necks() const {
    if (words_.trunk.front() == "DEF-spine") return 2;
    const auto isNeck = [](const std::string& name) { return name.find("eck") != std::string::npos; };
    return static_cast<std::size_t>(std::count_if(words_.trunk.begin(), words_.trunk.end(), isNeck));
  }

  void addTrunk() {
    const std::size_t spines = words_.trunk.size() - 2 - necks();
    const auto fraction = [](std::size_t i, std::size_t count) {
      return count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
    };
    std::string parent = words_.root;
    const auto go = [&](const std::string& name, double height, std::string_view bone) {
      addBody(name, parent, {0, height, 0}, bone);
      parent = name;
    };
    go(words_.trunk.front(), 0.95, "hips");
    for (std::size_t i = 0; i < spines; ++i) {
      const bool isChest = spines > 1 && i == spines / 2, isLast = spines > 2 && i + 1 == spines;
      go(words_.trunk[1 + i], 1.05 + 0.31 * fraction(i, spines),
         i == 0    ? "spine"
         : isLast  ? "upperChest"
         : isChest ? "chest"
                   : "");
    }
    chest_ = parent;
    for (std::size_t i = 0; i < necks(); ++i) {
      go(words_.trunk[1 + spines + i], 1.46 + 0.07 * fraction(i, necks()), i == 0 ? "neck" : "");
    }
    go(words_.trunk.back(), 1.6, "head");
  }

  void addLimbs(bool isLeft) {
    const double side = isLeft ? 1 : -1;
    const auto limb = [&](std::string parent, std::initializer_list<LimbJoint> joints) {
      for (const LimbJoint& joint : joints) {
        if (joint.name.empty()) continue;
        const Vec3 position(side * joint.position.x(), joint.position.y(), joint.position.z());
        addBody(sided(joint.name, isLeft), parent, position, (isLeft ? "left" : "right") + joint.bone);
        parent = sided(joint.name, isLeft);
      }
    };
    limb(words_.trunk.front(), {{words_.thigh, {0.1, 0.9, 0}, "UpperLeg"},
                                {words_.calf, {0.1, 0.5, 0.01}, "LowerLeg"},
                                {words_.foot, {0.1, 0.09, -0.02}, "Foot"},
                                {words_.toes, {0.1, 0.02, 0.12}, "Toes"}});
    limb(chest_, {{words_.clavicle, {0.03, 1.41, 0}, "Shoulder"},
                  {words_.upperArm, {0.17, 1.42, 0}, "UpperArm"},
                  {words_.lowerArm, {0.45, 1.42, -0.01}, "LowerArm"},
                  {words_.hand, {0.7, 1.42, 0}, "Hand"}});
    for (std::size_t f = 0; f < words_.fingers.size(); ++f) addFinger(f, isLeft);
  }

  static std::string fingerBone(std::size_t finger, std::size_t joint, bool isLeft) {
    static const std::vector<std::string> kFingers = {"Thumb", "Index", "Middle", "Ring", "Little"};
    static const std::vector<std::string> kThumb = {"Metacarpal", "Proximal", "Distal"};
    static const std::vector<std::string> kOther = {"Proximal", "Intermediate", "Distal"};
    return (isLeft ? "left" : "right") + kFingers[finger] + (finger == 0 ? kThumb : kOther)[joint];
  }

  void addFinger(std::size_t number, bool isLeft) {
    const std::vector<std::string>& names = words_.fingers[number];
    const bool hasPalm = names.size() > 3;
    const double ahead = 0.05 - 0.025 * static_cast<double>(number);
    std::string parent = sided(words_.hand, isLeft);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = sided(names[i], isLeft);
      const double out = number == 0 ? 0.72 : hasPalm ? 0.73 : 0.78;
      const double x = out + 0.03 * static_cast<double>(i) + (hasPalm && i > 0 ? 0.03 : 0);
      const double z = ahead + (number == 0 ? 0.02 * static_cast<double>(i) : 0);
      const Vec3 position((isLeft ? 1 : -1) * x, number == 0 ? 1.41 : 1.42, z);
      if (hasPalm && i == 0) {
        add(name, parent, position);
      } else {
        addBody(name, parent, position, fingerBone(number, i - (hasPalm ? 1 : 0), isLeft));
      }
      parent = name;
    }
  }

  TargetWords words_;
  std::string chest_;                // the last joint of the spine
  std::vector<Vec3> positions_;      // #J, in the world
  std::vector<std::string> boneOf_;  // by joint, of VRM
};

}  // namespace limber::testing
