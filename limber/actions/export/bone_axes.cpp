// Godot's axes are those of the reference poses in its SkeletonProfileHumanoid (scene/resources/skeleton_profile.cpp).
// Those of Unreal's mannequin are told in pull request 175 of xavier150/Blender-For-UnrealEngine-Addons: x along bones,
// against thighs and calves, straight up at pelvis and feet, and on the right all inverted; the second axis follows
// from z being the axis that spine, elbows, knees and fingers bend about (forums.unrealengine.com/t/595822) and from
// where the mannequin's thighs and toes lie from their parents. Directions are those of the right-handed space of
// files.
#include "limber/actions/export/bone_axes.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "limber/character/anatomy/body_part.h"
#include "limber/core/text/numbers.h"

namespace limber {

namespace {

// Of a body in T-pose, of its left half.
enum class Direction { kUp, kDown, kFront, kBack, kSide, kThumb };

enum class BoneKind {
  kSpine,
  kShoulder,
  kUpperArm,
  kLowerArm,
  kHand,
  kThumb,
  kUpperLeg,
  kLowerLeg,
  kFoot,
  kToes,
  kEye,
  kJaw
};

struct KindAxes {
  BoneKind kind;
  Direction bone;  // along it
  int alongYAxis;  // the axis that fixes the roll where y lies along the bone, and its direction
  Direction alongYDirection;
  double unrealX;     // 1: x along the bone, -1: against it, 0: straight up, whatever the bone's direction
  Direction unrealY;  // where y points
};

constexpr std::array kKindAxes = {
    KindAxes{BoneKind::kSpine, Direction::kUp, 2, Direction::kFront, 1, Direction::kBack},
    KindAxes{BoneKind::kShoulder, Direction::kSide, 2, Direction::kUp, 1, Direction::kBack},
    KindAxes{BoneKind::kUpperArm, Direction::kSide, 2, Direction::kDown, 1, Direction::kBack},
    KindAxes{BoneKind::kLowerArm, Direction::kSide, 2, Direction::kFront, 1, Direction::kBack},
    KindAxes{BoneKind::kHand, Direction::kSide, 2, Direction::kDown, 1, Direction::kUp},
    KindAxes{BoneKind::kThumb, Direction::kThumb, 0, Direction::kUp, 1, Direction::kUp},
    KindAxes{BoneKind::kUpperLeg, Direction::kDown, 2, Direction::kFront, -1, Direction::kFront},
    KindAxes{BoneKind::kLowerLeg, Direction::kDown, 2, Direction::kBack, -1, Direction::kFront},
    KindAxes{BoneKind::kFoot, Direction::kFront, 2, Direction::kUp, 0, Direction::kFront},
    KindAxes{BoneKind::kToes, Direction::kFront, 2, Direction::kDown, 1, Direction::kDown},
    KindAxes{BoneKind::kEye, Direction::kFront, 2, Direction::kDown, 1, Direction::kUp},
    KindAxes{BoneKind::kJaw, Direction::kFront, 2, Direction::kUp, 1, Direction::kUp},
};

struct BoneKindName {
  std::string_view bone;  // of VRM, what it ends in
  BoneKind kind;
};

// The first that fits.
constexpr std::array kKindOfBone = {
    BoneKindName{"UpperArm", BoneKind::kUpperArm}, BoneKindName{"LowerArm", BoneKind::kLowerArm},
    BoneKindName{"Shoulder", BoneKind::kShoulder}, BoneKindName{"Hand", BoneKind::kHand},
    BoneKindName{"UpperLeg", BoneKind::kUpperLeg}, BoneKindName{"LowerLeg", BoneKind::kLowerLeg},
    BoneKindName{"Foot", BoneKind::kFoot},         BoneKindName{"Toes", BoneKind::kToes},
    BoneKindName{"Eye", BoneKind::kEye},           BoneKindName{"jaw", BoneKind::kJaw},
};

constexpr double kNoBone = 1e-6;  // of the body's size: shorter bones have no direction

class BoneTurner {
 public:
  BoneTurner(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones, BoneAxes axes)
      : skeleton_(skeleton), anatomy_(anatomy), axes_(axes), globals_(restGlobals(skeleton)) {
    for (const HumanoidJoint& bone : bones) boneOf_[bone.joint] = bone.bone;
    for (const HumanoidJoint& bone : bones) {
      if (bone.bone == "leftMiddleProximal") middleFinger_[Side::kLeft] = bone.joint;
      if (bone.bone == "rightMiddleProximal") middleFinger_[Side::kRight] = bone.joint;
    }
    findDirections();
  }

  std::vector<Quat> turns() const {
    std::vector<Quat> turns;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      turns.push_back(axes_ == BoneAxes::kUnreal ? unrealTurn(j) : alongYTurn(j));
    }
    return turns;
  }

 private:
  Vec3 position(Index joint) const { return globals_[joint].translation(); }

  std::optional<Index> nextInPart(Index joint) const {
    if (!anatomy_.partOf[joint]) return std::nullopt;
    const Part& part = anatomy_.parts[*anatomy_.partOf[joint]];
    for (std::size_t i = 0; i + 1 < part.joints.size(); ++i) {
      if (part.joints[i] == joint) return part.joints[i + 1];
    }
    const auto middle = middleFinger_.find(part.side);
    return part.kind == PartKind::kArm && joint == part.end && middle != middleFinger_.end()
               ? std::optional(middle->second)
               : std::nullopt;
  }

  void findDirections() {
    std::vector<Vec3> sum(skeleton_.joints.size(), Vec3::Zero());
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (const std::optional<Index> parent = skeleton_.joints[j].parent)
        sum[*parent] += position(j) - position(*parent);
    }
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const std::optional<Index> next = nextInPart(j);
      const Vec3 bone = next ? Vec3(position(*next) - position(j)) : sum[j];
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      if (bone.norm() > kNoBone * anatomy_.size) {
        directions_.push_back(bone.normalized());
      } else if (const BoneKind kind = kindOf(j).kind; kind == BoneKind::kEye || kind == BoneKind::kJaw) {
        directions_.push_back(anatomy_.axes.front);
      } else {
        directions_.push_back(parent ? directions_[*parent] : anatomy_.axes.up);
      }
    }
  }

  const KindAxes& kindOf(Index joint) const {
    return kKindAxes[static_cast<std::size_t>(boneKind(joint).value_or(BoneKind::kSpine))];
  }

  std::optional<BoneKind> boneKind(Index joint) const {
    if (const auto bone = boneOf_.find(joint); bone != boneOf_.end()) {
      for (const BoneKindName& named : kKindOfBone) {
        if (bone->second.ends_with(named.bone)) return named.kind;
      }
    }
    const std::optional<BodyPart> part = bodyPartAt(anatomy_, joint);
    if (!part || part->side == Side::kCenter) return std::nullopt;
    if (part->kind == PartKind::kFinger) return part->pair == 0 ? BoneKind::kThumb : BoneKind::kHand;
    const bool isArm = part->kind == PartKind::kArm;
    if (!isArm && part->kind != PartKind::kLeg) return std::nullopt;
    switch (part->segment) {
      case Segment::kBase:
        return isArm ? std::optional(BoneKind::kShoulder) : BoneKind::kUpperLeg;
      case Segment::kUpper:
        return isArm ? BoneKind::kUpperArm : BoneKind::kUpperLeg;
      case Segment::kMiddle:
      case Segment::kHock:
        return isArm ? BoneKind::kLowerArm : BoneKind::kLowerLeg;
      case Segment::kEnd:
        return isArm ? BoneKind::kHand : BoneKind::kFoot;
      case Segment::kToes:
        return isArm ? BoneKind::kHand : BoneKind::kToes;
      case Segment::kWhole:
        break;
    }
    return std::nullopt;
  }

  Side sideOf(Index joint) const {
    return anatomy_.partOf[joint] ? anatomy_.parts[*anatomy_.partOf[joint]].side : Side::kCenter;
  }

  Vec3 directionOf(Direction direction, Side side) const {
    const Axes& body = anatomy_.axes;
    const Vec3 outward = side == Side::kRight ? Vec3(-body.left()) : body.left();
    switch (direction) {
      case Direction::kUp:
        return body.up;
      case Direction::kDown:
        return -body.up;
      case Direction::kFront:
        return body.front;
      case Direction::kBack:
        return -body.front;
      case Direction::kSide:
        return outward;
      case Direction::kThumb:
        break;
    }
    return (std::sqrt(2.0) * outward + body.front).normalized();  // as in Godot's reference pose
  }

  // The least turn that brings the bone from where it is in T-pose to where it is.
  Quat bring(const KindAxes& kind, Index joint) const {
    const Vec3 to = directions_[joint];
    Vec3 from = directionOf(kind.bone, sideOf(joint));
    Quat first = Quat::Identity();
    if (kind.kind == BoneKind::kSpine && from.dot(to) < 0) {  // tails, hair: by a half turn about the body's side
      first = Quat(Eigen::AngleAxisd(kPi, anatomy_.axes.left()));
      from = -from;
    }
    const Vec3 axis = from.cross(to);
    const double cosine = from.dot(to);
    if (cosine < -1 + 1e-9) return Quat(Eigen::AngleAxisd(kPi, anatomy_.axes.front)) * first;
    Quat turn(1 + cosine, axis.x(), axis.y(), axis.z());
    return turn.normalized() * first;
  }

  // The rotation that takes axis `a` to `along` and axis `b` to `across`, which are at right angles.
  static Quat turnOf(int a, const Vec3& along, int b, const Vec3& across) {
    Mat3 axes;
    const int c = 3 - a - b;
    axes.col(a) = along;
    axes.col(b) = across;
    axes.col(c) = (a + 1) % 3 == b ? along.cross(across) : across.cross(along);
    return Quat(axes).normalized();
  }

  Quat alongYTurn(Index joint) const {
    const KindAxes& kind = kindOf(joint);
    const Side side = sideOf(joint);
    return bring(kind, joint) *
           turnOf(1, directionOf(kind.bone, side), kind.alongYAxis, directionOf(kind.alongYDirection, side));
  }

  Quat unrealTurn(Index joint) const {
    const KindAxes& kind = kindOf(joint);
    const Side side = sideOf(joint);
    const double inverted = side == Side::kRight ? -1 : 1;
    const Vec3 y = inverted * directionOf(kind.unrealY, side);
    const auto bone = boneOf_.find(joint);
    const bool isPelvis = bone != boneOf_.end() && bone->second == "hips";
    if (kind.unrealX == 0 || isPelvis) return turnOf(0, inverted * anatomy_.axes.up, 1, y);
    return bring(kind, joint) * turnOf(0, inverted * kind.unrealX * directionOf(kind.bone, side), 1, y);
  }

  const Skeleton& skeleton_;
  const Anatomy& anatomy_;
  BoneAxes axes_;
  std::vector<Affine> globals_;
  std::map<Index, std::string_view> boneOf_;
  std::map<Side, Index> middleFinger_;
  std::vector<Vec3> directions_;  // #J, along the bones
};

}  // namespace

std::vector<Quat> boneTurns(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones,
                            BoneAxes axes) {
  return BoneTurner(skeleton, anatomy, bones, axes).turns();
}

}  // namespace limber
