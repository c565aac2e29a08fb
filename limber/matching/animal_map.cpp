#include "limber/matching/animal_map.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include "limber/matching/animal_legs.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kAlongChain = 0.9;  // confidence

using Chain = std::vector<Index>;

// The parts of one animal, root to tip; none where it has none.
struct Chains {
  Chain trunk, neck, tail;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The first joint from there on with that word in its name.
std::optional<Index> named(const Skeleton& skeleton, const char* word, Index from) {
  for (Index j = from; j < skeleton.jointCount(); ++j) {
    if (lower(skeleton.joints[j].name).find(word) != std::string::npos) return j;
  }
  return std::nullopt;
}

// The nearest joint above both, itself one of them where the other hangs on it.
std::optional<Index> meeting(const Skeleton& skeleton, Index one, Index other) {
  std::optional<Index> at = one;
  while (at && !isAncestorOrSelf(skeleton, *at, other)) at = skeleton.joints[*at].parent;
  return at;
}

// The joints below `above` down to `below`.
Chain pathTo(const Skeleton& skeleton, Index above, Index below) {
  if (!isAncestorOrSelf(skeleton, above, below)) return {};
  Chain path = limbBetween(skeleton, above, below);
  path.erase(path.begin());
  return path;
}

class ChainFinder {
 public:
  ChainFinder(const Skeleton& skeleton, const std::vector<Index>& legs) : skeleton_(skeleton), legs_(legs) {}

  Chains find() const {
    const std::optional<Index> hips = aboveAll();
    const std::optional<Index> chest = hips ? chestBelow(*hips) : std::nullopt;
    if (!chest) return {};
    Chains chains;
    chains.trunk = pathTo(skeleton_, *hips, *chest);
    if (const std::optional<Index> head = named(skeleton_, "head", *chest + 1)) {
      chains.neck = pathTo(skeleton_, *chest, *skeleton_.joints[*head].parent);
    }
    chains.tail = tailOf(skeleton_);
    return chains;
  }

 private:
  std::optional<Index> aboveAll() const {
    std::optional<Index> at = legs_.front();
    for (const Index leg : legs_) {
      if (at) at = meeting(skeleton_, *at, leg);
    }
    return at;
  }

  // Where two legs meet, but not all.
  std::optional<Index> chestBelow(Index hips) const {
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const std::optional<Index> at = meeting(skeleton_, legs_[i], legs_[k]);
        if (at && *at != hips) return at;
      }
    }
    return std::nullopt;
  }

  const Skeleton& skeleton_;
  const std::vector<Index>& legs_;  // their upper joints
};

// In place of what names say of these joints.
void matchChain(const std::string& part, const Chain& source, const Chain& target, const Skeleton& skeleton,
                SkeletonMap& map) {
  if (source.empty() || target.empty()) return;
  const auto isOf = [](const Chain& chain, const std::vector<Index>& joints) {
    return std::find(chain.begin(), chain.end(), joints.front()) != chain.end();
  };
  std::erase_if(map.matches,
                [&](const JointMatch& match) { return isOf(source, match.source) || isOf(target, match.target); });
  if (source.size() != target.size()) {
    map.matches.push_back({part, source, target, kAlongChain, MatchedBy::kShape});
    return;
  }
  for (std::size_t i = 0; i < target.size(); ++i) {
    const Index joint = target[i];
    map.matches.push_back({skeleton.joints[joint].name, {source[i]}, {joint}, kAlongChain, MatchedBy::kShape});
  }
}

}  // namespace

std::vector<Index> tailOf(const Skeleton& skeleton) {
  const std::optional<Index> first = named(skeleton, "tail", 0);
  if (!first) return {};
  const std::vector<std::vector<Index>> children = childrenOf(skeleton);
  Chain tail = {*first};
  while (children[tail.back()].size() == 1) tail.push_back(children[tail.back()].front());
  return tail;
}

void matchChainsOfAnimals(const Skeleton& source, const Skeleton& target, SkeletonMap& map) {
  const NeutralPose sourceNeutral = neutralPose(source, restPose(source), map, MapSide::kSource),
                    targetNeutral = neutralPose(target, restPose(target), map, MapSide::kTarget);
  std::vector<Index> from, to;
  for (const AnimalLeg& leg : animalLegs(map, source, target, sourceNeutral, targetNeutral)) {
    from.push_back(leg.source.upper);
    to.push_back(leg.target.upper);
  }
  if (to.size() < 4) return;
  const Chains one = ChainFinder(source, from).find(), other = ChainFinder(target, to).find();
  matchChain("trunk", one.trunk, other.trunk, target, map);
  matchChain("neck", one.neck, other.neck, target, map);
  matchChain("tail", one.tail, other.tail, target, map);
  std::stable_sort(map.matches.begin(), map.matches.end(),
                   [](const JointMatch& a, const JointMatch& b) { return a.target.front() < b.target.front(); });
}

}  // namespace limber
