#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limber/character/anatomy/joint_tree.h"

namespace limber {

namespace {

// Heights over the lowest joint and lengths along the ground, in heights of the skeleton. Measured on the shared rigs
// with feet or legs on a root of their own: each bound lies midway between what is joined there and what is not.
constexpr double kMaxRootHeight = 0.3, kMaxFootHeight = 0.15;  // of the root, and of the foot with all it carries
constexpr double kMinDrop = 0.08;                              // from the shin to the foot, from the knee's parent
constexpr double kMaxShinHeight = 0.45, kMaxHipHeight = 0.7;   // of the shin's and the hip's joint
constexpr double kMaxAside = 0.16;                             // of the foot from under its shin

class LegJoiner {
 public:
  LegJoiner(const Skeleton& skeleton, std::span<const Vec3> positions, const Vec3& up)
      : tree_(skeleton), positions_(positions), up_(up) {
    for (const Vec3& position : positions) {
      lowest_ = std::min(lowest_, up.dot(position));
      highest_ = std::max(highest_, up.dot(position));
    }
    lowBelow_.resize(tree_.size());
    highBelow_.resize(tree_.size());
    for (auto it = tree_.order().rbegin(); it != tree_.order().rend(); ++it) {
      lowBelow_[*it] = highBelow_[*it] = height(*it);
      for (const Index child : tree_.children(*it)) {
        lowBelow_[*it] = std::min(lowBelow_[*it], lowBelow_[child]);
        highBelow_[*it] = std::max(highBelow_[*it], highBelow_[child]);
      }
    }
  }

  JointTree joined() const {
    std::vector<std::optional<Index>> parents;
    for (Index j = 0; j < tree_.size(); ++j) parents.push_back(tree_.parent(j));
    joinFeet(parents);
    joinHips(parents);
    return JointTree(std::move(parents));
  }

 private:
  double height(Index joint) const {
    const double size = highest_ - lowest_;
    return size > 0 ? (up_.dot(positions_[joint]) - lowest_) / size : 0;
  }

  // Of up to four legs.
  void joinFeet(std::vector<std::optional<Index>>& parents) const {
    std::vector<std::pair<Index, Index>> joints;  // foot, shin
    std::set<Index> shins;
    for (Index j = 0; j < tree_.size() && joints.size() <= 4; ++j) {
      if (!isLooseFoot(j)) continue;
      const std::optional<Index> shin = shinOver(j);
      if (!shin) continue;
      joints.emplace_back(j, *shin);
      shins.insert(*shin);
    }
    if (joints.size() > 4 || shins.size() != joints.size()) return;
    for (const auto& [foot, shin] : joints) parents[foot] = shin;
  }

  // Of two legs beside the trunk on a joint on the ground.
  void joinHips(std::vector<std::optional<Index>>& parents) const {
    std::vector<Index> legs;
    for (Index j = 0; j < tree_.size(); ++j) {
      if (isLooseLeg(j)) legs.push_back(j);
    }
    if (legs.size() != 2 || parents[legs[0]] != parents[legs[1]]) return;
    const std::span<const Index> beside = tree_.children(*parents[legs[0]]);
    const Index trunk = *std::max_element(beside.begin(), beside.end(),
                                          [&](Index a, Index b) { return highBelow_[a] < highBelow_[b]; });
    if (std::find(legs.begin(), legs.end(), trunk) != legs.end()) return;  // no child rises above the legs
    for (const Index leg : legs) parents[leg] = trunk;
  }

  bool isLooseLeg(Index joint) const {
    return isBesideOthersOnTheGround(joint) && height(joint) >= kMaxFootHeight && height(joint) <= kMaxHipHeight &&
           lowBelow_[joint] < kMaxFootHeight && highBelow_[joint] <= height(joint);
  }

  // No shin hangs on one: joined feet never hang on each other.
  bool isLooseFoot(Index joint) const {
    return (!tree_.parent(joint) || isBesideOthersOnTheGround(joint)) && highBelow_[joint] < kMaxFootHeight;
  }

  bool isBesideOthersOnTheGround(Index joint) const {
    const std::optional<Index> parent = tree_.parent(joint);
    return parent && height(*parent) < kMaxRootHeight && tree_.children(*parent).size() > 1;
  }

  // The end of a limb that comes down to the foot but does not carry it.
  std::optional<Index> shinOver(Index foot) const {
    std::optional<Index> best;
    double nearest = kMaxAside * (highest_ - lowest_);
    for (Index j = 0; j < tree_.size(); ++j) {
      const std::optional<Index> parent = tree_.parent(j);
      if (!tree_.children(j).empty() || !parent) continue;
      if (height(j) < height(foot) + kMinDrop || height(j) > kMaxShinHeight) continue;
      if (height(*parent) < height(j) + kMinDrop) continue;
      const Vec3 offset = positions_[j] - positions_[foot];
      const double aside = (offset - offset.dot(up_) * up_).norm();
      if (aside >= nearest) continue;
      nearest = aside;
      best = j;
    }
    return best;
  }

  JointTree tree_;
  std::span<const Vec3> positions_;
  Vec3 up_;
  double lowest_ = HUGE_VAL, highest_ = -HUGE_VAL;
  std::vector<double> lowBelow_, highBelow_;  // #J, heights of what hangs on a joint, itself included
};

}  // namespace

JointTree withLooseFeetJoined(const Skeleton& skeleton, std::span<const Vec3> positions, const Vec3& up) {
  return LegJoiner(skeleton, positions, up).joined();
}

}  // namespace limber
