#include "limber/matching/quadruped.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limber/matching/loose_feet.h"
#include "limber/skeleton/humanoid_names.h"

namespace limber {

namespace {

// In heights of the body, from its lowest joint to where the legs begin.
constexpr double kLow = 0.2;        // of a foot, at most
constexpr double kMirrored = 0.15;  // how far left and right may be off being mirror images
constexpr double kAside = 0.02;     // of a leg from the body's middle, at least
constexpr double kBlade = 0.7;      // of the height of a blade's upper end, at which its lower one is at least
constexpr double kSteep = 1;        // how far down a leg goes for each metre along, at least
constexpr double kTrunk = 0.5;      // of the way from pair to pair, that the trunk beside them leads along at least
constexpr std::size_t kMostChains = 64;  // that hang down: more are no legs

using Joints = Quadruped::Joints;
using Leg = Quadruped::Leg;

class QuadrupedReader {
 public:
  QuadrupedReader(const Skeleton& skeleton, std::span<const Vec3> positions)
      : positions_(positions.begin(), positions.end()) {
    parents_ = parentsWithLegsJoined(skeleton, positions_);
    children_.resize(parents_.size());
    for (Index j = 0; j < parents_.size(); ++j) {
      if (parents_[j]) children_[*parents_[j]].push_back(j);
    }
    for (const HumanoidJoint& joint : humanoidJointsByName(skeleton)) {
      if (joint.bone == "head") head_ = joint.joint;
    }
  }

  std::optional<Quadruped> read() {
    findPairs();
    if (pairs_.size() != 2) return std::nullopt;
    Quadruped animal;
    if (!(pairs_[0].on == pairs_[1].on ? readTrunkBeside(animal) : readTrunkBetween(animal))) return std::nullopt;
    animal.hindquarters = pairs_[0].on;
    animal.tail = longestFrom(animal.hindquarters, animal.trunk.front());
    measure();
    for (std::size_t i = 0; i < animal.legs.size(); ++i) {
      const Pair& pair = pairs_[i / 2];
      const bool firstIsLeft = Vec3::UnitY().cross(animal.forward).dot(at(pair.one.back()) - at(pair.other.back())) > 0;
      const bool left = i % 2 == 0;
      const std::optional<Leg> leg = legOf(left == firstIsLeft ? pair.one : pair.other);
      if (!leg) return std::nullopt;
      animal.legs[i] = *leg;
      const Vec3 aside = Vec3::UnitY().cross(animal.forward), way = leg->bladeWay;
      animal.legs[i].bladeWay = {aside.dot(way), way.y(), animal.forward.dot(way)};
    }
    return toesPointBack(animal) ? std::nullopt : std::optional(animal);
  }

 private:
  // Two legs on one joint.
  struct Pair {
    Joints one, other;
    Index on = 0;
    Vec3 top = Vec3::Zero();  // between where they begin

    bool has(const Joints& leg) const { return one == leg || other == leg; }
  };

  // Trunk, neck and head, and which legs are behind: they come first. Of one whose forelegs hang on the trunk.
  bool readTrunkBetween(Quadruped& animal) {
    if (isAbove(pairs_[1].on, pairs_[0].on)) std::swap(pairs_[0], pairs_[1]);
    const Index hind = pairs_[0].on, fore = pairs_[1].on;
    if (!isAbove(hind, fore)) return false;
    for (Index j = fore; j != hind; j = *parents_[j]) animal.trunk.push_back(j);
    std::reverse(animal.trunk.begin(), animal.trunk.end());
    const Vec3 along = at(fore) - at(hind);
    if (levelled(along).norm() <= std::abs(along.y())) return false;
    animal.forward = levelled(along).normalized();
    setNeck(longestFrom(fore, std::nullopt), animal);
    return true;
  }

  // Of one whose legs all hang on one joint, beside the trunk: that is what leads over most of the way from pair to
  // pair, and where it has passed the forelegs the neck begins.
  bool readTrunkBeside(Quadruped& animal) {
    const Vec3 between = levelled(pairs_[1].top - pairs_[0].top);
    const auto share = [&](Index joint) {
      return std::clamp(between.dot(at(joint) - pairs_[0].top) / between.squaredNorm(), 0.0, 1.0);
    };
    const Index on = pairs_[0].on;
    double most = kTrunk;
    Joints path;
    for (const Index child : children_[on]) {
      if (isLeg(child)) continue;
      const Joints branch = farthestPath(child);
      double least = share(on), greatest = least;
      for (const Index joint : branch) {
        least = std::min(least, share(joint));
        greatest = std::max(greatest, share(joint));
      }
      if (greatest - least <= most) continue;
      most = greatest - least;
      path = branch;
      animal.forward = std::copysign(1, share(branch.back()) - share(on)) * between.normalized();
    }
    if (path.empty()) return false;
    if (animal.forward.dot(between) < 0) std::swap(pairs_[0], pairs_[1]);
    const auto neck = std::find_if(path.begin() + 1, path.end(),
                                   [&](Index joint) { return animal.forward.dot(at(joint) - pairs_[1].top) > 0; });
    animal.trunk.assign(path.begin(), neck);
    setNeck({neck, path.end()}, animal);
    return true;
  }

  // One whose joints hang on the chest, not on the hips, would go back to front.
  bool toesPointBack(const Quadruped& animal) const {
    double ahead = 0;
    for (const Leg& leg : animal.legs) {
      if (!leg.toes.empty()) ahead += animal.forward.dot(at(leg.toes.back()) - at(leg.foot.front()));
    }
    return ahead < 0;
  }

  const Vec3& at(Index joint) const { return positions_[joint]; }
  static Vec3 levelled(const Vec3& way) { return {way.x(), 0, way.z()}; }
  bool isAbove(Index above, Index joint) const { return firstBelow(above, joint).has_value(); }

  // From where it leaves the body down to its last joint.
  Joints chainTo(Index leaf) const {
    Joints chain = {leaf};
    while (parents_[chain.back()] && children_[*parents_[chain.back()]].size() == 1) {
      chain.push_back(*parents_[chain.back()]);
    }
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  void findPairs() {
    std::vector<Joints> chains;
    for (Index j = 0; j < children_.size(); ++j) {
      if (!children_[j].empty()) continue;
      Joints chain = chainTo(j);
      const Vec3 way = at(chain.back()) - at(chain.front());
      if (chain.size() > 2 && parents_[chain.front()] && -way.y() > kSteep * levelled(way).norm()) {
        chains.push_back(std::move(chain));
      }
    }
    if (chains.size() > kMostChains) return;
    for (std::size_t a = 0; a < chains.size(); ++a) {
      for (std::size_t b = a + 1; b < chains.size(); ++b) {
        if (!areMirrored(chains[a], chains[b])) continue;
        const Vec3 top = (at(chains[a].front()) + at(chains[b].front())) / 2;
        pairs_.push_back({chains[a], chains[b], *parents_[chains[a].front()], top});
      }
    }
    if (pairs_.size() > 2 && areFourLegs()) keepMirrorImages();
  }

  bool areFourLegs() const {
    std::set<Index> legs;
    for (const Pair& pair : pairs_) {
      if (pair.on != pairs_.front().on) return false;
      legs.insert({pair.one.front(), pair.other.front()});
    }
    return legs.size() == 4;
  }

  // Of four legs on one joint any two may look like a pair: left and right are those between which the body lies.
  void keepMirrorImages() {
    std::vector<Pair> best;
    double least = HUGE_VAL;
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      for (std::size_t b = a + 1; b < pairs_.size(); ++b) {
        if (pairs_[a].has(pairs_[b].one) || pairs_[a].has(pairs_[b].other)) continue;
        const double off = std::max(bodyAside(pairs_[a]), bodyAside(pairs_[b]));
        if (off >= least) continue;
        least = off;
        best = {pairs_[a], pairs_[b]};
      }
    }
    pairs_ = best;
  }

  // How far what hangs on the legs' joint beside them lies off the plane between left and right, at most.
  double bodyAside(const Pair& pair) const {
    const Vec3 across = levelled(at(pair.one.front()) - at(pair.other.front())).normalized();
    double off = 0;
    for (const Index child : children_[pair.on]) {
      if (isLeg(child)) continue;
      for (const Index joint : farthestPath(child)) off = std::max(off, std::abs(across.dot(at(joint) - pair.top)));
    }
    return off;
  }

  bool areMirrored(const Joints& one, const Joints& other) const {
    if (parents_[one.front()] != parents_[other.front()] || one.size() != other.size()) return false;
    const double height = at(one.front()).y() - at(one.back()).y();
    const Vec3 aside = at(one.back()) - at(other.back());
    return std::abs(aside.y()) < kMirrored * height && levelled(aside).norm() > 2 * kAside * height &&
           std::abs(at(one.front()).y() - at(other.front()).y()) < kMirrored * height;
  }

  bool isLeg(Index joint) const {
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const Pair& pair) { return joint == pair.one.front() || joint == pair.other.front(); });
  }

  // From a joint to the one below it that is farthest from where it hangs.
  Joints farthestPath(Index first) const {
    const Vec3& from = at(*parents_[first]);
    Index end = first;
    std::vector<Index> open = {first};
    while (!open.empty()) {
      const Index joint = open.back();
      open.pop_back();
      if ((at(joint) - from).norm() > (at(end) - from).norm()) end = joint;
      open.insert(open.end(), children_[joint].begin(), children_[joint].end());
    }
    Joints path = {end};
    while (path.back() != first) path.push_back(*parents_[path.back()]);
    std::reverse(path.begin(), path.end());
    return path;
  }

  // The path that leads farthest from a joint, but for legs and what begins at `but`.
  Joints longestFrom(Index on, std::optional<Index> but) const {
    Joints longest;
    double farthest = 0;
    for (const Index child : children_[on]) {
      if (child == but || isLeg(child)) continue;
      Joints path = farthestPath(child);
      const double away = (at(path.back()) - at(on)).norm();
      if (away <= farthest) continue;
      farthest = away;
      longest = std::move(path);
    }
    return longest;
  }

  // On the way from a joint down to one below it.
  std::optional<Index> firstBelow(Index above, Index joint) const {
    for (Index at = joint; parents_[at]; at = *parents_[at]) {
      if (*parents_[at] == above) return at;
    }
    return std::nullopt;
  }

  // Up to the head: the joint that is called so, else the first that several hang on, or the last.
  void setNeck(Joints path, Quadruped& animal) const {
    animal.neck = std::move(path);
    auto head = std::find_if(animal.neck.begin(), animal.neck.end(), [&](Index j) { return j == head_; });
    if (head == animal.neck.end()) {
      head = std::find_if(animal.neck.begin(), animal.neck.end(), [&](Index j) { return children_[j].size() != 1; });
    }
    if (head == animal.neck.end() || head == animal.neck.begin()) return;
    animal.head = {*head};
    animal.neck.erase(head, animal.neck.end());
  }

  void measure() {
    lowest_ = HUGE_VAL;
    double tops = 0;
    for (const Pair& pair : pairs_) {
      for (const Joints* leg : {&pair.one, &pair.other}) {
        tops += at(leg->front()).y() / 4;
        for (const Index joint : *leg) lowest_ = std::min(lowest_, at(joint).y());
      }
    }
    height_ = tops - lowest_;
  }

  double over(Index joint) const { return (at(joint).y() - lowest_) / height_; }

  std::optional<Leg> legOf(const Joints& chain) const {
    const auto foot = std::find_if(chain.begin(), chain.end(), [&](Index j) { return over(j) < kLow; });
    const auto bones = foot - chain.begin();
    if (bones < 2 || foot == chain.end()) return std::nullopt;
    auto upper = chain.begin() + (bones > 2 && over(chain[1]) > kBlade * over(chain[0]) ? 1 : 0);
    for (auto joint = upper + 1; joint + 1 < foot; ++joint) {
      if (over(*joint) > over(*(joint - 1)))
        upper = joint;  // a leg comes down; what goes up is a blade of several joints
    }
    Leg leg{{chain.begin(), upper}, {upper, foot}, {*foot}, {foot + 1, chain.end()}, Vec3::Zero(), {}};
    if (upper != chain.begin()) leg.bladeWay = (at(*upper) - at(chain.front())).normalized();
    double length = 0;
    for (auto joint = upper; joint != foot; ++joint) {
      leg.along.push_back(length);
      length += (at(*(joint + 1)) - at(*joint)).norm();
    }
    if (!(length > 0)) return std::nullopt;
    for (double& along : leg.along) along /= length;
    return leg;
  }

  std::vector<Vec3> positions_;
  std::vector<std::optional<Index>> parents_;
  std::vector<Joints> children_;
  std::optional<Index> head_;  // by its name
  std::vector<Pair> pairs_;
  double lowest_ = 0, height_ = 1;
};

}  // namespace

std::optional<Quadruped> readQuadruped(const Skeleton& skeleton, std::span<const Vec3> positions) {
  return QuadrupedReader(skeleton, positions).read();
}

std::optional<Quadruped> readQuadruped(const Skeleton& skeleton) {
  std::vector<Vec3> positions;
  for (const Affine& global : restGlobals(skeleton)) positions.push_back(global.translation());
  return readQuadruped(skeleton, positions);
}

}  // namespace limber
