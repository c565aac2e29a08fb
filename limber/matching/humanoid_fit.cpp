#include "limber/matching/humanoid_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kSurest = 0.9, kGuess = 0.4;
constexpr double kOtherFront = 0.5;  // doubt where nothing tells the front
constexpr double kOtherLimbs = 0.5;
constexpr double kMissing = 1;
constexpr double kOtherHead = 0.5;    // doubt where the joint on the head's may be the head
constexpr double kHeadLength = 0.08;  // heights, at least

// What a person measures, in heights of the head's joint over the lowest joint of the feet.
struct Range {
  double low, high, slack;
};
constexpr Range kHips = {0.45, 0.7, 0.15};
constexpr Range kArm = {0.25, 0.5, 0.15};
constexpr Range kLeg = {0.4, 0.65, 0.15};
constexpr Range kHeadAboveShoulders = {0.01, 0.2, 0.1};
constexpr Range kNoMirror = {0, 0.02, 0.06};
constexpr Range kRatio = {-0.35, 0.35, 0.5};   // logarithm of the upper bone's length over the lower's
constexpr Range kStraight = {0.9, 1.01, 0.3};  // distance from end to end over the bones' length
constexpr Range kArmUp = {-0.8, 0.8, 0.3};     // sine of the angle over the horizontal
constexpr Range kLegUp = {-1.01, -0.9, 0.3};
constexpr double kReach = 0.3;  // of joints round those that were told

// 0 within the range, 1 from `slack` beyond it on.
double doubt(double value, const Range& range) {
  return std::clamp(std::max(range.low - value, value - range.high) / range.slack, 0.0, 1.0);
}

class Fit {
 public:
  Fit(const Skeleton& skeleton, std::span<const HumanoidJoint> joints)
      : skeleton_(skeleton), children_(childrenOf(skeleton)), joints_(joints) {
    for (const Affine& global : restGlobals(skeleton)) positions_.push_back(global.translation());
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const HumanoidJoint& joint : joints) {
      low = std::min(low, positions_[joint.joint].y());
      high = std::max(high, positions_[joint.joint].y());
    }
    ground_ = low;
    const std::optional<Vec3> head = at("head");
    height_ = std::max((head ? head->y() : high) - low, 1e-12);
    whole_ = std::max({mirrorDoubt(), otherLimbsDoubt(), hipsDoubt()});
    front_ = at("leftToes") && at("rightToes") ? 0 : kOtherFront;
    head_ = headDoubt();
  }

  double of(const HumanoidJoint& joint) const {
    const std::string bone(joint.bone);
    const bool left = bone.starts_with("left");
    if (!left && !bone.starts_with("right")) return std::max(whole_, bone == "head" || bone == "neck" ? head_ : 0.0);
    const std::string side = left ? "left" : "right";
    const bool isLeg = bone.ends_with("Leg") || bone.ends_with("Foot") || bone.ends_with("Toes");
    const double limb = isLeg ? limbDoubt(side + "UpperLeg", side + "LowerLeg", side + "Foot", kLeg, kLegUp)
                              : limbDoubt(side + "UpperArm", side + "LowerArm", side + "Hand", kArm, kArmUp);
    return std::max({whole_, front_, limb});
  }

 private:
  std::optional<Vec3> at(std::string_view bone) const {
    for (const HumanoidJoint& joint : joints_) {
      if (joint.bone == bone) return positions_[joint.joint];
    }
    return std::nullopt;
  }

  double limbDoubt(const std::string& upperBone, const std::string& lowerBone, const std::string& endBone,
                   const Range& length, const Range& up) const {
    const std::optional<Vec3> upper = at(upperBone), lower = at(lowerBone), end = at(endBone);
    if (!upper || !lower || !end) return kMissing;
    const double first = (*lower - *upper).norm(), second = (*end - *lower).norm(), whole = (*end - *upper).norm();
    if (!(first > 0) || !(second > 0) || !(whole > 0)) return kMissing;
    return std::max({doubt(std::log(first / second), kRatio), doubt((first + second) / height_, length),
                     doubt(whole / (first + second), kStraight), doubt((end->y() - upper->y()) / whole, up)});
  }

  // Of where the legs begin: what carries them may be a root on the ground.
  double hipsDoubt() const {
    const std::optional<Vec3> left = at("leftUpperLeg"), right = at("rightUpperLeg");
    if (!left || !right) return kMissing;
    return doubt((0.5 * (left->y() + right->y()) - ground_) / height_, kHips);
  }

  double headDoubt() const {
    const std::optional<Vec3> head = at("head"), left = at("leftUpperArm"), right = at("rightUpperArm");
    if (!head || !left || !right) return kMissing;
    const double place = doubt((head->y() - 0.5 * (left->y() + right->y())) / height_, kHeadAboveShoulders);
    return hasShortEnd("head") ? std::max(place, kOtherHead) : place;
  }

  // Does one joint alone hang on that one, nearer than a head is long?
  bool hasShortEnd(std::string_view bone) const {
    for (const HumanoidJoint& joint : joints_) {
      const std::vector<Index>& ends = children_[joint.joint];
      if (joint.bone != bone || ends.size() != 1) continue;
      return (positions_[ends.front()] - positions_[joint.joint]).norm() < kHeadLength * height_;
    }
    return false;
  }

  // The worst of all pairs, as mirrored in the plane between the upper legs.
  double mirrorDoubt() const {
    const std::optional<Vec3> left = at("leftUpperLeg"), right = at("rightUpperLeg");
    if (!left || !right || (*left - *right).norm() < 1e-9 * height_) return kMissing;
    const Vec3 across = (*left - *right).normalized(), middle = 0.5 * (*left + *right);
    double worst = 0;
    for (const HumanoidJoint& joint : joints_) {
      if (!joint.bone.starts_with("left")) continue;
      const std::optional<Vec3> other = at(mirroredBone(joint.bone));
      if (!other) return kMissing;
      const Vec3& position = positions_[joint.joint];
      const Vec3 image = position - 2 * across.dot(position - middle) * across;
      worst = std::max(worst, doubt((image - *other).norm() / height_, kNoMirror));
    }
    return worst;
  }

  // Ends that no joint of the person is near to: a tail, wings, more arms.
  double otherLimbsDoubt() const {
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const auto isNear = [&](const HumanoidJoint& joint) {
        return (positions_[joint.joint] - positions_[j]).norm() < kReach * height_;
      };
      if (children_[j].empty() && std::none_of(joints_.begin(), joints_.end(), isNear)) return kOtherLimbs;
    }
    return 0;
  }

  const Skeleton& skeleton_;
  std::vector<std::vector<Index>> children_;
  std::span<const HumanoidJoint> joints_;
  std::vector<Vec3> positions_;
  double ground_ = 0, height_ = 1;
  double whole_ = 0, front_ = 0, head_ = 0;  // doubts
};

}  // namespace

void rateHumanoidFit(const Skeleton& skeleton, std::span<HumanoidJoint> joints) {
  if (joints.empty()) return;
  const Fit fit(skeleton, joints);
  for (HumanoidJoint& joint : joints) joint.confidence = kSurest - (kSurest - kGuess) * fit.of(joint);
}

}  // namespace limber
