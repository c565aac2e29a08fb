#include "limber/matching/loose_feet.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// In heights of the skeleton, over its lowest joint.
constexpr double kRootHeight = 0.3, kFootHeight = 0.15;         // at most
constexpr double kShinOverFoot = 0.08, kMostShinHeight = 0.45;  // of the shin's joint
constexpr double kMostHipHeight = 0.7;
constexpr double kBesideShin = 0.16;  // along the ground, at most

class LegJoiner {
 public:
  LegJoiner(const Skeleton& skeleton, std::span<const Vec3> positions)
      : skeleton_(skeleton), positions_(positions), children_(childrenOf(skeleton)) {
    for (const Vec3& position : positions) box_.add(position);
  }

  std::vector<std::optional<Index>> parents() const {
    std::vector<std::optional<Index>> parents;
    for (const Joint& joint : skeleton_.joints) parents.push_back(joint.parent);
    joinFeet(parents);
    joinHips(parents);
    return parents;
  }

 private:
  // Of two legs or of four.
  void joinFeet(std::vector<std::optional<Index>>& parents) const {
    std::vector<std::pair<Index, Index>> joints;  // foot, shin
    std::set<Index> shins;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (!isLooseFoot(j)) continue;
      const std::optional<Index> shin = shinOver(j);
      if (!shin) continue;
      joints.emplace_back(j, *shin);
      shins.insert(*shin);
    }
    if ((joints.size() != 2 && joints.size() != 4) || shins.size() != joints.size()) return;
    for (const auto& [foot, shin] : joints) parents[foot] = shin;
  }

  // Of two legs beside the trunk on a joint on the ground.
  void joinHips(std::vector<std::optional<Index>>& parents) const {
    std::vector<Index> legs;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (isLooseLeg(j)) legs.push_back(j);
    }
    if (legs.size() != 2 || parents[legs[0]] != parents[legs[1]]) return;
    const std::vector<Index>& beside = children_[*parents[legs[0]]];
    const Index trunk = *std::max_element(beside.begin(), beside.end(), [&](Index a, Index b) {
      return heightsBelow(a).second < heightsBelow(b).second;
    });
    if (std::find(legs.begin(), legs.end(), trunk) != legs.end()) return;  // nothing else stands on that joint
    for (const Index leg : legs) parents[leg] = trunk;
  }

  bool isLooseLeg(Index joint) const {
    if (!isBesideOthersOnTheGround(joint) || height(joint) < kFootHeight || height(joint) > kMostHipHeight)
      return false;
    const auto [low, high] = heightsBelow(joint);
    return low < kFootHeight && high <= height(joint);
  }

  // The lowest and the highest of what hangs on a joint, itself included.
  std::pair<double, double> heightsBelow(Index joint) const {
    std::pair<double, double> heights = {height(joint), height(joint)};
    for (const Index child : children_[joint]) {
      const auto [low, high] = heightsBelow(child);
      heights = {std::min(heights.first, low), std::max(heights.second, high)};
    }
    return heights;
  }

  double height(Index joint) const { return (positions_[joint].y() - box_.min.y()) / box_.size().y(); }

  // No shin hangs on one: joined feet never hang on each other.
  bool isLooseFoot(Index joint) const {
    const bool loose = !skeleton_.joints[joint].parent || isBesideOthersOnTheGround(joint);
    return loose && heightsBelow(joint).second < kFootHeight;
  }

  bool isBesideOthersOnTheGround(Index joint) const {
    const std::optional<Index> parent = skeleton_.joints[joint].parent;
    return parent && height(*parent) < kRootHeight && children_[*parent].size() > 1;
  }

  // The end of a limb that comes down to the foot but does not carry it.
  std::optional<Index> shinOver(Index foot) const {
    std::optional<Index> best;
    double nearest = kBesideShin * box_.size().y();
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      if (!children_[j].empty() || !parent) continue;
      if (height(j) < height(foot) + kShinOverFoot || height(j) > kMostShinHeight) continue;
      if (height(*parent) < height(j) + kShinOverFoot) continue;
      const Vec3 way = positions_[j] - positions_[foot];
      const double beside = std::hypot(way.x(), way.z());
      if (beside >= nearest) continue;
      nearest = beside;
      best = j;
    }
    return best;
  }

  const Skeleton& skeleton_;
  std::span<const Vec3> positions_;
  std::vector<std::vector<Index>> children_;
  Box box_;
};

}  // namespace

std::vector<std::optional<Index>> parentsWithLegsJoined(const Skeleton& skeleton, std::span<const Vec3> positions) {
  return LegJoiner(skeleton, positions).parents();
}

}  // namespace limber
