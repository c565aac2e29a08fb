#include "limber/document/live/vmc_stream.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "limber/document/smpl/smpl_skeleton.h"

namespace limber {

namespace {

constexpr double kSettled = 0.25;       // seconds without a new bone: all of a performer's come within a few frames
constexpr double kFarthestJoint = 1e4;  // metres

// In the order of Unity's HumanBodyBones but that parents come first; `above` are parents, nearest first, of which not
// all performers have each. `smpl` is the joint that lies there in smplSkeleton.
struct VmcBone {
  std::string_view name, parent, smpl;
};
constexpr VmcBone kBones[] = {
    {"Hips", "", "pelvis"},
    {"LeftUpperLeg", "Hips", "left_hip"},
    {"RightUpperLeg", "Hips", "right_hip"},
    {"LeftLowerLeg", "LeftUpperLeg", "left_knee"},
    {"RightLowerLeg", "RightUpperLeg", "right_knee"},
    {"LeftFoot", "LeftLowerLeg", "left_ankle"},
    {"RightFoot", "RightLowerLeg", "right_ankle"},
    {"Spine", "Hips", "spine1"},
    {"Chest", "Spine", "spine2"},
    {"UpperChest", "Chest", "spine3"},
    {"Neck", "UpperChest", "neck"},
    {"Head", "Neck", "head"},
    {"LeftShoulder", "UpperChest", "left_collar"},
    {"RightShoulder", "UpperChest", "right_collar"},
    {"LeftUpperArm", "LeftShoulder", "left_shoulder"},
    {"RightUpperArm", "RightShoulder", "right_shoulder"},
    {"LeftLowerArm", "LeftUpperArm", "left_elbow"},
    {"RightLowerArm", "RightUpperArm", "right_elbow"},
    {"LeftHand", "LeftLowerArm", "left_wrist"},
    {"RightHand", "RightLowerArm", "right_wrist"},
    {"LeftToes", "LeftFoot", "left_foot"},
    {"RightToes", "RightFoot", "right_foot"},
    {"LeftEye", "Head", "left_eye_smplhf"},
    {"RightEye", "Head", "right_eye_smplhf"},
    {"Jaw", "Head", "jaw"},
    {"LeftThumbProximal", "LeftHand", "left_thumb1"},
    {"LeftThumbIntermediate", "LeftThumbProximal", "left_thumb2"},
    {"LeftThumbDistal", "LeftThumbIntermediate", "left_thumb3"},
    {"LeftIndexProximal", "LeftHand", "left_index1"},
    {"LeftIndexIntermediate", "LeftIndexProximal", "left_index2"},
    {"LeftIndexDistal", "LeftIndexIntermediate", "left_index3"},
    {"LeftMiddleProximal", "LeftHand", "left_middle1"},
    {"LeftMiddleIntermediate", "LeftMiddleProximal", "left_middle2"},
    {"LeftMiddleDistal", "LeftMiddleIntermediate", "left_middle3"},
    {"LeftRingProximal", "LeftHand", "left_ring1"},
    {"LeftRingIntermediate", "LeftRingProximal", "left_ring2"},
    {"LeftRingDistal", "LeftRingIntermediate", "left_ring3"},
    {"LeftLittleProximal", "LeftHand", "left_pinky1"},
    {"LeftLittleIntermediate", "LeftLittleProximal", "left_pinky2"},
    {"LeftLittleDistal", "LeftLittleIntermediate", "left_pinky3"},
    {"RightThumbProximal", "RightHand", "right_thumb1"},
    {"RightThumbIntermediate", "RightThumbProximal", "right_thumb2"},
    {"RightThumbDistal", "RightThumbIntermediate", "right_thumb3"},
    {"RightIndexProximal", "RightHand", "right_index1"},
    {"RightIndexIntermediate", "RightIndexProximal", "right_index2"},
    {"RightIndexDistal", "RightIndexIntermediate", "right_index3"},
    {"RightMiddleProximal", "RightHand", "right_middle1"},
    {"RightMiddleIntermediate", "RightMiddleProximal", "right_middle2"},
    {"RightMiddleDistal", "RightMiddleIntermediate", "right_middle3"},
    {"RightRingProximal", "RightHand", "right_ring1"},
    {"RightRingIntermediate", "RightRingProximal", "right_ring2"},
    {"RightRingDistal", "RightRingIntermediate", "right_ring3"},
    {"RightLittleProximal", "RightHand", "right_pinky1"},
    {"RightLittleIntermediate", "RightLittleProximal", "right_pinky2"},
    {"RightLittleDistal", "RightLittleIntermediate", "right_pinky3"},
};
static_assert(std::size(kBones) == kVmcBones);

std::optional<std::size_t> vmcBone(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kBones), std::end(kBones), [&](const VmcBone& bone) { return bone.name == name; });
  if (found == std::end(kBones)) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(kBones));
}

// A name and a transform in Unity's space, whose x points to the right: mirrored. Scales and offsets behind it, which
// are for other uses, are not looked at.
std::optional<Transform> transformIn(const OscMessage& message) {
  constexpr std::size_t kBoneNumbers = 7;
  if (message.values.size() <= kBoneNumbers || !std::holds_alternative<std::string_view>(message.values[0])) {
    return std::nullopt;
  }
  std::array<double, kBoneNumbers> numbers;
  for (std::size_t i = 0; i < kBoneNumbers; ++i) {
    const float* const value = std::get_if<float>(&message.values[i + 1]);
    if (!value || !(std::abs(*value) <= kFarthestJoint)) return std::nullopt;
    numbers[i] = *value;
  }
  Transform transform;
  transform.translation = Vec3(-numbers[0], numbers[1], numbers[2]);
  const Quat rotation(numbers[6], numbers[3], -numbers[4], -numbers[5]);
  constexpr double kUnit = 0.1;  // senders round; what is far from a rotation is none
  if (!(std::abs(rotation.norm() - 1) < kUnit)) return std::nullopt;
  transform.rotation = rotation.normalized();
  return transform;
}

Vec3 smplPosition(const Skeleton& smpl, std::string_view joint) {
  Vec3 position = Vec3::Zero();
  for (std::optional<Index> j = smpl.find(joint); j; j = smpl.joints[*j].parent) {
    position += smpl.joints[*j].rest.translation;
  }
  return position;
}

double lowestOf(const Skeleton& skeleton) {
  double lowest = 0;
  for (const Vec3& position : restPositions(skeleton)) lowest = std::min(lowest, position.y());
  return lowest;
}

}  // namespace

bool VmcStream::take(ByteSpan packet, double seconds) {
  return readOscPacket(packet, [&](const OscMessage& message) { takeMessage(message, seconds); });
}

void VmcStream::takeMessage(const OscMessage& message, double seconds) {
  const bool isRoot = message.address == "/VMC/Ext/Root/Pos";
  if (!isRoot && message.address != "/VMC/Ext/Bone/Pos") return;
  const std::optional<Transform> transform = transformIn(message);
  if (!transform) return;
  if (isRoot) {
    root_ = *transform;
    return;
  }
  const std::optional<std::size_t> bone = vmcBone(std::get<std::string_view>(message.values[0]));
  if (!bone) return;
  if (!bones_[*bone]) {
    grown_ = seconds;
    stale_ = true;
  }
  bones_[*bone] = *transform;
  ++taken_;
}

const Skeleton* VmcStream::skeleton(double seconds) {
  if (!stale_) return number_ > 0 ? &skeleton_ : nullptr;
  if (!bones_[0] || seconds < grown_ + kSettled) return number_ > 0 ? &skeleton_ : nullptr;
  stale_ = false;
  ++number_;
  skeleton_ = {};
  boneOf_.clear();
  const bool placed = std::any_of(bones_.begin() + 1, bones_.end(), [](const std::optional<Transform>& bone) {
    constexpr double kApart = 1e-4;  // metres
    return bone && bone->translation.norm() > kApart;
  });
  const Skeleton smpl = smplSkeleton(std::size_t{55});
  for (std::size_t b = 0; b < kVmcBones; ++b) {
    if (!bones_[b]) continue;
    Joint joint;
    joint.name = kBones[b].name;
    std::string_view above = kBones[b].parent;
    while (!above.empty() && !skeleton_.find(above)) above = kBones[*vmcBone(above)].parent;
    if (!above.empty()) joint.parent = skeleton_.find(above);
    if (b > 0) {
      joint.rest.translation =
          placed ? bones_[b]->translation
                 : Vec3(smplPosition(smpl, kBones[b].smpl) - smplPosition(smpl, kBones[*vmcBone(above)].smpl));
    }
    skeleton_.joints.push_back(std::move(joint));
    boneOf_.push_back(b);
  }
  skeleton_.joints[0].rest.translation.y() = -lowestOf(skeleton_);
  return &skeleton_;
}

Pose VmcStream::pose() const {
  Pose pose = restPose(skeleton_);
  for (std::size_t j = 0; j < boneOf_.size(); ++j) {
    Transform& local = pose.locals[j];
    const Transform& bone = *bones_[boneOf_[j]];
    local.rotation = bone.rotation;
    if (j > 0) continue;
    local.rotation = root_.rotation * bone.rotation;
    local.translation = root_.translation + root_.rotation * bone.translation;
  }
  return pose;
}

}  // namespace limber
