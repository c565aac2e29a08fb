#include "limber/character/anatomy/part_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "limber/character/anatomy/names/joint_words.h"

namespace limber {

namespace {

// How often form tells right which finger of a hand is which, of the labelled ones without names: of five, and of
// fewer.
constexpr double kAllFingers = 0.95, kSomeFingers = 0.7;

// A limb beside which doubtful ones do not count, its probability; and of its length, what is as long and what does not
// reach the ground. Set on the characters of shared/data/wild that are there to learn from.
constexpr double kSure = 0.9, kAsLong = 0.6, kOffTheGround = 0.15;

class PartMaker {
 public:
  PartMaker(const BodyReading& reading, const LabelledBody& labels)
      : reading_(reading),
        labels_(labels),
        partsOf_(reading.body.joints.size()),
        children_(reading.body.joints.size()) {
    for (Index i = 0; i < children_.size(); ++i) {
      if (const std::optional<Index>& parent = reading.body.joints[i].parent) children_[*parent].push_back(i);
    }
    isBranch_.assign(children_.size(), false);
    hasHead_.assign(children_.size(), false);
    for (std::size_t i = children_.size(); i-- > 0;) {
      if (kindAt(static_cast<Index>(i)) == PartKind::kNeck || kindAt(static_cast<Index>(i)) == PartKind::kHead)
        hasHead_[i] = true;
      const std::optional<Index>& parent = reading.body.joints[i].parent;
      if (parent && hasHead_[i]) hasHead_[*parent] = true;
    }
  }

  std::vector<Part> make() {
    const std::vector<HalfJoint>& joints = reading_.body.joints;
    for (Index i = 0; i < joints.size(); ++i) indices(i);
    joinFeet();
    joinTrunks();
    giveForearmsHands();
    giveFeetToes();
    for (Part& part : parts_) completePath(part);
    dropToesBehind();
    dropDoubtfulLimbs();
    number();
    order();
    return std::move(parts_);
  }

 private:
  using Parts = std::pair<std::optional<std::size_t>, std::optional<std::size_t>>;  // of the joint, of its partner

  PartKind kindAt(Index half) const { return kindOf(labels_.states[half]); }

  Side sideOf(Index half, bool partner) const {
    const HalfJoint& joint = reading_.body.joints[half];
    if (joint.kind == HalfKind::kMiddle) return Side::kCenter;
    double towardsLeft = labels_.axes.left().dot(reading_.body.lateral);
    if (joint.kind == HalfKind::kSingle) {
      // Of what hangs on one of a pair its side; else where it lies.
      for (std::optional<Index> up = joint.parent; up; up = reading_.body.joints[*up].parent) {
        const HalfJoint& above = reading_.body.joints[*up];
        if (above.kind != HalfKind::kPair) continue;
        const bool onPartner = reading_.tree.isAboveOrSelf(*above.partner, joint.joint);
        return (towardsLeft > 0) != onPartner ? Side::kLeft : Side::kRight;
      }
      const double plane = joint.parent ? reading_.body.lateral.dot(reading_.body.joints[*joint.parent].at) : 0;
      const Vec3 middle = middleOf(joint.joint);
      return (reading_.body.lateral.dot(middle) - plane) * towardsLeft > 0 ? Side::kLeft : Side::kRight;
    }
    return (towardsLeft > 0) != partner ? Side::kLeft : Side::kRight;
  }

  Vec3 middleOf(Index joint) const {
    Vec3 sum = Vec3::Zero();
    for (const Index j : reading_.tree.subtree(joint)) sum += reading_.positions[j];
    return sum / static_cast<double>(reading_.tree.subtree(joint).size());
  }

  // Several of these may hang on one joint, and each is a part of its own; other parts have branches.
  static bool isOneOfMany(PartKind kind) {
    return kind == PartKind::kFinger || kind == PartKind::kHair || kind == PartKind::kProp || kind == PartKind::kEar ||
           kind == PartKind::kAttachment;
  }

  void indices(Index half) {
    const HalfJoint& joint = reading_.body.joints[half];
    const PartKind kind = kindAt(half);
    if (kind == PartKind::kOther) return;
    if (!joint.parent || kindAt(*joint.parent) != kind || !partsOf_[*joint.parent].first) return begin(half);
    const HalfJoint& parent = reading_.body.joints[*joint.parent];
    const bool goesOn = !isBranch_[*joint.parent] && nextOfKind(*joint.parent, kind) == half;
    if (!goesOn && (isOneOfMany(kind) || leavesPlane(joint, parent, kind))) return begin(half);
    isBranch_[half] = !goesOn;
    const Parts above = partsOf_[*joint.parent];
    if (joint.kind == HalfKind::kPair) {
      partsOf_[half] = {above.first, above.second.value_or(*above.first)};
      add(*partsOf_[half].first, half, joint.joint);
      add(*partsOf_[half].second, half, *joint.partner);
      return;
    }
    // What hangs on one of a pair alone.
    const bool onPartner = parent.partner && reading_.tree.isAboveOrSelf(*parent.partner, joint.joint);
    const std::size_t part = onPartner && above.second ? *above.second : *above.first;
    partsOf_[half] = {part, std::nullopt};
    add(part, half, joint.joint);
  }

  // A pair of limbs that hangs on something of its kind in the middle is no branch of it.
  static bool leavesPlane(const HalfJoint& joint, const HalfJoint& parent, PartKind kind) {
    const bool central = kind == PartKind::kTrunk || kind == PartKind::kNeck || kind == PartKind::kHead;
    return !central && parent.kind == HalfKind::kMiddle && joint.kind != HalfKind::kMiddle;
  }

  // Of the children of that kind the one on which the part goes on: towards what comes after it, else the larger.
  std::optional<Index> nextOfKind(Index parent, PartKind kind) const {
    std::optional<Index> best;
    std::size_t most = 0;
    for (const Index i : children_[parent]) {
      if (kindAt(i) != kind) continue;
      const bool isTowardsHead = kind == PartKind::kTrunk && hasHead_[i];
      const bool isPair = reading_.body.joints[i].kind == HalfKind::kPair;
      // A limb goes on with its next segment, whatever twist joints and palms beside it carry.
      const bool isNextSegment =
          (kind == PartKind::kLeg || kind == PartKind::kArm) && labels_.states[i] > labels_.states[parent];
      const std::size_t size = reading_.tree.subtree(reading_.body.joints[i].joint).size() +
                               (isTowardsHead || isPair ? reading_.tree.size() : 0) +
                               (isNextSegment ? 2 * reading_.tree.size() : 0);
      if (size <= most) continue;
      most = size;
      best = i;
    }
    return best;
  }

  void begin(Index half) {
    const HalfJoint& joint = reading_.body.joints[half];
    const auto carrierOf = [&](bool partner) -> std::optional<std::size_t> {
      for (std::optional<Index> up = joint.parent; up; up = reading_.body.joints[*up].parent) {
        const Parts& parts = partsOf_[*up];
        if (!parts.first) continue;
        const HalfJoint& above = reading_.body.joints[*up];
        const bool onPartner = partner || (joint.kind == HalfKind::kSingle && above.partner &&
                                           reading_.tree.isAboveOrSelf(*above.partner, joint.joint));
        return onPartner && parts.second ? parts.second : parts.first;
      }
      return std::nullopt;
    };
    const auto open = [&](bool partner) {
      Part part;
      part.kind = kindAt(half);
      part.side = sideOf(half, partner);
      part.confidence = part.side == Side::kCenter ? 1 : labels_.sideConfidence;
      part.carrier = carrierOf(partner);
      parts_.push_back(std::move(part));
      return parts_.size() - 1;
    };
    partsOf_[half].first = open(false);
    add(*partsOf_[half].first, half, joint.joint);
    if (!joint.partner) return;
    partsOf_[half].second = open(true);
    add(*partsOf_[half].second, half, *joint.partner);
  }

  void add(std::size_t number, Index half, Index joint) {
    Part& part = parts_[number];
    const PartState state = labels_.states[half];
    if (isBranch_[half]) {
      part.branches.push_back(joint);
      return;
    }
    const bool isFirst = part.joints.empty() || state != labels_.states[*lastOf_[number]];
    lastOf_[number] = half;
    part.joints.push_back(joint);
    // Of its first joint, and of where each segment begins: tips and twist joints may be anything.
    const double sides = part.side == Side::kCenter ? 1 : labels_.sideConfidence;
    if (isFirst)
      part.confidence = std::min(part.confidence, labels_.marginals[half][static_cast<std::size_t>(state)] * sides);
    const auto set = [&](std::optional<Index>& landmark) {
      if (!landmark) landmark = joint;
    };
    switch (state) {
      case PartState::kLegUpper:
      case PartState::kArmUpper:
        return set(part.upper);
      case PartState::kLegMiddle:
      case PartState::kArmMiddle:
        return set(part.middle);
      case PartState::kLegHock:
        return set(part.hock);
      case PartState::kLegEnd:
      case PartState::kArmEnd:
        return set(part.end);
      case PartState::kLegToes:
        return set(part.toes);
      default:
        return;
    }
  }

  // A foot on a root of its own belongs to the leg of its side that has none and ends nearest to it, and so do toes.
  void joinFeet() {
    for (std::size_t f = 0; f < parts_.size(); ++f) {
      const Part& foot = parts_[f];
      if (foot.kind != PartKind::kLeg || foot.upper || foot.middle || foot.joints.empty() || (!foot.end && !foot.toes))
        continue;
      std::optional<std::size_t> leg;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        const Part& part = parts_[p];
        const bool lacksIt = !part.end || (!foot.end && !part.toes);
        if (p == f || part.kind != PartKind::kLeg || part.side != foot.side || !lacksIt || !part.upper) continue;
        const double away = (reading_.positions[part.joints.back()] - reading_.positions[foot.joints.front()]).norm();
        if (away >= nearest) continue;
        nearest = away;
        leg = p;
      }
      if (leg) moveInto(f, *leg);
    }
    // One that no leg wants, such as a claw, is no leg.
    const bool walks = std::any_of(parts_.begin(), parts_.end(),
                                   [](const Part& part) { return part.kind == PartKind::kLeg && part.upper; });
    for (Part& part : parts_) {
      if (walks && part.kind == PartKind::kLeg && !part.upper && !part.middle) part.joints.clear();
    }
  }

  // What lies beside the spine, or under a root beside it, is of the same trunk.
  void joinTrunks() {
    std::optional<std::size_t> first;
    const auto size = [&](std::size_t p) {
      const bool hasHead = std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
        const bool isHead = part.kind == PartKind::kHead || part.kind == PartKind::kNeck;
        return isHead && !part.joints.empty() &&
               reading_.tree.isAboveOrSelf(parts_[p].joints.front(), part.joints.front());
      });
      return reading_.tree.subtree(parts_[p].joints.front()).size() + (hasHead ? reading_.tree.size() : 0);
    };
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (parts_[p].kind == PartKind::kTrunk && !parts_[p].joints.empty() && (!first || size(p) > size(*first)))
        first = p;
    }
    for (std::size_t p = 0; first && p < parts_.size(); ++p) {
      if (p == *first || parts_[p].kind != PartKind::kTrunk || parts_[p].joints.empty()) continue;
      Part& trunk = parts_[*first];
      trunk.branches.insert(trunk.branches.end(), parts_[p].joints.begin(), parts_[p].joints.end());
      parts_[p].joints.clear();
      moveInto(p, *first);
    }
  }

  // What looks like the only digit of a forearm begins with its hand.
  void giveForearmsHands() {
    for (std::size_t arm = 0; arm < parts_.size(); ++arm) {
      if (parts_[arm].kind != PartKind::kArm || !parts_[arm].middle || parts_[arm].end) continue;
      std::vector<std::size_t> digits;
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        if (parts_[p].kind == PartKind::kFinger && parts_[p].carrier == arm && !parts_[p].joints.empty())
          digits.push_back(p);
      }
      if (digits.size() != 1) continue;
      std::vector<Index>& digit = parts_[digits[0]].joints;
      parts_[arm].end = digit.front();
      parts_[arm].joints.push_back(digit.front());
      digit.erase(digit.begin());
    }
  }

  // Of several digits on a foot the middle one are its toes.
  void giveFeetToes() {
    for (std::size_t leg = 0; leg < parts_.size(); ++leg) {
      if (parts_[leg].kind != PartKind::kLeg || parts_[leg].toes || !parts_[leg].end) continue;
      std::vector<std::size_t> digits;
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        if (parts_[p].kind == PartKind::kFinger && parts_[p].carrier == leg && !parts_[p].joints.empty())
          digits.push_back(p);
      }
      if (digits.empty()) continue;
      const auto across = [&](std::size_t p) {
        return reading_.body.lateral.dot(reading_.positions[parts_[p].joints.front()]);
      };
      std::stable_sort(digits.begin(), digits.end(),
                       [&](std::size_t a, std::size_t b) { return across(a) < across(b); });
      const std::size_t middle = digits[digits.size() / 2];
      const Index first = parts_[middle].joints.front();
      moveInto(middle, leg);
      parts_[leg].toes = first;
    }
  }

  // A joint between two of a part's that hang on each other is of that part, whatever it looks like: a twist joint that
  // one side alone has.
  void completePath(Part& part) {
    std::vector<Index> whole;
    for (const Index joint : part.joints) {
      if (!whole.empty() && reading_.tree.isAboveOrSelf(whole.back(), joint)) {
        for (const Index between : reading_.tree.pathBelow(whole.back(), joint)) {
          if (between != joint) whole.push_back(between);
        }
      }
      whole.push_back(joint);
    }
    part.joints = std::move(whole);
    std::erase_if(part.branches, [&](Index joint) {
      return std::find(part.joints.begin(), part.joints.end(), joint) != part.joints.end();
    });
    for (Part& other : parts_) {
      if (&other == &part) continue;
      std::erase_if(other.branches, [&](Index joint) {
        return std::find(part.joints.begin(), part.joints.end(), joint) != part.joints.end();
      });
    }
  }

  // Heels and spurs are no toes.
  void dropToesBehind() {
    for (Part& part : parts_) {
      if (!part.toes || !part.end) continue;
      const Vec3 offset = reading_.positions[*part.toes] - reading_.positions[*part.end];
      if (labels_.axes.front.dot(offset) < 0) part.toes.reset();
    }
  }

  // Beside a certain limb, a doubtful one of the same kind counts only if it carries as much: beside a pair of legs
  // that bear the body's weight, straps and coats are attachments, and so are breasts beside arms.
  void dropDoubtfulLimbs() {
    for (const PartKind kind : {PartKind::kLeg, PartKind::kArm}) {
      const Part* sure = nullptr;
      for (const Part& part : parts_) {
        const bool counts = part.kind == kind && part.upper && part.end && !part.joints.empty();
        if (counts && part.confidence >= kSure && (!sure || lengthOf(part) > lengthOf(*sure))) sure = &part;
      }
      if (!sure) continue;
      const double length = lengthOf(*sure), low = lowestOf(*sure);
      for (Part& part : parts_) {
        if (part.kind != kind || part.joints.empty() || part.confidence >= kDoubtful) continue;
        const bool isStanding = kind == PartKind::kLeg && lowestOf(part) < low + kOffTheGround * length;
        if (lengthOf(part) > kAsLong * length && (isStanding || kind == PartKind::kArm)) continue;
        part.kind = PartKind::kAttachment;
        for (std::optional<Index>* landmark : {&part.upper, &part.middle, &part.hock, &part.end, &part.toes})
          landmark->reset();
      }
    }
  }

  double lengthOf(const Part& part) const {
    double length = 0;
    for (std::size_t i = 1; i < part.joints.size(); ++i)
      length += (reading_.positions[part.joints[i]] - reading_.positions[part.joints[i - 1]]).norm();
    return length;
  }
  double lowestOf(const Part& part) const {
    double low = std::numeric_limits<double>::infinity();
    for (const Index joint : part.joints) low = std::min(low, labels_.axes.up.dot(reading_.positions[joint]));
    return low;
  }

  // Empties the one; what it carried hangs on the other.
  void moveInto(std::size_t from, std::size_t to) {
    Part &part = parts_[from], &whole = parts_[to];
    whole.joints.insert(whole.joints.end(), part.joints.begin(), part.joints.end());
    whole.branches.insert(whole.branches.end(), part.branches.begin(), part.branches.end());
    if (!whole.end) whole.end = part.end;
    if (!whole.toes) whole.toes = part.toes;
    whole.confidence = std::min(whole.confidence, part.confidence);
    part.joints.clear();
    part.branches.clear();
    for (Part& other : parts_) {
      if (other.carrier == from) other.carrier = to;
    }
    if (whole.carrier == to) whole.carrier.reset();
  }

  // Front to back; fingers by their names, where they have any.
  void number() {
    std::map<std::tuple<PartKind, Side, std::size_t>, std::vector<std::size_t>> groups;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Part& part = parts_[p];
      if (part.joints.empty()) continue;
      const std::size_t carrier = part.kind == PartKind::kFinger ? part.carrier.value_or(parts_.size()) : 0;
      groups[{part.kind, part.side, carrier}].push_back(p);
    }
    for (auto& [key, group] : groups) {
      const auto ahead = [&](std::size_t p) {
        const Part& part = parts_[p];
        return labels_.axes.front.dot(reading_.positions[part.upper.value_or(part.joints.front())]);
      };
      std::stable_sort(group.begin(), group.end(),
                       [&](std::size_t a, std::size_t b) { return ahead(a) > ahead(b) + 1e-9; });
      if (std::get<0>(key) == PartKind::kFinger && group.size() > 1 && parts_[group[0]].carrier) sortDigits(group);
      // One finger alone is all but the thumb.
      const Index first = isMitten(key, group) ? 1 : 0;
      for (std::size_t i = 0; i < group.size(); ++i) parts_[group[i]].pair = static_cast<Index>(i) + first;
      if (std::get<0>(key) != PartKind::kFinger || (!reading_.words.empty() && numberFingersByName(group))) continue;
      const double sure = group.size() == 5 ? kAllFingers : kSomeFingers;
      for (const std::size_t p : group) parts_[p].confidence = std::min(parts_[p].confidence, sure);
    }
  }

  bool isMitten(const std::tuple<PartKind, Side, std::size_t>& key, const std::vector<std::size_t>& group) const {
    const std::optional<std::size_t> carrier = parts_[group[0]].carrier;
    return std::get<0>(key) == PartKind::kFinger && group.size() == 1 && carrier &&
           parts_[*carrier].kind == PartKind::kArm;
  }

  // Across the hand, from the thumb. Toes from the inner side.
  void sortDigits(std::vector<std::size_t>& group) const {
    const Part& carrier = parts_[*parts_[group[0]].carrier];
    const Vec3 wrist = reading_.positions[carrier.end.value_or(carrier.joints.back())];
    const auto base = [&](std::size_t p) { return reading_.positions[parts_[p].joints.front()]; };
    const auto tip = [&](std::size_t p) { return reading_.positions[parts_[p].joints.back()]; };
    Vec3 along = Vec3::Zero();
    for (const std::size_t p : group) along += tip(p) - wrist;
    Vec3 across = Vec3::Zero();
    for (const std::size_t a : group) {
      for (const std::size_t b : group) {
        Vec3 apart = tip(b) - tip(a);
        if (along.norm() > 0) apart -= apart.dot(along) / along.squaredNorm() * along;
        if (apart.norm() > across.norm()) across = apart;
      }
    }
    std::stable_sort(group.begin(), group.end(),
                     [&](std::size_t a, std::size_t b) { return across.dot(tip(a)) < across.dot(tip(b)); });
    if (carrier.kind == PartKind::kLeg) {
      const auto aside = [&](std::size_t p) { return std::abs(reading_.body.lateral.dot(base(p))); };
      if (aside(group.back()) < aside(group.front())) std::reverse(group.begin(), group.end());
      return;
    }
    double hand = 1e-12;
    for (const std::size_t p : group) hand = std::max(hand, (tip(p) - wrist).norm());
    // In lengths of the hand, and radians: that it begins and ends nearer to the wrist, lies ahead, and points aside.
    const auto thumbLike = [&](std::size_t p) {
      Vec3 others = Vec3::Zero();
      for (const std::size_t other : group)
        others += other == p ? Vec3(Vec3::Zero()) : (tip(other) - base(other)).normalized();
      const Vec3 own = (tip(p) - base(p)).normalized();
      const double near = (base(p) - wrist).norm() + (tip(p) - wrist).norm();
      return std::atan2(own.cross(others).norm(), own.dot(others)) + (labels_.axes.front.dot(base(p)) - near) / hand;
    };
    if (thumbLike(group.back()) > thumbLike(group.front())) std::reverse(group.begin(), group.end());
  }

  // Those without a name take the numbers that are left, in their order. False where no finger has a name, or two have
  // the same.
  bool numberFingersByName(const std::vector<std::size_t>& group) {
    std::vector<std::optional<Index>> named;
    std::vector<Index> taken;
    for (const std::size_t p : group) {
      std::optional<Index> finger;
      for (const Index joint : parts_[p].joints) {
        if (!finger) finger = fingerOfWord(reading_.words[joint].word);
      }
      if (finger && std::find(taken.begin(), taken.end(), *finger) != taken.end()) return false;
      if (finger) taken.push_back(*finger);
      named.push_back(finger);
    }
    if (taken.empty()) return false;
    Index next = 0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      while (!named[i] && std::find(taken.begin(), taken.end(), next) != taken.end()) ++next;
      Part& finger = parts_[group[i]];
      finger.pair = named[i].value_or(next);
      if (named[i]) continue;
      taken.push_back(next);
      finger.confidence = std::min(finger.confidence, kSomeFingers);
    }
    return true;
  }

  // The trunk first, carriers before what they carry, else as they are found.
  void order() {
    std::vector<std::size_t> sorted(parts_.size()), indices(parts_.size());
    std::vector<Index> depth(parts_.size(), 0);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      sorted[p] = p;
      if (parts_[p].carrier && parts_[*parts_[p].carrier].joints.empty()) parts_[p].carrier.reset();
      std::size_t steps = 0;
      for (std::optional<std::size_t> up = parts_[p].carrier; up && steps < parts_.size(); up = parts_[*up].carrier)
        ++steps;
      depth[p] = static_cast<Index>(steps);
    }
    const auto rank = [&](std::size_t p) {
      return std::tuple(parts_[p].kind != PartKind::kTrunk || depth[p] > 0, depth[p], parts_[p].kind, parts_[p].pair,
                        parts_[p].side);
    };
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    std::size_t slots = 0;
    for (const std::size_t p : sorted) {
      indices[p] = slots;
      if (!parts_[p].joints.empty()) ++slots;
    }
    std::vector<Part> ordered;
    for (const std::size_t p : sorted) {
      if (parts_[p].joints.empty()) continue;
      ordered.push_back(std::move(parts_[p]));
      if (ordered.back().carrier) ordered.back().carrier = indices[*ordered.back().carrier];
    }
    parts_ = std::move(ordered);
  }

  const BodyReading& reading_;
  const LabelledBody& labels_;
  std::vector<Part> parts_;
  std::vector<Parts> partsOf_;                          // #half joints
  std::vector<std::vector<Index>> children_;            // likewise
  std::map<std::size_t, std::optional<Index>> lastOf_;  // of parts, the last half joint that was added
  std::vector<bool> isBranch_, hasHead_;                // likewise: off the part's own line; has a neck or head below
};

}  // namespace

std::vector<Part> partsOf(const BodyReading& reading, const LabelledBody& labels) {
  return PartMaker(reading, labels).make();
}

}  // namespace limber
