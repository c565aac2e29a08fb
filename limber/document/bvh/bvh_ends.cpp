#include "limber/document/bvh/bvh_ends.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "limber/document/bvh/bvh_line.h"

namespace limber {

namespace {

constexpr double kMaxDifference = 0.1;  // of the lengths of a pair's chains: recorded actors are this much alike
constexpr double kMinLength = 0.5;  // of the longest pair's: arms have two thirds of the legs' length, fingers a tenth

bool hasInName(const std::string& name, std::string_view part) {
  for (std::size_t at = 0; at + part.size() <= name.size(); ++at) {
    if (isWord(std::string_view(name).substr(at, part.size()), part)) return true;
  }
  return false;
}

Vec3 middleOf(std::span<const Index> joints, std::span<const Vec3> positions) {
  Vec3 sum = Vec3::Zero();
  for (const Index j : joints) sum += positions[j];
  return sum / static_cast<double>(joints.size());
}

// Two chains that begin at children of one joint.
struct ChainPair {
  Index parent = 0, left = 0, right = 0;
  double length = 0;  // of the shorter
};

// The lengths of a tree's chains along the bones.
class ChainLengths {
 public:
  explicit ChainLengths(std::span<const BvhJoint> joints)
      : joints_(joints),
        fromRoot_(joints.size()),
        down_(joints.size()),
        next_(joints.size()),
        children_(joints.size()) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].parent) continue;
      fromRoot_[j] = fromRoot_[*joints[j].parent] + joints[j].offset.norm();
      children_[*joints[j].parent].push_back(static_cast<Index>(j));
    }
    for (std::size_t j = joints.size(); j-- > 0;) {
      for (const Index child : children_[j]) {
        const double length = joints[child].offset.norm() + down_[child];
        if (length <= down_[j]) continue;
        down_[j] = length;
        next_[j] = child;
      }
    }
  }

  double fromRoot(Index joint) const { return fromRoot_[joint]; }

  // The end of the longest chain below.
  Index endBelow(Index joint) const {
    while (next_[joint]) joint = *next_[joint];
    return joint;
  }

  // Of each joint the two children whose chains are most alike, where they are alike: neighbours by length.
  std::vector<ChainPair> pairs() const {
    std::vector<ChainPair> found;
    for (Index j = 0; j < joints_.size(); ++j) {
      std::vector<Index> byLength = children_[j];
      std::stable_sort(byLength.begin(), byLength.end(), [&](Index a, Index b) { return down_[a] < down_[b]; });
      std::optional<ChainPair> best;
      double least = kMaxDifference;
      for (std::size_t k = 1; k < byLength.size(); ++k) {
        const Index left = byLength[k - 1], right = byLength[k];
        const double length = down_[left];
        if (!(length > 0)) continue;
        const double difference = 1 - length / down_[right];
        if (difference >= least) continue;
        least = difference;
        best = {j, left, right, length};
      }
      if (best) found.push_back(*best);
    }
    return found;
  }

 private:
  std::span<const BvhJoint> joints_;
  std::vector<double> fromRoot_, down_;     // to the end of the longest chain below
  std::vector<std::optional<Index>> next_;  // along that chain
  std::vector<std::vector<Index>> children_;
};

// #J, the joints of both chains, from their first on.
std::vector<bool> jointsOfChains(const ChainPair& pair, std::span<const BvhJoint> joints) {
  std::vector<bool> inside(joints.size());
  for (Index j = 0; j < joints.size(); ++j) {
    inside[j] = j == pair.left || j == pair.right || (joints[j].parent && inside[*joints[j].parent]);
  }
  return inside;
}

}  // namespace

Vec3 BvhEnds::upwards(std::span<const Vec3> positions) const {
  return middleOf(heads, positions) - middleOf(feet, positions);
}

BvhEnds namedEnds(std::span<const BvhJoint> joints) {
  BvhEnds ends;
  for (Index j = 0; j < joints.size(); ++j) {
    const std::string& name = joints[j].name;
    if (hasInName(name, "foot") || hasInName(name, "toe") || hasInName(name, "ankle")) {
      ends.feet.push_back(j);
    } else if (hasInName(name, "head")) {
      ends.heads.push_back(j);
    }
  }
  return ends;
}

BvhEnds endsOfTree(std::span<const BvhJoint> joints) {
  const ChainLengths lengths(joints);
  std::vector<ChainPair> pairs = lengths.pairs();
  double longest = 0;
  for (const ChainPair& pair : pairs) longest = std::max(longest, pair.length);
  std::erase_if(pairs, [&](const ChainPair& pair) { return pair.length < kMinLength * longest; });
  const auto nearer = [&](const ChainPair& a, const ChainPair& b) {
    return lengths.fromRoot(a.parent) < lengths.fromRoot(b.parent);
  };
  const auto legs = std::min_element(pairs.begin(), pairs.end(), nearer);
  if (legs == pairs.end()) return {};
  const std::vector<bool> isOfLegs = jointsOfChains(*legs, joints);
  std::optional<ChainPair> arms;
  for (const ChainPair& pair : pairs) {
    if (nearer(*legs, pair) && !isOfLegs[pair.parent] && (!arms || nearer(*arms, pair))) arms = pair;
  }
  if (!arms || arms->length > legs->length) return {};
  return {{arms->parent}, {lengths.endBelow(legs->left), lengths.endBelow(legs->right)}};
}

BvhEnds findEnds(std::span<const BvhJoint> joints) {
  const BvhEnds named = namedEnds(joints);
  return named.known() ? named : endsOfTree(joints);
}

std::vector<Vec3> restPositionsOf(std::span<const BvhJoint> joints) {
  std::vector<Vec3> positions(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    positions[j] = joints[j].offset;
    if (joints[j].parent) positions[j] += positions[*joints[j].parent];
  }
  return positions;
}

}  // namespace limber
