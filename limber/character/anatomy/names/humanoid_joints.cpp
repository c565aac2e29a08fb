#include "limber/character/anatomy/names/humanoid_joints.h"

#include <algorithm>
#include <map>

#include "limber/character/anatomy/names/joint_words.h"

namespace limber {

namespace {

constexpr double kLikelierThanNot = 0.5;  // probability from which on a bone is named

class HumanoidReader {
 public:
  explicit HumanoidReader(const SkeletonReading& reading)
      : body_(reading.pieces()), skeleton_(believedSkeleton(reading.skeleton(), body_.anatomy)) {}

  std::vector<HumanoidJoint> read() {
    for (const HumanoidJoint& declared : declaredJoints(skeleton_)) give(declared.bone, declared.joint, 1);
    // Where a joint on the ground carries legs and spine, the hips are the one on the path up that has their name.
    std::vector<Index> trunk = body_.trunk;
    const auto isHips = [&](Index joint) {
      return body_.anatomy.declaredHips == joint || saysHips(readNameOf(skeleton_.joints[joint]));
    };
    const auto named = std::find_if(trunk.rbegin(), trunk.rend(), isHips);
    const std::optional<Index> hips = named == trunk.rend() ? body_.pelvis : std::optional(*named);
    trunk.erase(trunk.begin(), named.base());
    if (hips) give("hips", *hips, body_.centerConfidence);
    if (!declaresSpine()) {
      if (!trunk.empty()) give("spine", trunk.front(), body_.centerConfidence);
      if (trunk.size() > 1) give("chest", trunk[trunk.size() / 2], body_.centerConfidence);
      if (trunk.size() > 2) give("upperChest", trunk.back(), body_.centerConfidence);
    }
    if (!body_.neck.empty()) give("neck", body_.neck.front(), body_.centerConfidence);
    if (body_.head) give("head", *body_.head, body_.centerConfidence);
    for (const LimbPieces& limb : body_.limbs) addLimb(limb);
    std::vector<HumanoidJoint> joints;
    for (const std::string_view bone : humanoidBones()) {
      if (const auto found = given_.find(bone); found != given_.end()) joints.push_back(found->second);
    }
    return joints;
  }

 private:
  bool declaresSpine() const {
    return given_.count("spine") > 0 || given_.count("chest") > 0 || given_.count("upperChest") > 0;
  }

  void give(std::string_view name, Index joint, double confidence) {
    const std::span<const std::string_view> bones = humanoidBones();
    const auto bone = std::find(bones.begin(), bones.end(), name);
    if (confidence < kLikelierThanNot) return;
    const bool taken =
        std::any_of(given_.begin(), given_.end(), [&](const auto& one) { return one.second.joint == joint; });
    if (bone != bones.end() && !taken) given_.emplace(*bone, HumanoidJoint{*bone, joint, confidence});
  }

  void addLimb(const LimbPieces& limb) {
    const Part& part = *limb.part;
    BodyPart piece{part.kind, part.side, part.pair, Segment::kWhole, 0};
    if (part.kind == PartKind::kFinger) {
      const bool ofHand = part.carrier && body_.anatomy.parts[*part.carrier].kind == PartKind::kArm;
      for (std::size_t i = 0; ofHand && i < limb.joints.size(); ++i) {
        piece.piece = static_cast<Index>(limb.firstPiece + i);
        give(nameOf(piece), limb.joints[i], part.confidence);
      }
      return;
    }
    if (part.kind == PartKind::kJaw || part.kind == PartKind::kEye)
      return give(nameOf(piece), limb.joints.front(), part.confidence);
    if (part.kind == PartKind::kLeg && body_.anatomy.pairsOf(PartKind::kLeg) > 1) return;
    for (const auto& [segment, at] : limb.marks) {
      piece.segment = segment;
      give(nameOf(piece), limb.joints[at], part.confidence);
    }
  }

  const BodyPieces& body_;
  const Skeleton skeleton_;
  std::map<std::string_view, HumanoidJoint> given_;
};

}  // namespace

std::vector<HumanoidJoint> humanoidJoints(const SkeletonReading& skeleton) {
  return HumanoidReader(skeleton).read();
}

}  // namespace limber
