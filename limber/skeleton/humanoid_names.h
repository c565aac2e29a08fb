// Which joint of a skeleton plays which bone of a person, told by the names that programs and artists give.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// The 55 humanoid bones of VRM 1.0, parents before children: "hips", "spine", ..., "leftUpperArm", ...
std::span<const std::string_view> humanoidBones();

// The bone that `bone` hangs on in VRM 1.0 ("leftLowerArm": "leftUpperArm"); none for the hips and for unknown names.
std::optional<std::string_view> humanoidParent(std::string_view bone);

// The same bone of the other side; bones of the middle are their own.
std::string_view mirroredBone(std::string_view bone);

struct HumanoidJoint {
  std::string_view bone;  // VRM 1.0 name, lives forever
  Index joint = 0;
  double confidence = 1;  // 1 VRM's own name; 0.95 a name with one meaning; below 0.75 worth a look
};

// The joints that play bones, each bone and each joint at most once, in the order of humanoidBones(). Knows the habits
// of VRM, Unity, Unreal, Mixamo, MotionBuilder, CMU (BVH and Acclaim), Poser and DAZ, 3ds Max Biped, Rigify, MakeHuman,
// Xsens, Rokoko, OptiTrack, Kinect, SMPL, VRoid and of small game characters: prefixes, separators, sides before or
// after, numbers.
//
// One name means different joints in different habits ("LeftShoulder" is a clavicle or an upper arm, "LeftLeg" a shin
// or a thigh, "Spine1" the second or the third bone), so names are read together with the tree: the hips are where legs
// and trunk part, the trunk's bones are counted along it, and of three bones in a leg ("UpperLeg", "MidLeg",
// "LowerLeg") the last is the foot, as of animals that walk on their toes. Helpers (twist, IK, poles, ends) play
// nothing. Skeletons that are no people get few bones or none.
std::vector<HumanoidJoint> humanoidJointsByName(const Skeleton& skeleton);

// The joint in the pelvis: the hips, unless these only carry legs and trunk ("Root", on the ground) and a joint on the
// way to the spine is called hips by its name. That one moves no leg, so it plays no bone. None where hips are unknown.
std::optional<Index> pelvisByName(const Skeleton& skeleton);

}  // namespace limber
