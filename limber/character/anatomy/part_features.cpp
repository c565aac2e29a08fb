#include "limber/character/anatomy/part_features.h"

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
  kTreeFraction,
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

constexpr double kTiny = 1e-9;         // of the body's size: shorter is rounding
constexpr std::size_t kMaxLimbs = 64;  // a millipede's would say no more

// Fills a table row by row. Space for all features of a row is reserved first, so that nothing is checked in between.
class RowWriter {
 public:
  RowWriter(BodyMeasures::Table& table, std::size_t rows) : table_(table) {
    table.list.resize(rows * kMaxActive);
    table.rows.reserve(rows + 1);
    table.rows.push_back(0);
    at_ = table.list.data();
  }
  ~RowWriter() { table_.list.resize(table_.rows.back()); }
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;

  void begin(HalfKind kind) { kind_ = static_cast<std::size_t>(kind); }
  void end() { table_.rows.push_back(static_cast<std::size_t>(at_ - table_.list.data())); }
  void mark(std::size_t feature, float value = 1) { *at_++ = {static_cast<std::uint16_t>(feature), value}; }
  // Between two knots both, by how near they are.
  void tell(FigureName name, double value) {
    const Figure& figure = kFigureTable[name];
    const std::size_t base = kLayout.begin[name] + kind_ * figure.count;
    const auto v = static_cast<float>(value);
    if (!(v > figure.knots[0])) return mark(base);
    for (std::size_t k = 1; k < figure.count; ++k) {
      if (v >= figure.knots[k]) continue;
      const float fraction = (v - figure.knots[k - 1]) / (figure.knots[k] - figure.knots[k - 1]);
      if (fraction < 1) mark(base + k - 1, 1 - fraction);
      if (fraction > 0) mark(base + k, fraction);
      return;
    }
    mark(base + figure.count - 1);
  }

 private:
  static constexpr std::size_t kMaxActive = 2 * kFigures + kNameMarks + 6;  // of one half joint
  BodyMeasures::Table& table_;
  ActiveFeature* at_;
  std::size_t kind_ = 0;
};

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

BodyMeasures::BodyMeasures(const HalfBody& body, std::span<const JointWords> words) : body_(&body) {
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
    if (!words.empty()) words_[i] = words[half.joint];
    if (half.partner && !words.empty()) {
      const Side one = words_[i].side, other = words[*half.partner].side;
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
  for (Index i = 0; i < n; ++i) {
    if (body.joints[i].kind == HalfKind::kPair && limbOf_[i] == i) limbs_.push_back(i);
  }
  counted_ = limbs_;
  const auto lengthOf = [&](Index limb) { return reach_[limb] + bone_[limb]; };
  if (counted_.size() > kMaxLimbs) {
    std::stable_sort(counted_.begin(), counted_.end(), [&](Index a, Index b) { return lengthOf(a) > lengthOf(b); });
    counted_.resize(kMaxLimbs);
  }
  measureSize();
  tellSteady();
}

void BodyMeasures::measureSize() {
  const Vec3& lateral = body_->lateral;
  for (const Index i : main_) {
    if (body_->joints[i].kind == HalfKind::kMiddle) {
      plane_ = lateral.dot(body_->joints[i].at);
      break;
    }
  }
  for (const HalfJoint& half : body_->joints) aside_.push_back(std::abs(lateral.dot(half.at) - plane_));
  Eigen::Index across = 0;
  lateral.cwiseAbs().minCoeff(&across);
  const Vec3 one = lateral.cross(Vec3::Unit(across)).normalized(), other = lateral.cross(one);
  Box box;
  double side = 0;
  for (const Index i : main_) {
    const Vec3& at = body_->joints[i].at;
    box.add(Vec3(one.dot(at), other.dot(at), 0));
    side = std::max(side, aside_[i]);
  }
  size_ = std::max({box.empty() ? 0 : box.diagonal(), side, kTiny});
}

double BodyMeasures::isLong(Index limb) const {
  return std::clamp(((reach_[limb] + bone_[limb]) / size_ - 0.06) / 0.1, 0.0, 1.0);
}

Vec3 BodyMeasures::directionOf(Index from, Index to) const {
  const Vec3 displacement = body_->joints[to].at - body_->joints[from].at;
  const double length = displacement.norm();
  return length > kTiny * size_ ? Vec3(displacement / length) : Vec3(Vec3::Zero());
}

// Where the joint's own bone goes: to what goes on from it, of a tip from its parent.
Vec3 BodyMeasures::boneAt(Index i) const {
  if (next_[i]) return directionOf(i, *next_[i]);
  const std::optional<Index>& parent = body_->joints[i].parent;
  return parent ? directionOf(*parent, i) : Vec3(Vec3::Zero());
}

void BodyMeasures::tellSteady() {
  const std::size_t n = size();
  std::vector<double> middleBelow(n, 0), trunkRun(n, 0);
  for (Index i = static_cast<Index>(n); i-- > 0;) {
    const std::optional<Index>& parent = body_->joints[i].parent;
    if (parent && body_->joints[i].kind == HalfKind::kMiddle)
      middleBelow[*parent] = std::max(middleBelow[*parent], middleBelow[i] + 1);
  }
  std::vector<bool> hasLimb(n, false);
  for (const Index limb : limbs_) {
    if (const std::optional<Index>& parent = body_->joints[limb].parent; parent && isLong(limb) > 0.5)
      hasLimb[*parent] = true;
  }
  for (Index i = 0; i < n; ++i) {
    if (const std::optional<Index>& parent = body_->joints[i].parent)
      trunkRun[i] = hasLimb[*parent] ? 0 : trunkRun[*parent] + 1;
  }

  RowWriter row(steady_, n);
  for (Index i = 0; i < n; ++i) {
    const HalfJoint& half = body_->joints[i];
    const auto kind = static_cast<std::size_t>(half.kind);
    row.begin(half.kind);
    row.tell(kAside, aside_[i] / size_);
    const double outward = body_->lateral.dot(boneAt(i));
    const bool isFolded = half.kind != HalfKind::kMiddle;
    row.tell(kOutward, isFolded ? (body_->lateral.dot(half.at) > plane_ ? 1 : -1) * outward : std::abs(outward));
    const double own = next_[i] ? bone_[*next_[i]] : 0;
    row.tell(kBoneLength, own / size_);
    row.tell(kBoneRatio, own > kTiny * size_ && bone_[i] > kTiny * size_ ? std::log(own / bone_[i]) : 0);
    row.tell(kBelowLength, whole_[i] / total_);
    row.tell(kReach, reach_[i] / size_);
    row.tell(kJointsBelow, count_[i]);
    row.tell(kJointsOnPath, path_[i]);
    double pairs = 0, singles = 0;
    for (const Index child : children_[i]) {
      pairs += body_->joints[child].kind == HalfKind::kPair;
      singles += body_->joints[child].kind != HalfKind::kPair;
    }
    row.tell(kChildren, pairs + singles);
    row.tell(kPairChildren, pairs);
    row.tell(kSinglesHere, singles);
    if (limbOf_[i]) {
      const Index first = *limbOf_[i];
      const double length = reach_[first];
      row.tell(kAlongLimb, length > kTiny * size_ ? along_[i] / length : 0);
      row.tell(kRankInLimb, rank_[i]);
      row.tell(kLeftInLimb, path_[i]);
      row.tell(kLimbLength, (length + bone_[first]) / size_);
      Index same = 0, longer = 0;
      for (const Index limb : counted_) {
        if (limb == first || body_->joints[limb].parent != body_->joints[first].parent) continue;
        ++same;
        longer += reach_[limb] + bone_[limb] > length + bone_[first];
      }
      row.tell(kSameBase, same);
      row.tell(kSameBaseLonger, longer);
    } else {
      row.tell(kMiddleBelow, middleBelow[i]);
      row.tell(kTrunkRun, trunkRun[i]);
    }
    row.tell(kDepth, depth_[i]);
    row.tell(kTreeFraction, static_cast<double>(count_[rootOf_[i]]) / static_cast<double>(n));
    row.tell(kSiblingReach,
             half.parent ? (reach_[i] + bone_[i]) / std::max(longestChild_[*half.parent][kind], kTiny) : 1);
    row.mark(kLayout.kind + kind);
    if (!half.parent) row.mark(kLayout.root);
    if (words_[i].word != 0) row.mark(kLayout.word + words_[i].word);
    if (wordAbove_[i] != 0) row.mark(kLayout.wordAbove + wordAbove_[i]);
    for (std::size_t m = 0; m < kNameMarks; ++m) {
      if (words_[i].marks[m]) row.mark(kLayout.marks + m);
    }
    if (!named_) row.mark(kLayout.unnamed);
    row.mark(kLayout.bias);
    row.end();
  }
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
  double low = std::numeric_limits<double>::infinity(), high = -low, back = low, front = -low;
  for (Index i = 0; i < n; ++i) {
    const Vec3& at = body_->joints[i].at;
    up[i] = axes.up.dot(at);
    ahead[i] = axes.front.dot(at);
  }
  for (const Index i : main_) {
    low = std::min(low, up[i]);
    high = std::max(high, up[i]);
    back = std::min(back, ahead[i]);
    front = std::max(front, ahead[i]);
  }
  const double height = std::max(high - low, kTiny), depth = std::max(front - back, kTiny);
  const auto relative = [&](double y) { return std::clamp((y - low) / height, -0.2, 1.2); };
  const auto alongBody = [&](double z) { return std::clamp((z - back) / depth, -0.2, 1.2); };
  for (Index i = static_cast<Index>(n); i-- > 0;) {
    lowest[i] = highest[i] = up[i];
    for (const Index child : children_[i]) {
      lowest[i] = std::min(lowest[i], lowest[child]);
      highest[i] = std::max(highest[i], highest[child]);
    }
  }

  // Limbs: how far each is grounded, or free.
  struct Standing {
    double grounded = 0, free = 0;
  };
  std::vector<Standing> standing(n);
  std::vector<double> groundedBelow(n, 0), freeBelow(n, 0);
  double grounded = 0, free = 0, groundedAhead = 0, freeAhead = 0, groundedUp = 0, freeUp = 0;
  for (const Index i : limbs_) {
    Standing& limb = standing[i];
    limb.grounded = isLong(i) * std::clamp((0.3 - relative(lowest[i])) / 0.2, 0.0, 1.0);
    limb.free = isLong(i) - limb.grounded;
    grounded += limb.grounded;
    free += limb.free;
    groundedAhead += limb.grounded * ahead[i];
    freeAhead += limb.free * ahead[i];
    groundedUp += limb.grounded * up[i];
    freeUp += limb.free * up[i];
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
  }

  // The other limbs beside each limb.
  struct Others {
    double grounded = 0, free = 0, groundedAhead = 0, freeAhead = 0;
  };
  std::vector<Others> othersOf(n);
  for (Index i = 0; i < n; ++i) {
    if (limbOf_[i] != i) continue;
    for (const Index limb : counted_) {
      if (limb == i) continue;
      const Standing& other = standing[limb];
      Others& others = othersOf[i];
      others.grounded += other.grounded;
      others.free += other.free;
      if (!(ahead[limb] > ahead[i])) continue;
      others.groundedAhead += other.grounded;
      others.freeAhead += other.free;
    }
  }

  Table table;
  RowWriter row(table, n);
  for (Index i = 0; i < n; ++i) {
    const HalfJoint& half = body_->joints[i];
    row.begin(half.kind);
    row.tell(kHeight, relative(up[i]));
    row.tell(kLowestBelow, relative(lowest[i]));
    row.tell(kHighestBelow, relative(highest[i]));
    row.tell(kAhead, alongBody(ahead[i]));
    const Vec3 bone = boneAt(i);
    row.tell(kUpward, axes.up.dot(bone));
    row.tell(kForward, axes.front.dot(bone));
    if (limbOf_[i]) {
      const Index first = *limbOf_[i];
      row.tell(kLimbLow, relative(lowest[first]));
      row.tell(kLimbHigh, relative(highest[first]));
      row.tell(kLimbBase, relative(up[first]));
      row.tell(kLimbAhead, alongBody(ahead[first]));
      const Index tip = tip_[first];
      const Vec3 line = tip == first && half.parent && body_->joints[first].parent
                            ? directionOf(*body_->joints[first].parent, first)
                            : directionOf(first, tip);
      row.tell(kLimbUpward, axes.up.dot(line));
      row.tell(kLimbForward, axes.front.dot(line));
      const Others& others = othersOf[first];
      row.tell(kGroundedElsewhere, others.grounded);
      row.tell(kFreeElsewhere, others.free);
      row.tell(kGroundedAhead, others.groundedAhead);
      row.tell(kGroundedBehind, others.grounded - others.groundedAhead);
      row.tell(kFreeAhead, others.freeAhead);
      row.tell(kFreeBehind, others.free - others.freeAhead);
    } else {
      row.tell(kGroundedBelow, groundedBelow[i]);
      row.tell(kGroundedAbove, grounded - groundedBelow[i]);
      row.tell(kFreeBelow, freeBelow[i]);
      row.tell(kFreeAbove, free - freeBelow[i]);
    }
    Vec3 bend = Vec3::Zero();
    if (half.parent && next_[i]) bend = directionOf(*half.parent, i) - bone;
    row.tell(kBendForward, axes.front.dot(bend));
    row.tell(kBendUp, axes.up.dot(bend));
    if (grounded > 0.3) {
      row.tell(kAheadOfGrounded, (ahead[i] - groundedAhead) / size_);
      row.tell(kOverGrounded, (up[i] - groundedUp) / size_);
    }
    if (free > 0.3) {
      row.tell(kAheadOfFree, (ahead[i] - freeAhead) / size_);
      row.tell(kOverFree, (up[i] - freeUp) / size_);
    }
    row.tell(kShape, height / size_);
    const Index tip = tip_[i];
    const Vec3 toTip = directionOf(i, tip);
    row.tell(kPathUp, axes.up.dot(toTip));
    row.tell(kPathForward, axes.front.dot(toTip));
    row.tell(kTipAhead, alongBody(ahead[tip]));
    row.tell(kTipUp, relative(up[tip]));
    row.end();
  }
  return table;
}

}  // namespace limber
