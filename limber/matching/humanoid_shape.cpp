#include "limber/matching/humanoid_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "limber/matching/humanoid_fit.h"
#include "limber/matching/loose_feet.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kLeftOver = 0.3;        // weight of what two bones leave of a limb against their being alike
constexpr double kHeadOverArms = 0.075;  // heights
constexpr double kHeadAhead = 0.3;       // of the feet, heights: no person's
constexpr double kToesSlope = 0.45;      // along the ground for what they go down, at least: else it is the shin

// Logarithm of one length over the other.
double unlike(double a, double b) {
  return a > 0 && b > 0 ? std::abs(std::log(a / b)) : std::numeric_limits<double>::infinity();
}

class ShapeReader {
 public:
  explicit ShapeReader(const Skeleton& skeleton) : original_(skeleton), skeleton_(skeleton) {
    for (const Affine& global : restGlobals(skeleton)) positions_.push_back(global.translation());
    const std::vector<std::optional<Index>> parents = parentsWithLegsJoined(skeleton, positions_);
    for (Index j = 0; j < skeleton.jointCount(); ++j) skeleton_.joints[j].parent = parents[j];
    children_ = childrenOf(skeleton_);
    Box box;
    for (const Vec3& position : positions_) box.add(position);
    center_ = box.center();
    size_ = box.size();
    ground_ = box.min.y();
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (children_[j].empty()) leaves_.push_back(j);
    }
    measureDepths();
  }

  std::vector<HumanoidJoint> read() {
    const auto feet = lowestPair();
    if (!feet) return {};
    const std::optional<Index> hips = fork(feet->first, feet->second);
    if (!hips) return {};
    lateral_ = positions_[feet->first] - positions_[feet->second];
    lateral_.y() = 0;
    lateral_.normalize();
    const auto hands = widestPair(*hips, *feet);
    if (!hands) return {};
    const std::optional<Index> chest = fork(hands->first, hands->second);
    if (!chest || !isAbove(*hips, *chest)) return {};
    if (!leftIsFirst(*hips, *feet)) lateral_ = -lateral_;

    leans_ = wayToHead(*hips, *feet).norm() > kHeadAhead * size_.y();
    const Index carrier = carrierOf(*hips, *feet);
    give("hips", carrier);
    for (const Index foot : {feet->first, feet->second}) leg(*hips, foot);
    for (const Index hand : {hands->first, hands->second}) arm(*chest, hand);
    trunkAndHead(carrier, *chest);
    return joints_;
  }

 private:
  using Pair = std::pair<Index, Index>;

  void give(std::string_view bone, Index joint) { joints_.push_back({bone, joint}); }
  void give(bool left, std::string_view leftBone, Index joint) {
    give(left ? leftBone : mirroredBone(leftBone), joint);
  }
  // Parents may come behind their children.
  void measureDepths() {
    std::vector<Index> open;
    depths_.resize(children_.size());
    for (Index j = 0; j < children_.size(); ++j) {
      if (!skeleton_.joints[j].parent) open.push_back(j);
    }
    while (!open.empty()) {
      const Index joint = open.back();
      open.pop_back();
      for (const Index child : children_[joint]) depths_[child] = depths_[joint] + 1;
      open.insert(open.end(), children_[joint].begin(), children_[joint].end());
    }
  }
  double side(Index joint) const { return lateral_.dot(positions_[joint] - center_); }
  // Or itself. As isAncestorOrSelf, but of parents that may come behind their children.
  bool isAbove(Index above, Index joint) const {
    std::optional<Index> up = joint;
    while (up && *up != above) up = skeleton_.joints[*up].parent;
    return up.has_value();
  }
  std::optional<Index> fork(Index a, Index b) const {
    std::optional<Index> one = a, other = b;
    while (one != other) {
      std::optional<Index>& deeper = depths_[*one] > depths_[*other] ? one : other;
      deeper = skeleton_.joints[*deeper].parent;
      if (!deeper) return std::nullopt;
    }
    return one;
  }
  // The joint that both legs hang on, where they do not hang on the hips.
  Index carrierOf(Index hips, const Pair& feet) const {
    std::optional<Index> up = hips;
    for (const Index foot : {feet.first, feet.second}) {
      const std::vector<Index> leg = way(hips, foot);
      while (up && !leg.empty() && !isAncestorOrSelf(original_, *up, leg.front())) up = original_.joints[*up].parent;
    }
    return up.value_or(hips);
  }
  // The joints below `from` on the way to `to`.
  std::vector<Index> way(Index from, Index to) const {
    std::vector<Index> joints;
    for (Index j = to; j != from; j = *skeleton_.joints[j].parent) joints.insert(joints.begin(), j);
    return joints;
  }

  // Two ends near the ground that lie across the middle from each other and meet high up.
  std::optional<Pair> lowestPair() const {
    std::optional<Pair> best;
    double bestCost = 0;
    for (std::size_t a = 0; a < leaves_.size(); ++a) {
      for (std::size_t b = a + 1; b < leaves_.size(); ++b) {
        const Vec3 &p = positions_[leaves_[a]], &q = positions_[leaves_[b]];
        const double top = std::max(p.y(), q.y()) - ground_;
        if (top > 0.2 * size_.y() || std::abs(p.y() - q.y()) > 0.05 * size_.y()) continue;
        const std::optional<Index> meet = fork(leaves_[a], leaves_[b]);
        if (!meet) continue;
        if (positions_[*meet].y() - ground_ < 0.3 * size_.y()) continue;
        const double cost = p.y() + q.y() - 2 * ground_ + std::abs(p.z() - q.z());
        if (!best || cost < bestCost) {
          best = {leaves_[a], leaves_[b]};
          bestCost = cost;
        }
      }
    }
    return best;
  }

  // Two ends above the hips' height or not, that hang on the trunk and reach furthest to both sides.
  std::optional<Pair> widestPair(Index hips, const Pair& feet) const {
    std::optional<Index> far[2];
    for (const Index leaf : leaves_) {
      const bool isLeg = fork(leaf, feet.first) != hips || fork(leaf, feet.second) != hips;
      if (isLeg || !isAbove(hips, leaf)) continue;
      std::optional<Index>& widest = far[side(leaf) > 0 ? 0 : 1];
      if (!widest || std::abs(side(leaf)) > std::abs(side(*widest))) widest = leaf;
    }
    if (!far[0] || !far[1]) return std::nullopt;
    const double a = std::abs(side(*far[0])), b = std::abs(side(*far[1]));
    if (std::min(a, b) < 0.1 * size_.y() || std::abs(a - b) > 0.15 * size_.y()) return std::nullopt;
    return Pair{*far[0], *far[1]};
  }

  // Whether the first foot, on the side to which lateral_ points, is the left one: toes point forward, else a head that
  // is held far ahead (a dinosaur's, whose shins' hocks bend backward), else knees.
  bool leftIsFirst(Index hips, const Pair& feet) const {
    Vec3 forward = Vec3::Zero();
    for (const Index foot : {feet.first, feet.second}) {
      const Vec3 last = positions_[foot] - positions_[*skeleton_.joints[foot].parent];
      if (std::hypot(last.x(), last.z()) > kToesSlope * std::abs(last.y())) forward += last;
    }
    forward.y() = 0;
    if (forward.norm() < 0.02 * size_.y()) {
      forward = wayToHead(hips, feet);
      if (forward.norm() < kHeadAhead * size_.y()) forward = kneesBend(hips, feet);
    }
    if (forward.norm() < 0.005 * size_.y()) forward = Vec3::UnitZ();
    return Vec3::UnitY().cross(forward).dot(lateral_) > 0;
  }

  // Of the ends in the middle that hang on that joint.
  std::optional<Index> highestEnd(Index above) const {
    std::optional<Index> top;
    for (const Index leaf : leaves_) {
      const bool inTheMiddle = std::abs(side(leaf)) < 0.1 * size_.y();
      if (!inTheMiddle || !isAbove(above, leaf) || leaf == above) continue;
      if (!top || positions_[leaf].y() > positions_[*top].y()) top = leaf;
    }
    return top;
  }

  // From between the feet, along the ground.
  Vec3 wayToHead(Index hips, const Pair& feet) const {
    const std::optional<Index> head = highestEnd(hips);
    if (!head) return Vec3::Zero();
    Vec3 way = positions_[*head] - 0.5 * (positions_[feet.first] + positions_[feet.second]);
    way.y() = 0;
    return way - way.dot(lateral_) * lateral_;
  }

  // How far the joints in the middle of the legs are off the straight way, along the ground.
  Vec3 kneesBend(Index hips, const Pair& feet) const {
    Vec3 bend = Vec3::Zero();
    for (const Index foot : {feet.first, feet.second}) {
      const std::vector<Index> joints = way(hips, foot);
      if (joints.size() < 3) continue;
      const Vec3 &top = positions_[joints.front()], leg = positions_[foot] - top;
      const auto offMiddle = [&](Index j) { return std::abs(positions_[j].y() - top.y() - 0.5 * leg.y()); };
      const Index middle = *std::min_element(joints.begin(), joints.end(),
                                             [&](Index a, Index b) { return offMiddle(a) < offMiddle(b); });
      const Vec3 knee = positions_[middle] - top;
      bend += knee - knee.y() / leg.y() * leg;
    }
    return bend - bend.dot(lateral_) * lateral_;
  }

  // Which two joints before `end` begin the two bones of a limb: such as are alike in length and together make up most
  // of the way.
  std::pair<std::size_t, std::size_t> bonesOfLimb(const std::vector<Index>& joints, std::size_t end) const {
    const auto length = [&](std::size_t a, std::size_t b) {
      return (positions_[joints[b]] - positions_[joints[a]]).norm();
    };
    double whole = 0;
    for (std::size_t i = 0; i < end; ++i) whole += length(i, i + 1);
    std::pair<std::size_t, std::size_t> best = {0, 1};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t upper = 0; upper + 1 < end; ++upper) {
      for (std::size_t lower = upper + 1; lower < end; ++lower) {
        const double first = length(upper, lower), second = length(lower, end);
        const double cost = unlike(first, second) + kLeftOver * (whole - first - second) / whole;
        if (cost >= least) continue;
        least = cost;
        best = {upper, lower};
      }
    }
    return best;
  }

  void leg(Index hips, Index foot) {
    std::vector<Index> joints = way(hips, foot);
    // Where the leg leaves the hips' joint there may be one more in the same place.
    const auto isAtHips = [&](Index joint) { return (positions_[joint] - positions_[hips]).norm() < 0.02 * size_.y(); };
    if (joints.size() > 3 && isAtHips(joints[0])) joints.erase(joints.begin());
    if (joints.size() < 2) return;
    const bool left = side(foot) > 0;
    if (joints.size() == 2) {
      give(left, "leftUpperLeg", joints[0]);
      give(left, "leftLowerLeg", joints[1]);
      return;
    }
    const double top = positions_[joints.front()].y() - ground_;
    std::size_t ankle = 2;
    for (std::size_t i = 3; i < joints.size(); ++i) {
      const auto off = [&](std::size_t at) { return std::abs(positions_[joints[at]].y() - ground_ - 0.1 * top); };
      if (off(i) < off(ankle)) ankle = i;
    }
    const auto [upper, lower] = bonesOfLimb(joints, ankle);
    give(left, "leftUpperLeg", joints[upper]);
    give(left, "leftLowerLeg", joints[lower]);
    give(left, "leftFoot", joints[ankle]);
    if (ankle + 1 < joints.size()) give(left, "leftToes", joints[ankle + 1]);
  }

  void arm(Index chest, Index hand) {
    std::vector<Index> joints = way(chest, hand);
    const bool left = side(hand) > 0;
    // The hand is where fingers begin.
    for (std::size_t i = 1; i < joints.size(); ++i) {
      if (children_[joints[i]].size() > 1 && i >= 2) {
        joints.resize(i + 1);
        break;
      }
    }
    if (joints.size() < 2) return;
    if (joints.size() == 2) {
      give(left, "leftUpperArm", joints[0]);
      give(left, "leftLowerArm", joints[1]);
      return;
    }
    const auto [upper, lower] = bonesOfLimb(joints, joints.size() - 1);
    if (upper > 0) give(left, "leftShoulder", joints[0]);
    give(left, "leftUpperArm", joints[upper]);
    give(left, "leftLowerArm", joints[lower]);
    give(left, "leftHand", joints.back());
  }

  void trunkAndHead(Index hips, Index chest) {
    std::vector<Index> trunk = way(hips, chest);
    const std::optional<Index> top = highestEnd(chest);
    std::vector<Index> joints = top ? way(chest, *top) : std::vector<Index>();
    const std::size_t beside = trunk.empty() ? besideArms(joints) : 0;
    if (beside > 0) {
      trunk.assign(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(beside));
      joints.erase(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(beside));
    }
    if (!trunk.empty()) give("spine", trunk.front());
    if (trunk.size() > 1) give("chest", trunk[trunk.size() / 2]);
    if (trunk.size() > 2) give("upperChest", trunk.back());
    if (!top || (beside == 0 && positions_[*top].y() < positions_[chest].y())) return;
    if (joints.size() == 1) return give("head", joints[0]);
    give("neck", joints[0]);
    give("head", joints[headOf(joints, beside > 0)]);
  }

  // Where arms and legs of who leans hang on one joint, with the trunk beside them: how many joints of the way to the
  // top are the trunk's, those that do not lie ahead of the arms. 0 where none are left for the neck and the head.
  std::size_t besideArms(const std::vector<Index>& joints) const {
    if (!leans_ || joints.size() < 3) return 0;
    Vec3 arms = Vec3::Zero();
    for (const HumanoidJoint& joint : joints_) {
      if (joint.bone == "leftUpperArm" || joint.bone == "rightUpperArm") arms += 0.5 * positions_[joint.joint];
    }
    const Vec3 way = positions_[joints.back()] - positions_[joints.front()];
    const auto ahead =
        std::find_if(joints.begin(), joints.end(), [&](Index joint) { return way.dot(positions_[joint] - arms) > 0; });
    const auto own = static_cast<std::size_t>(ahead - joints.begin());
    return own + 2 <= joints.size() ? own : 0;
  }

  // Of the joints from the neck to the top: what carries eyes and jaw; else what is as high over the upper arms as a
  // head's joint is, or the last where a trunk lies beside the arms.
  std::size_t headOf(const std::vector<Index>& joints, bool isLast) const {
    for (std::size_t i = 1; i + 1 < joints.size(); ++i) {
      if (children_[joints[i]].size() > 1) return i;
    }
    if (isLast) return joints.size() - 1;
    double shoulders = 0, arms = 0;
    for (const HumanoidJoint& joint : joints_) {
      if (joint.bone != "leftUpperArm" && joint.bone != "rightUpperArm") continue;
      shoulders += positions_[joint.joint].y();
      ++arms;
    }
    const double wanted = shoulders / std::max(arms, 1.0) + kHeadOverArms * size_.y();
    std::size_t best = 1;
    for (std::size_t i = 2; i < joints.size(); ++i) {
      if (std::abs(positions_[joints[i]].y() - wanted) < std::abs(positions_[joints[best]].y() - wanted)) best = i;
    }
    return best;
  }

  const Skeleton& original_;
  Skeleton skeleton_;  // each foot on its leg; of the rest transforms only positions_ hold
  std::vector<std::vector<Index>> children_;
  std::vector<Index> depths_;  // #J, 0 of roots
  std::vector<Vec3> positions_;
  std::vector<Index> leaves_;
  Vec3 center_ = Vec3::Zero(), size_ = Vec3::Zero(), lateral_ = Vec3::UnitX();
  double ground_ = 0;
  bool leans_ = false;  // the head is held far ahead
  std::vector<HumanoidJoint> joints_;
};

}  // namespace

std::vector<HumanoidJoint> humanoidJointsByShape(const Skeleton& skeleton) {
  if (skeleton.jointCount() < 8) return {};
  std::vector<HumanoidJoint> joints = ShapeReader(skeleton).read();
  rateHumanoidFit(skeleton, joints);
  return joints;
}

}  // namespace limber
