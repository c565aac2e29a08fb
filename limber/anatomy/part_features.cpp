#include "limber/anatomy/part_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace limber {

namespace {

// A figure is told in steps: between two knots both apply, each by how near it is. Their weights are learned, so a knot
// is no threshold, only where the answer may change its slope.
struct Figure {
  std::string_view name;
  std::array<float, 8> knots;
  std::size_t count;
};

constexpr Figure figure(std::string_view name, std::initializer_list<float> knots) {
  Figure made{name, {}, knots.size()};
  std::size_t i = 0;
  for (const float knot : knots) made.knots[i++] = knot;
  return made;
}

enum FigureName : std::size_t {
  kHeight,
  kLowestBelow,
  kHighestBelow,
  kAside,
  kAhead,
  kUpward,
  kForward,
  kOutward,
  kBoneLength,
  kBoneRatio,
  kBelowLength,
  kReach,
  kJointsBelow,
  kJointsOnPath,
  kChildren,
  kPairChildren,
  kSinglesHere,
  kAlongLimb,
  kRankInLimb,
  kLeftInLimb,
  kLimbLength,
  kLimbLow,
  kLimbHigh,
  kLimbBase,
  kLimbAhead,
  kLimbUpward,
  kLimbForward,
  kGroundedBelow,
  kGroundedAbove,
  kFreeBelow,
  kFreeAbove,
  kGroundedElsewhere,
  kFreeElsewhere,
  kGroundedAhead,
  kGroundedBehind,
  kFreeAhead,
  kFreeBehind,
  kSameBase,
  kSameBaseLonger,
  kBendForward,
  kBendUp,
  kAheadOfGrounded,
  kAheadOfFree,
  kOverGrounded,
  kOverFree,
  kDepth,
  kShape,
  kTreeShare,
  kMiddleBelow,
  kPathUp,
  kPathForward,
  kSiblingReach,
  kTipAhead,
  kTipUp,
  kTrunkRun,
  kFigures
};

constexpr std::array<Figure, kFigures> kFigureTable = {
    figure("height of the joint", {0, .05f, .12f, .25f, .45f, .65f, .85f, 1}),
    figure("lowest joint below", {0, .05f, .12f, .25f, .45f, .65f, .85f, 1}),
    figure("highest joint below", {0, .12f, .25f, .45f, .65f, .8f, .92f, 1}),
    figure("distance from the plane", {0, .01f, .04f, .1f, .2f, .35f}),
    figure("place from back to front", {0, .15f, .35f, .5f, .65f, .85f, 1}),
    figure("bone goes up", {-1, -.8f, -.4f, 0, .4f, .8f, 1}),
    figure("bone goes forward", {-1, -.8f, -.4f, 0, .4f, .8f, 1}),
    figure("bone goes outward", {-.3f, 0, .3f, .7f, 1}),
    figure("length of the bone", {0, .01f, .03f, .07f, .15f, .3f}),
    figure("bone over the parent's", {-2, -1, -.4f, 0, .4f, 1, 2}),
    figure("all bones below", {0, .01f, .04f, .1f, .25f, .5f, .9f}),
    figure("longest path below", {0, .02f, .07f, .15f, .3f, .5f, .8f}),
    figure("joints below", {1, 2, 3, 4, 6, 10, 20, 40}),
    figure("joints on the longest path", {0, 1, 2, 3, 4, 6, 9, 14}),
    figure("children", {0, 1, 2, 3, 4, 6}),
    figure("pairs that hang here", {0, 1, 2, 3, 5}),
    figure("unpaired children", {0, 1, 2, 4}),
    figure("share of the limb's length", {0, .15f, .3f, .45f, .6f, .75f, .9f, 1}),
    figure("joints from the limb's base", {0, 1, 2, 3, 4, 5, 7}),
    figure("joints to the limb's tip", {0, 1, 2, 3, 4, 5, 7}),
    figure("length of the limb", {0, .05f, .12f, .25f, .45f, .8f}),
    figure("lowest joint of the limb", {0, .04f, .1f, .2f, .35f, .6f, 1}),
    figure("highest joint of the limb", {0, .2f, .4f, .6f, .8f, .95f, 1}),
    figure("height of the limb's base", {0, .2f, .4f, .55f, .7f, .85f, 1}),
    figure("limb's base from back to front", {0, .2f, .4f, .6f, .8f, 1}),
    figure("limb goes up", {-1, -.8f, -.4f, 0, .4f, .8f, 1}),
    figure("limb goes forward", {-1, -.6f, -.2f, .2f, .6f, 1}),
    figure("limbs on the ground below", {0, 1, 2, 3, 4}),
    figure("limbs on the ground above", {0, 1, 2, 3, 4}),
    figure("free limbs below", {0, 1, 2, 3}),
    figure("free limbs above", {0, 1, 2, 3}),
    figure("other limbs on the ground", {0, 1, 2, 3, 4}),
    figure("other free limbs", {0, 1, 2, 3}),
    figure("limbs on the ground further ahead", {0, 1, 2, 3}),
    figure("limbs on the ground further back", {0, 1, 2, 3}),
    figure("free limbs further ahead", {0, 1, 2}),
    figure("free limbs further back", {0, 1, 2}),
    figure("limbs on the same joint", {0, 1, 2, 3, 5}),
    figure("longer limbs on the same joint", {0, 1, 2, 4}),
    figure("bend to the front", {-.6f, -.25f, -.06f, 0, .06f, .25f, .6f}),
    figure("bend upward", {-.8f, -.3f, 0, .3f, .8f}),
    figure("ahead of the limbs on the ground", {-.5f, -.2f, -.05f, .05f, .2f, .5f}),
    figure("ahead of the free limbs", {-.5f, -.2f, -.05f, .05f, .2f, .5f}),
    figure("over the base of limbs on the ground", {-.6f, -.3f, -.1f, 0, .1f, .3f, .6f}),
    figure("over the base of free limbs", {-.6f, -.3f, -.1f, -.02f, .02f, .1f, .3f}),
    figure("joints above", {0, 1, 2, 3, 5, 8, 12}),
    figure("height of the body over its size", {.05f, .2f, .4f, .6f, .8f, 1}),
    figure("joints of the tree", {0, .1f, .3f, .6f, 1}),
    figure("joints in the plane below", {0, 1, 2, 3, 5, 8}),
    figure("path below goes up", {-1, -.6f, -.2f, .2f, .6f, 1}),
    figure("path below goes forward", {-1, -.6f, -.2f, .2f, .6f, 1}),
    figure("longest path among siblings", {0, .2f, .5f, .8f, 1}),
    figure("tip from back to front", {0, .1f, .3f, .5f, .7f, .9f, 1}),
    figure("tip's height", {0, .1f, .3f, .5f, .7f, .9f, 1}),
    figure("joints since the last limb", {0, 1, 2, 3, 5}),
};

struct Layout {
  std::array<std::size_t, kFigures + 1> begin{};
  std::size_t kind = 0, root = 0, word = 0, wordAbove = 0, marks = 0, unnamed = 0, bias = 0, count = 0;
  constexpr Layout() {
    std::size_t at = 0;
    for (std::size_t f = 0; f < kFigures; ++f) {
      begin[f] = at;
      at += 3 * kFigureTable[f].count;  // for joints in the plane, in pairs and single ones
    }
    begin[kFigures] = at;
    kind = at;
    root = kind + 3;
    word = root + 1;
    wordAbove = word + kJointWords;
    marks = wordAbove + kJointWords;
    unnamed = marks + kNameMarks;
    bias = unnamed + 1;
    count = bias + 1;
  }
};
constexpr Layout kLayout;

enum AxesFeature : std::size_t {
  kSidesAgree,
  kSidesDiffer,
  kUpIsY,
  kUpIsZ,
  kUpIsDown,
  kUpElse,
  kFrontIsZ,
  kFrontIsX,
  kFrontIsBack,
  kFrontElse,
  kAxesFeatures
};

constexpr double kTiny = 1e-9;          // of the body's size: shorter is rounding
constexpr std::size_t kMostLimbs = 64;  // a millipede's would say no more

}  // namespace

std::size_t partFeatureCount() {
  return kLayout.count;
}

std::size_t axesFeatureCount() {
  return kAxesFeatures;
}

std::string_view partFeatureName(std::size_t number) {
  for (std::size_t f = 0; f < kFigures; ++f) {
    if (number < kLayout.begin[f + 1]) return kFigureTable[f].name;
  }
  if (number < kLayout.root) return "in the plane, in a pair, or alone";
  if (number < kLayout.word) return "is a root";
  if (number < kLayout.wordAbove) return "word of the name";
  if (number < kLayout.marks) return "word above";
  return number < kLayout.unnamed ? "mark in the name" : "all";
}

BodyMeasures::BodyMeasures(const Skeleton& skeleton, const HalfBody& body, bool names) : body_(&body) {
  const std::size_t n = body.joints.size();
  children_.resize(n);
  bone_.assign(n, 0);
  reach_.assign(n, 0);
  whole_.assign(n, 0);
  count_.assign(n, 1);
  next_.resize(n);
  limbOf_.resize(n);
  along_.assign(n, 0);
  rank_.assign(n, 0);
  words_.resize(n);
  wordAbove_.assign(n, 0);
  rootOf_.resize(n);
  for (Index i = 0; i < n; ++i) {
    const HalfJoint& half = body.joints[i];
    rootOf_[i] = i;
    if (names) words_[i] = readJointWords(skeleton.joints[half.joint].name);
    if (half.partner && names) {
      const Side one = words_[i].side, other = readJointWords(skeleton.joints[*half.partner].name).side;
      if (one != Side::kCenter && other == opposite(one)) {
        sideVotes_ += one == Side::kLeft ? 1 : -1;
        ++sideVoters_;
      }
    }
    named_ = named_ || words_[i].word != 0;
    if (!half.parent) continue;
    const Index parent = *half.parent;
    rootOf_[i] = rootOf_[parent];
    children_[parent].push_back(i);
    bone_[i] = (half.at - body.joints[parent].at).norm();
    wordAbove_[i] = words_[parent].word != 0 ? words_[parent].word : wordAbove_[parent];
    if (half.kind != HalfKind::kMiddle) {
      limbOf_[i] = limbOf_[parent] ? limbOf_[parent] : std::optional(i);
      along_[i] = limbOf_[parent] ? along_[parent] + bone_[i] : 0;
      rank_[i] = limbOf_[parent] ? rank_[parent] + 1 : 0;
    }
  }
  depth_.assign(n, 0);
  path_.assign(n, 0);
  tip_.resize(n);
  longestChild_.assign(n, {});
  for (Index i = static_cast<Index>(n); i-- > 0;) {
    tip_[i] = next_[i] ? tip_[*next_[i]] : i;
    path_[i] = next_[i] ? path_[*next_[i]] + 1 : 0;
    if (!body.joints[i].parent) {
      if (body.joints[i].kind != HalfKind::kMiddle) limbOf_[i] = i;
      continue;
    }
    const Index parent = *body.joints[i].parent;
    whole_[parent] += whole_[i] + bone_[i];
    count_[parent] += count_[i];
    double& longest = longestChild_[parent][static_cast<std::size_t>(body.joints[i].kind)];
    longest = std::max(longest, reach_[i] + bone_[i]);
    if (!next_[parent] || reach_[i] + bone_[i] > reach_[parent]) {
      reach_[parent] = reach_[i] + bone_[i];
      next_[parent] = i;
    }
  }
  for (Index i = 0; i < n; ++i) {
    if (body.joints[i].parent) depth_[i] = depth_[*body.joints[i].parent] + 1;
  }
  Index largest = 0;
  for (Index i = 0; i < n; ++i) {
    if (!body.joints[i].parent && whole_[i] > whole_[largest]) largest = i;
  }
  for (Index i = 0; i < n; ++i) {
    if (rootOf_[i] == rootOf_[largest] || whole_[largest] <= kTiny) main_.push_back(i);
  }
  total_ = n > 0 ? std::max(whole_[largest], kTiny) : 1;
}

std::vector<ActiveFeature> BodyMeasures::axesFeatures(const Axes& axes) const {
  std::vector<ActiveFeature> active;
  const auto add = [&](std::size_t feature, double value) {
    if (value > 0) active.push_back({static_cast<std::uint16_t>(feature), static_cast<float>(value)});
  };
  if (sideVoters_ > 0) {
    const double leftIsLateral = axes.left().dot(body_->lateral) > 0 ? 1 : -1;
    const double agree = leftIsLateral * sideVotes_ / sideVoters_;
    const double sure = std::min(1.0, sideVoters_ / 4);
    add(agree > 0 ? kSidesAgree : kSidesDiffer, std::abs(agree) * sure);
  }
  const auto is = [](const Vec3& direction, const Vec3& axis) { return direction.dot(axis) > 0.9; };
  add(is(axes.up, Vec3::UnitY())    ? kUpIsY
      : is(axes.up, Vec3::UnitZ())  ? kUpIsZ
      : is(axes.up, -Vec3::UnitY()) ? kUpIsDown
                                    : kUpElse,
      1);
  add(is(axes.front, Vec3::UnitZ())    ? kFrontIsZ
      : is(axes.front, Vec3::UnitX())  ? kFrontIsX
      : is(axes.front, -Vec3::UnitZ()) ? kFrontIsBack
                                       : kFrontElse,
      1);
  return active;
}

BodyMeasures::Table BodyMeasures::features(const Axes& axes) const {
  const std::size_t n = size();
  std::vector<double> up(n), ahead(n), lowest(n), highest(n);
  double low = std::numeric_limits<double>::infinity(), high = -low, back = low, front = -low, side = 0;
  double plane = 0;
  for (const Index i : main_) {
    if (body_->joints[i].kind == HalfKind::kMiddle) {
      plane = body_->lateral.dot(body_->joints[i].at);
      break;
    }
  }
  std::vector<double> aside(n);
  for (Index i = 0; i < n; ++i) {
    const Vec3& at = body_->joints[i].at;
    up[i] = axes.up.dot(at);
    ahead[i] = axes.front.dot(at);
    aside[i] = std::abs(body_->lateral.dot(at) - plane);
  }
  for (const Index i : main_) {
    low = std::min(low, up[i]);
    high = std::max(high, up[i]);
    back = std::min(back, ahead[i]);
    front = std::max(front, ahead[i]);
    side = std::max(side, aside[i]);
  }
  const double height = std::max(high - low, kTiny), depth = std::max(front - back, kTiny);
  const double size = std::max({height, depth, std::hypot(height, depth), side, kTiny});
  const auto relative = [&](double y) { return std::clamp((y - low) / height, -0.2, 1.2); };
  const auto alongBody = [&](double z) { return std::clamp((z - back) / depth, -0.2, 1.2); };
  for (Index i = static_cast<Index>(n); i-- > 0;) {
    lowest[i] = highest[i] = up[i];
    for (const Index child : children_[i]) {
      lowest[i] = std::min(lowest[i], lowest[child]);
      highest[i] = std::max(highest[i], highest[child]);
    }
  }

  // Limbs: how much each is one that stands, or one that is free.
  struct Standing {
    double grounded = 0, free = 0, ahead = 0, up = 0;
  };
  std::vector<Index> limbs;
  std::vector<Standing> standing(n);
  std::vector<double> groundedBelow(n, 0), freeBelow(n, 0), middleBelow(n, 0), trunkRun(n, 0);
  double grounded = 0, free = 0, groundedAhead = 0, freeAhead = 0, groundedUp = 0, freeUp = 0;
  for (Index i = 0; i < n; ++i) {
    const HalfJoint& half = body_->joints[i];
    if (half.kind != HalfKind::kPair || limbOf_[i] != i) continue;
    limbs.push_back(i);
    const double length = (reach_[i] + bone_[i]) / size;
    const double isLong = std::clamp((length - 0.06) / 0.1, 0.0, 1.0);
    Standing& limb = standing[i];
    limb.grounded = isLong * std::clamp((0.3 - relative(lowest[i])) / 0.2, 0.0, 1.0);
    limb.free = isLong - limb.grounded;
    limb.ahead = ahead[i];
    limb.up = up[i];
    grounded += limb.grounded;
    free += limb.free;
    groundedAhead += limb.grounded * limb.ahead;
    freeAhead += limb.free * limb.ahead;
    groundedUp += limb.grounded * limb.up;
    freeUp += limb.free * limb.up;
  }
  if (grounded > kTiny) groundedAhead /= grounded, groundedUp /= grounded;
  if (free > kTiny) freeAhead /= free, freeUp /= free;
  for (Index i = static_cast<Index>(n); i-- > 0;) {
    groundedBelow[i] += standing[i].grounded;
    freeBelow[i] += standing[i].free;
    if (!body_->joints[i].parent) continue;
    const Index parent = *body_->joints[i].parent;
    groundedBelow[parent] += groundedBelow[i];
    freeBelow[parent] += freeBelow[i];
    if (body_->joints[i].kind == HalfKind::kMiddle)
      middleBelow[parent] = std::max(middleBelow[parent], middleBelow[i] + 1);
  }
  const auto hasLimb = [&](Index i) {
    return std::any_of(children_[i].begin(), children_[i].end(),
                       [&](Index c) { return standing[c].grounded + standing[c].free > 0.5; });
  };
  for (Index i = 0; i < n; ++i) {
    if (!body_->joints[i].parent) continue;
    const Index parent = *body_->joints[i].parent;
    trunkRun[i] = hasLimb(parent) ? 0 : trunkRun[parent] + 1;
  }

  // What stands beside each limb. Of more limbs than bodies have the longest count.
  struct Others {
    double grounded = 0, free = 0, groundedAhead = 0, freeAhead = 0, same = 0, longer = 0;
  };
  std::vector<Others> othersOf(n);
  std::vector<Index> counted = limbs;
  const auto lengthOf = [&](Index limb) { return reach_[limb] + bone_[limb]; };
  if (counted.size() > kMostLimbs) {
    std::stable_sort(counted.begin(), counted.end(), [&](Index a, Index b) { return lengthOf(a) > lengthOf(b); });
    counted.resize(kMostLimbs);
  }
  for (Index i = 0; i < n; ++i) {
    if (limbOf_[i] != i) continue;
    for (const Index limb : counted) {
      if (limb == i) continue;
      const Standing& other = standing[limb];
      Others& others = othersOf[i];
      others.grounded += other.grounded;
      others.free += other.free;
      if (other.ahead > ahead[i]) {
        others.groundedAhead += other.grounded;
        others.freeAhead += other.free;
      }
      if (body_->joints[limb].parent != body_->joints[i].parent) continue;
      ++others.same;
      others.longer += lengthOf(limb) > lengthOf(i);
    }
  }

  Table table;
  table.rows.push_back(0);
  table.list.reserve(n * 64);
  for (Index i = 0; i < n; ++i) {
    const HalfJoint& half = body_->joints[i];
    const auto kind = static_cast<std::size_t>(half.kind);
    const auto tell = [&](FigureName name, double value) {
      const Figure& told = kFigureTable[name];
      const std::size_t base = kLayout.begin[name] + kind * told.count;
      const auto v = static_cast<float>(value);
      if (!(v > told.knots[0])) return table.list.push_back({static_cast<std::uint16_t>(base), 1});
      for (std::size_t k = 1; k < told.count; ++k) {
        if (v >= told.knots[k]) continue;
        const float share = (v - told.knots[k - 1]) / (told.knots[k] - told.knots[k - 1]);
        if (share < 1) table.list.push_back({static_cast<std::uint16_t>(base + k - 1), 1 - share});
        if (share > 0) table.list.push_back({static_cast<std::uint16_t>(base + k), share});
        return;
      }
      table.list.push_back({static_cast<std::uint16_t>(base + told.count - 1), 1});
    };
    const auto mark = [&](std::size_t feature) { table.list.push_back({static_cast<std::uint16_t>(feature), 1}); };

    tell(kHeight, relative(up[i]));
    tell(kLowestBelow, relative(lowest[i]));
    tell(kHighestBelow, relative(highest[i]));
    tell(kAside, aside[i] / size);
    tell(kAhead, alongBody(ahead[i]));
    const auto directionOf = [&](Index from, Index to) {
      const Vec3 way = body_->joints[to].at - body_->joints[from].at;
      const double length = way.norm();
      return length > kTiny * size ? Vec3(way / length) : Vec3(Vec3::Zero());
    };
    // Where the joint's own bone goes: to what goes on from it, of a tip from its parent.
    Vec3 bone = next_[i] ? directionOf(i, *next_[i]) : half.parent ? directionOf(*half.parent, i) : Vec3(Vec3::Zero());
    const double outward = half.kind == HalfKind::kMiddle
                               ? std::abs(body_->lateral.dot(bone))
                               : (body_->lateral.dot(half.at) > plane ? 1 : -1) * body_->lateral.dot(bone);
    tell(kUpward, axes.up.dot(bone));
    tell(kForward, axes.front.dot(bone));
    tell(kOutward, outward);
    const double own = next_[i] ? bone_[*next_[i]] : 0;
    tell(kBoneLength, own / size);
    tell(kBoneRatio, own > kTiny * size && bone_[i] > kTiny * size ? std::log(own / bone_[i]) : 0);
    tell(kBelowLength, whole_[i] / total_);
    tell(kReach, reach_[i] / size);
    tell(kJointsBelow, count_[i]);
    const Index path = path_[i];
    tell(kJointsOnPath, path);
    double pairs = 0, singles = 0;
    for (const Index child : children_[i]) {
      pairs += body_->joints[child].kind == HalfKind::kPair;
      singles += body_->joints[child].kind != HalfKind::kPair;
    }
    tell(kChildren, pairs + singles);
    tell(kPairChildren, pairs);
    tell(kSinglesHere, singles);
    if (limbOf_[i]) {
      const Index first = *limbOf_[i];
      const double length = reach_[first];
      tell(kAlongLimb, length > kTiny * size ? along_[i] / length : 0);
      tell(kRankInLimb, rank_[i]);
      tell(kLeftInLimb, path);
      tell(kLimbLength, (length + bone_[first]) / size);
      tell(kLimbLow, relative(lowest[first]));
      tell(kLimbHigh, relative(highest[first]));
      tell(kLimbBase, relative(up[first]));
      tell(kLimbAhead, alongBody(ahead[first]));
      const Index tip = tip_[first];
      const Vec3 line = tip == first && half.parent && body_->joints[first].parent
                            ? directionOf(*body_->joints[first].parent, first)
                            : directionOf(first, tip);
      tell(kLimbUpward, axes.up.dot(line));
      tell(kLimbForward, axes.front.dot(line));
      const Others& others = othersOf[first];
      tell(kGroundedElsewhere, others.grounded);
      tell(kFreeElsewhere, others.free);
      tell(kGroundedAhead, others.groundedAhead);
      tell(kGroundedBehind, others.grounded - others.groundedAhead);
      tell(kFreeAhead, others.freeAhead);
      tell(kFreeBehind, others.free - others.freeAhead);
      tell(kSameBase, others.same);
      tell(kSameBaseLonger, others.longer);
    } else {
      tell(kGroundedBelow, groundedBelow[i]);
      tell(kGroundedAbove, grounded - groundedBelow[i]);
      tell(kFreeBelow, freeBelow[i]);
      tell(kFreeAbove, free - freeBelow[i]);
      tell(kMiddleBelow, middleBelow[i]);
      tell(kTrunkRun, trunkRun[i]);
    }
    Vec3 bend = Vec3::Zero();
    if (half.parent && next_[i]) bend = directionOf(*half.parent, i) - directionOf(i, *next_[i]);
    tell(kBendForward, axes.front.dot(bend));
    tell(kBendUp, axes.up.dot(bend));
    if (grounded > 0.3) {
      tell(kAheadOfGrounded, (ahead[i] - groundedAhead) / size);
      tell(kOverGrounded, (up[i] - groundedUp) / size);
    }
    if (free > 0.3) {
      tell(kAheadOfFree, (ahead[i] - freeAhead) / size);
      tell(kOverFree, (up[i] - freeUp) / size);
    }
    tell(kDepth, depth_[i]);
    tell(kShape, height / size);
    tell(kTreeShare, static_cast<double>(count_[rootOf_[i]]) / static_cast<double>(n));
    const Index tip = tip_[i];
    const Vec3 toTip = directionOf(i, tip);
    tell(kPathUp, axes.up.dot(toTip));
    tell(kPathForward, axes.front.dot(toTip));
    tell(kTipAhead, alongBody(ahead[tip]));
    tell(kTipUp, relative(up[tip]));
    tell(kSiblingReach, half.parent ? (reach_[i] + bone_[i]) / std::max(longestChild_[*half.parent][kind], kTiny) : 1);
    mark(kLayout.kind + kind);
    if (!half.parent) mark(kLayout.root);
    if (words_[i].word != 0) mark(kLayout.word + words_[i].word);
    if (wordAbove_[i] != 0) mark(kLayout.wordAbove + wordAbove_[i]);
    for (std::size_t m = 0; m < kNameMarks; ++m) {
      if (words_[i].marks[m]) mark(kLayout.marks + m);
    }
    if (!named_) mark(kLayout.unnamed);
    mark(kLayout.bias);
    table.rows.push_back(table.list.size());
  }
  return table;
}

}  // namespace limber
