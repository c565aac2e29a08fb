#include "limber/character/matching/skeleton_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>

#include "limber/character/anatomy/body_pieces.h"
#include "limber/character/anatomy/names/joint_words.h"
#include "limber/character/matching/limb_groups.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/counted.h"
#include "limber/core/known_error.h"

namespace limber {

namespace {

struct MatchConfidence {
  // Matches; 2 to 5, 5 to 10; that are needed at least, with names for some of them and by form alone; set by hand.
  std::size_t fewNamed = 3, fewByForm = 7;
  // Confidences, 0 to 1: below kDoubtful they are listed as doubtful; set by hand.
  double equalTrees = 0.5;    // of joints that are matched by their number in equal trees alone
  double equalNames = 0.9;    // of names that are equal but for their case, separators and prefixes
  double oneOfSeveral = 0.5;  // at most, of one palm joint, or pelvis, of several
  double fingerByForm = 0.7;  // at most: form does not tell a finger's tip from its last bone
};
constexpr MatchConfidence kMatchConfidence;

std::string plainName(std::string_view name) {
  if (const std::size_t space = name.find_last_of(":|"); space != std::string_view::npos) name.remove_prefix(space + 1);
  std::string plain;
  for (const char c : name) {
    if (c != '_' && c != '.' && c != '-' && c != ' ')
      plain.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return plain;
}

bool sameTree(const Skeleton& a, const Skeleton& b) {
  return a.jointCount() == b.jointCount() &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(),
                    [](const Joint& one, const Joint& other) { return one.parent == other.parent; });
}

MatchedBy evidenceOf(const Part& one, const Part& other) {
  return one.evidence == Evidence::kForm || other.evidence == Evidence::kForm ? MatchedBy::kShape : MatchedBy::kName;
}

// "left hind leg", "hind legs" of both; numbered from the head on where there are more than two pairs.
std::string labelOfWhole(const Anatomy& anatomy, const BodyPart& part, bool both) {
  const bool isOfTwo = (part.kind == PartKind::kLeg || part.kind == PartKind::kArm) && anatomy.pairsOf(part.kind) == 2;
  std::string label;
  if (!both && part.side != Side::kCenter) label.append(nameOf(part.side)).append(" ");
  if (isOfTwo) label += part.pair == 0 ? "front " : "hind ";
  label.append(nameOf(part.kind)).append(both ? "s" : "");
  if (!isOfTwo && part.kind > PartKind::kTail && anatomy.pairsOf(part.kind) > 1)
    label += " " + std::to_string(part.pair + 1);
  return label;
}

class Matcher {
 public:
  Matcher(const SkeletonReading& source, const SkeletonReading& target, bool unlikeBodies, const Pose* sourcePose)
      : sourceReading_(source),
        targetReading_(target),
        given_(source.skeleton()),
        posed_(sourcePose ? std::optional(restingIn(given_, *sourcePose)) : std::nullopt),
        source_(posed_ ? *posed_ : given_),
        target_(target.skeleton()),
        unlikeBodies_(unlikeBodies),
        from_(posed_ ? BodyPieces(*posed_, AnatomyOptions{.names = true, .fixed = {}, .sidesByNames = true})
                     : source.pieces()),
        to_(target.pieces()),
        sourceTree_(source_),
        targetTree_(target_) {
    if (!standOnMany()) return;
    from_.cutLegsWhereTheyStand(source_);
    to_.cutLegsWhereTheyStand(target_);
  }
  // Its members point into each other.
  Matcher(const Matcher&) = delete;
  Matcher& operator=(const Matcher&) = delete;

  SkeletonMap match() {
    SkeletonMap map = matched();
    map.source = sourceReading_;
    map.target = targetReading_;
    return map;
  }

 private:
  SkeletonMap matched() {
    const std::vector<Index> sourceLine = from_.lineOfLimbless(source_), targetLine = to_.lineOfLimbless(target_);
    areLines_ = sourceLine.size() > 1 && targetLine.size() > 1;
    if (areLines_)
      matchLines(sourceLine, targetLine);
    else
      matchParts();
    if (std::optional<Twins> twins = matchTwins(given_, target_)) {
      matchTwinJoints(*twins);
      map_.jointByJoint = !map_.isBiped() || areAnimals();
      if (map_.jointByJoint) splitChains();
      map_.twins = std::move(twins);
      return std::move(map_);
    }
    if (unlikeBodies_) matchOtherKinds();
    map_.jointByJoint = standOtherwise() || map_.unlikeBodies || (areAnimals() && areFamily());
    if (!moves() && sameTree(source_, target_)) {
      map_ = {};
      for (Index j = 0; j < target_.jointCount(); ++j) addOther(j, j, kMatchConfidence.equalTrees, MatchedBy::kShape);
      return std::move(map_);
    }
    matchNamesakes();
    if (!moves()) refuse();
    if (map_.jointByJoint) splitChains();
    listUnmatched();
    return std::move(map_);
  }

  void add(const BodyPart& part, std::vector<Index> source, std::vector<Index> target, double confidence,
           MatchedBy by) {
    std::erase_if(target, [&](Index joint) { return matchedTarget_.count(joint) > 0; });
    if (source.empty() || target.empty()) return;
    for (const Index joint : target) matchedTarget_.emplace(joint, map_.matches.size());
    for (const Index joint : source) matchedSource_.emplace(joint, map_.matches.size());
    map_.matches.push_back({part, std::move(source), std::move(target), confidence, by});
  }

  void addOther(Index source, Index target, double confidence, MatchedBy by) {
    add({PartKind::kOther, Side::kCenter, 0, Segment::kWhole, target}, {source}, {target}, confidence, by);
  }

  void matchParts() {
    const double confidence = std::min(from_.centerConfidence, to_.centerConfidence);
    const Part *one = from_.anatomy.find(PartKind::kTrunk), *other = to_.anatomy.find(PartKind::kTrunk);
    const MatchedBy by = one && other ? evidenceOf(*one, *other) : MatchedBy::kShape;
    const bool isInferred = from_.pelvisIsInferred || to_.pelvisIsInferred;
    const double trunkConfidence = isInferred ? std::min(confidence, kMatchConfidence.oneOfSeveral) : confidence;
    if (from_.pelvis && to_.pelvis) add(body_part::kPelvis, {*from_.pelvis}, {*to_.pelvis}, trunkConfidence, by);
    add(body_part::kTrunk, from_.trunk, to_.trunk, trunkConfidence, by);
    add(body_part::kNeck, from_.neck, to_.neck, confidence, by);
    if (from_.head && to_.head) add(body_part::kHead, {*from_.head}, {*to_.head}, confidence, by);
    for (const LimbPieces& limb : to_.limbs) {
      const Part& part = *limb.part;
      // No two of them are the same thing.
      if (part.kind == PartKind::kProp || part.kind == PartKind::kHair || part.kind == PartKind::kAttachment) continue;
      // Legs are counted from behind where one body has more: those at the pelvis are alike.
      const Index more = part.kind == PartKind::kLeg ? from_.anatomy.pairsOf(PartKind::kLeg) : 0,
                  own = part.kind == PartKind::kLeg ? to_.anatomy.pairsOf(PartKind::kLeg) : 0;
      const LimbPieces* like =
          part.pair + more < own ? nullptr : from_.find(part.kind, part.side, part.pair + more - own);
      if (like && alikeCarried(*like, limb)) matchLimb(*like, limb);
    }
  }

  // Joints of snakes go by where they lie along the body: what is trunk or tail of it nobody can tell, and some hang on
  // the head, some on the tail.
  void matchLines(const std::vector<Index>& sourceLine, const std::vector<Index>& targetLine) {
    const auto alongOf = [](const Skeleton& skeleton, const std::vector<Index>& line) {
      const std::vector<Vec3> rest = restPositions(skeleton);
      std::vector<double> along = {0};
      for (std::size_t i = 1; i < line.size(); ++i)
        along.push_back(along.back() + (rest[line[i]] - rest[line[i - 1]]).norm());
      if (along.back() > 0) {
        for (double& each : along) each /= along.back();
      }
      return along;
    };
    const std::vector<double> others = alongOf(source_, sourceLine), own = alongOf(target_, targetLine);
    const auto carrier = std::min_element(targetLine.begin(), targetLine.end(), [&](Index a, Index b) {
      return targetTree_.depth(a) < targetTree_.depth(b);
    });
    const std::vector<std::vector<Index>> from = groupedAlong(sourceLine, others, own),
                                          to = groupedAlong(targetLine, own, others);
    const double confidence = std::min(from_.centerConfidence, to_.centerConfidence);
    BodyPart piece = body_part::kTrunk;
    for (std::size_t i = 0; i < to.size(); ++i) {
      const bool carries = std::find(to[i].begin(), to[i].end(), *carrier) != to[i].end();
      const bool isHead = i == 0 && from_.head && to_.head;
      add(carries  ? body_part::kPelvis
          : isHead ? body_part::kHead
                   : piece,
          from[i], to[i], confidence, MatchedBy::kShape);
      if (!carries && !isHead) ++piece.piece;
    }
    for (const LimbPieces& part : to_.limbs) {
      const LimbPieces* like = from_.find(part.part->kind, part.part->side, part.part->pair);
      if (like && part.part->kind == PartKind::kJaw) matchLimb(*like, part);
    }
  }

  // Two limbs of one kind that lie opposite each other, or one alone.
  struct LimbPair {
    PartKind kind;
    Index pair;
    double along;  // from the pelvis towards the head
    bool taken = false;
  };

  // From front to back.
  static std::vector<LimbPair> limbPairs(const BodyPieces& body, const Skeleton& skeleton) {
    const std::vector<Vec3> rest = restPositions(skeleton);
    const Index front = body.head ? *body.head : body.trunk.empty() ? *body.pelvis : body.trunk.back();
    Vec3 axis = rest[front] - rest[*body.pelvis];
    if (axis.isZero()) axis = body.anatomy.axes.front;
    std::vector<LimbPair> pairs;
    for (const LimbPieces& limb : body.limbs) {
      const PartKind kind = limb.part->kind;
      const bool isLimb =
          kind == PartKind::kLeg || kind == PartKind::kArm || kind == PartKind::kWing || kind == PartKind::kFin;
      const bool known = std::any_of(pairs.begin(), pairs.end(), [&](const LimbPair& other) {
        return other.kind == kind && other.pair == limb.part->pair;
      });
      if (!isLimb || known || limb.part->side == Side::kCenter) continue;
      pairs.push_back({kind, limb.part->pair, axis.dot(rest[limb.joints.front()])});
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const LimbPair& a, const LimbPair& b) { return a.along > b.along; });
    return pairs;
  }

  // Each pair of limbs that has no partner yet follows the one that is nearest along the body, of those that nothing
  // follows yet, if there is one.
  void matchOtherKinds() {
    if (!from_.pelvis || !to_.pelvis) return;
    std::vector<LimbPair> sources = limbPairs(from_, source_);
    const std::vector<LimbPair> targets = limbPairs(to_, target_);
    const auto isMatched = [](const BodyPieces& body, const LimbPair& pair, const auto& matched) {
      return std::any_of(body.limbs.begin(), body.limbs.end(), [&](const LimbPieces& limb) {
        return limb.part->kind == pair.kind && limb.part->pair == pair.pair &&
               std::any_of(limb.joints.begin(), limb.joints.end(),
                           [&](Index joint) { return matched.count(joint) > 0; });
      });
    };
    for (LimbPair& pair : sources) pair.taken = isMatched(from_, pair, matchedSource_);
    const auto fractionOf = [](std::size_t index, std::size_t count) {
      return count > 1 ? static_cast<double>(index) / static_cast<double>(count - 1) : 0.5;
    };
    for (std::size_t t = 0; t < targets.size(); ++t) {
      if (isMatched(to_, targets[t], matchedTarget_)) continue;
      const auto cost = [&](const LimbPair& pair) {
        const auto s = static_cast<std::size_t>(&pair - sources.data());
        return std::abs(fractionOf(s, sources.size()) - fractionOf(t, targets.size())) + (pair.taken ? 1 : 0);
      };
      const auto best = std::min_element(sources.begin(), sources.end(),
                                         [&](const LimbPair& a, const LimbPair& b) { return cost(a) < cost(b); });
      if (best == sources.end()) return;
      best->taken = true;
      for (const LimbPieces& limb : to_.limbs) {
        if (limb.part->kind != targets[t].kind || limb.part->pair != targets[t].pair) continue;
        const LimbPieces* like = from_.find(best->kind, limb.part->side, best->pair);
        if (!like) continue;
        map_.unlikeBodies = true;
        matchLimb(*like, limb);
      }
    }
  }

  // Fingers of a hand and toes of a foot have one kind.
  bool alikeCarried(const LimbPieces& one, const LimbPieces& other) const {
    if (one.part->kind != PartKind::kFinger) return true;
    const auto carrier = [](const Anatomy& anatomy, const Part& part) {
      return part.carrier ? anatomy.parts[*part.carrier].kind : PartKind::kOther;
    };
    return carrier(from_.anatomy, *one.part) == carrier(to_.anatomy, *other.part);
  }

  void matchLimb(const LimbPieces& source, const LimbPieces& target) {
    const Part& part = *target.part;
    const double confidence = std::min(source.part->confidence, part.confidence);
    const MatchedBy by = evidenceOf(*source.part, part);
    BodyPart piece{part.kind, part.side, part.pair, Segment::kWhole, 0};
    if (part.kind == PartKind::kFinger) {
      const std::size_t begin = std::max(source.firstPiece, target.firstPiece),
                        end = std::min(source.firstPiece + source.joints.size(),
                                       target.firstPiece + target.joints.size());
      for (std::size_t i = begin; i < end; ++i) {
        piece.piece = static_cast<Index>(i);
        add(piece, {source.joints[i - source.firstPiece]}, {target.joints[i - target.firstPiece]},
            by == MatchedBy::kShape ? std::min(confidence, kMatchConfidence.fingerByForm) : confidence, by);
      }
      return;
    }
    if (part.kind == PartKind::kTail || part.kind == PartKind::kJaw)
      return add(piece, source.joints, target.joints, confidence, by);
    const std::vector<std::pair<Segment, std::pair<std::size_t, std::size_t>>> common = commonMarks(source, target);
    if (common.empty()) return matchAlong(piece, source, target, confidence, by);
    for (std::size_t m = 0; m < common.size(); ++m) {
      const auto [segment, begins] = common[m];
      const bool last = m + 1 == common.size();
      std::vector<Index> from(source.joints.begin() + static_cast<std::ptrdiff_t>(begins.first), source.joints.end()),
          to(target.joints.begin() + static_cast<std::ptrdiff_t>(begins.second), target.joints.end());
      // What goes on after the last landmark of both are tips, or what one of them has no word for.
      const bool isStanding = standOnMany() && part.kind == PartKind::kLeg;
      if (!last || !isStanding || segment != Segment::kToes) {
        from.resize(last ? 1 : common[m + 1].second.first - begins.first);
        to.resize(last ? 1 : common[m + 1].second.second - begins.second);
      }
      if (!last) {
        keepAbove(sourceTree_, source.joints[common[m + 1].second.first], from);
        keepAbove(targetTree_, target.joints[common[m + 1].second.second], to);
      }
      if (isStanding && segment == Segment::kUpper && !last) {
        const std::size_t sourceEnd = common[m + 1].second.first, targetEnd = common[m + 1].second.second;
        matchBones(piece, {source, begins.first, sourceEnd}, {target, begins.second, targetEnd}, confidence, by);
        continue;
      }
      if (segment == Segment::kToes &&
          !(toesTell(source_, from_, source, begins.first) && toesTell(target_, to_, target, begins.second)))
        continue;
      if (segment == Segment::kBase && part.kind == PartKind::kLeg && !alikeBases(from, to, common, source, target))
        continue;
      piece.segment = segment;
      const bool isInferred =
          segment == Segment::kEnd && (isOneOfSeveral(sourceTree_, *source.part) || isOneOfSeveral(targetTree_, part));
      add(piece, std::move(from), std::move(to),
          isInferred ? std::min(confidence, kMatchConfidence.oneOfSeveral) : confidence, by);
    }
  }

  // Not the end of a foot's bone, that never turns; nor where one foot is raised at rest, as in a file that begins in
  // the middle of a step: its rest orientation is then unknown.
  bool toesTell(const Skeleton& skeleton, const BodyPieces& body, const LimbPieces& leg, std::size_t toes) const {
    // Body sizes; 0.003 to 0.015; measured: feet of shared bodies that stand differ by 0.002 at most, others by 0.02.
    constexpr double kRaised = 0.006;
    const bool isEnd = toes + 1 == leg.joints.size() &&
                       readJointWords(readNameOf(skeleton.joints[leg.joints[toes]])).has(NameMark::kEnd);
    if (isEnd || standOnMany()) return !isEnd;
    if (posed_ && &skeleton == &source_) return true;  // a frame of the motion, in which feet are raised as it goes
    const std::vector<Vec3> rest = restPositions(skeleton);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Side side : kSides) {
      const Part* each = body.anatomy.find(PartKind::kLeg, side, leg.part->pair);
      if (!each || !each->toes) continue;
      const double height = body.anatomy.axes.up.dot(rest[*each->toes]);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low < kRaised * body.anatomy.size;
  }

  // Of a hand whose palm has several joints beside each other one has to stand for all.
  static bool isOneOfSeveral(const JointTree& tree, const Part& part) {
    return part.end && std::any_of(part.branches.begin(), part.branches.end(),
                                   [&](Index joint) { return tree.parent(joint) == tree.parent(*part.end); });
  }

  bool standOnMany() const {
    return from_.anatomy.pairsOf(PartKind::kLeg) > 1 && to_.anatomy.pairsOf(PartKind::kLeg) > 1;
  }
  bool areAnimals() const { return from_.isAnimal() && to_.isAnimal(); }

  // Of what lies between two landmarks the joints on which the next one hangs; all where it is on a root of its own.
  static void keepAbove(const JointTree& tree, Index next, std::vector<Index>& joints) {
    if (!tree.isAboveOrSelf(joints.front(), next)) return joints.resize(1);
    std::erase_if(joints, [&](Index joint) { return !tree.isAboveOrSelf(joint, next); });
  }

  // The bones of legs between hip and foot, by where they lie along them.
  struct Bones {
    const LimbPieces& limb;
    std::size_t begin, end;
    std::span<const Index> joints() const { return std::span(limb.joints).subspan(begin, end - begin); }
    std::vector<double> along() const {
      std::vector<double> positions;
      const double length = limb.along[end] - limb.along[begin];
      for (std::size_t i = begin; i < end; ++i)
        positions.push_back(length > 0 ? (limb.along[i] - limb.along[begin]) / length : 0);
      return positions;
    }
  };
  void matchBones(BodyPart piece, const Bones& source, const Bones& target, double confidence, MatchedBy by) {
    const std::vector<double> own = target.along(), others = source.along();
    const std::vector<std::vector<Index>> from = groupedAlong(source.joints(), others, own),
                                          to = groupedAlong(target.joints(), own, others);
    constexpr std::array kSegments = {Segment::kUpper, Segment::kMiddle, Segment::kHock};
    for (std::size_t i = 0; i < to.size(); ++i) {
      piece.segment = kSegments[std::min<std::size_t>(i, 2)];
      piece.piece = i > 2 ? static_cast<Index>(i - 2) : 0;
      add(piece, from[i], to[i], confidence, by);
    }
  }

  // Hip bones of people carry nothing of their own; blades that lie otherwise would take the legs elsewhere.
  bool alikeBases(const std::vector<Index>& from, const std::vector<Index>& to, const auto& common,
                  const LimbPieces& source, const LimbPieces& target) const {
    // Cosine; 0.8 to 0.97; between where they point, seen from where each faces: 26 degrees; set by hand.
    constexpr double kAlikeBases = 0.9;
    if (from_.anatomy.pairsOf(PartKind::kLeg) < 2 || to_.anatomy.pairsOf(PartKind::kLeg) < 2 || common.size() < 2)
      return false;
    const auto directionOf = [](const Skeleton& skeleton, const Anatomy& anatomy, Index begin, Index end) {
      const std::vector<Vec3> rest = restPositions(skeleton);
      const Vec3 displacement = (rest[end] - rest[begin]).normalized();
      return Vec3(anatomy.axes.left().dot(displacement), anatomy.axes.up.dot(displacement),
                  anatomy.axes.front.dot(displacement));
    };
    const auto& next = common[1].second;
    return directionOf(source_, from_.anatomy, from.front(), source.joints[next.first])
               .dot(directionOf(target_, to_.anatomy, to.front(), target.joints[next.second])) > kAlikeBases;
  }

  static std::vector<std::pair<Segment, std::pair<std::size_t, std::size_t>>> commonMarks(const LimbPieces& source,
                                                                                          const LimbPieces& target) {
    std::vector<std::pair<Segment, std::pair<std::size_t, std::size_t>>> common;
    for (const auto& [segment, begin] : target.marks) {
      for (const auto& [other, otherBegin] : source.marks) {
        if (segment == other &&
            (common.empty() || (begin > common.back().second.second && otherBegin > common.back().second.first))) {
          common.push_back({segment, {otherBegin, begin}});
        }
      }
    }
    return common;
  }

  void matchAlong(BodyPart piece, const LimbPieces& source, const LimbPieces& target, double confidence, MatchedBy by) {
    const std::vector<std::vector<Index>> from = groupedAlong(source.joints, source.along, target.along),
                                          to = groupedAlong(target.joints, target.along, source.along);
    for (std::size_t i = 0; i < to.size(); ++i) {
      piece.piece = static_cast<Index>(i);
      add(piece, from[i], to[i], confidence, by);
    }
  }

  void matchTwinJoints(const Twins& twins) {
    // Each joint by itself, under the part's name where it begins one.
    std::vector<JointMatch> parts = std::move(map_.matches);
    map_.matches.clear();
    matchedTarget_.clear();
    matchedSource_.clear();
    for (const Index joint : targetTree_.order()) {
      const auto begins = std::find_if(parts.begin(), parts.end(),
                                       [&](const JointMatch& match) { return match.target.front() == joint; });
      const Index own = twins.sourceOf[joint];
      if (begins != parts.end()) {
        std::vector<Index> sources;
        for (const Index each : begins->target) sources.push_back(twins.sourceOf[each]);
        add(begins->part, std::move(sources), begins->target, 1, MatchedBy::kShape);
      } else if (matchedTarget_.count(joint) == 0) {
        addOther(own, joint, 1, MatchedBy::kShape);
      }
    }
  }

  // What one family has besides, where it hangs on the same part: hair, props, skirts, face bones.
  void matchNamesakes() {
    std::map<std::string, Index> byName;
    for (Index j = 0; j < source_.jointCount(); ++j) byName.emplace(plainName(source_.joints[j].name), j);
    for (const Index joint : targetTree_.order()) {
      if (matchedTarget_.count(joint) > 0) continue;
      const auto found = byName.find(plainName(target_.joints[joint].name));
      if (found == byName.end() || matchedSource_.count(found->second) > 0) continue;
      const std::optional<std::size_t> above = matchAbove(targetTree_, matchedTarget_, joint);
      if ((!above && !map_.jointByJoint) || above != matchAbove(sourceTree_, matchedSource_, found->second)) continue;
      const bool same = source_.joints[found->second].name == target_.joints[joint].name;
      addOther(found->second, joint, same ? 1 : kMatchConfidence.equalNames, MatchedBy::kName);
    }
  }

  static std::optional<std::size_t> matchAbove(const JointTree& tree, const std::map<Index, std::size_t>& matched,
                                               Index joint) {
    for (std::optional<Index> up = tree.parent(joint); up; up = tree.parent(*up)) {
      if (const auto found = matched.find(*up); found != matched.end()) return found->second;
    }
    return std::nullopt;
  }

  // The body itself, and something that hangs on it: hips and a head move nothing.
  bool moves() const {
    if (areLines_) return map_.matches.size() >= kMatchConfidence.fewNamed;
    const auto both = [&](PartKind kind) {
      return std::any_of(map_.matches.begin(), map_.matches.end(),
                         [&](const JointMatch& match) { return match.part.kind == kind; });
    };
    const bool limbs = both(PartKind::kLeg) || both(PartKind::kArm) || both(PartKind::kWing) || both(PartKind::kFin);
    const Index one = from_.anatomy.pairsOf(PartKind::kLeg), other = to_.anatomy.pairsOf(PartKind::kLeg);
    const bool standAlike =
        map_.unlikeBodies || one == other ||
        (one > 0 && other > 0 && std::max(one, other) == std::min(one, other) + 1 && both(PartKind::kWing));
    // Names are believed of a few joints, where these are most of the skeleton; form needs more to be seen as a body.
    const auto named =
        static_cast<std::size_t>(std::count_if(map_.matches.begin(), map_.matches.end(),
                                               [](const JointMatch& match) { return match.by == MatchedBy::kName; }));
    const bool mostlyNamed =
        named >= kMatchConfidence.fewNamed && 2 * named >= std::min(source_.jointCount(), target_.jointCount());
    const bool hasForm = map_.matches.size() >= (named > 0 ? kMatchConfidence.fewNamed : kMatchConfidence.fewByForm);
    return map_.find(body_part::kPelvis) && (mostlyNamed || ((limbs || both(PartKind::kTail)) && hasForm)) &&
           standAlike;
  }

  bool standOtherwise() const { return from_.anatomy.pairsOf(PartKind::kLeg) != to_.anatomy.pairsOf(PartKind::kLeg); }

  // Most joints of the smaller one have the same name, and hang on joints of the same name.
  bool areFamily() const {
    constexpr double kMaxNames = 0.6;  // fraction of the smaller one's joints; 0.5 to 0.9; set by hand
    const auto keyOf = [](const Skeleton& skeleton, Index joint) {
      const std::optional<Index>& parent = skeleton.joints[joint].parent;
      return plainName(skeleton.joints[joint].name) + '/' + (parent ? plainName(skeleton.joints[*parent].name) : "");
    };
    std::set<std::string> names;
    for (Index j = 0; j < source_.jointCount(); ++j) names.insert(keyOf(source_, j));
    std::size_t common = 0;
    for (Index j = 0; j < target_.jointCount(); ++j) common += names.count(keyOf(target_, j));
    return static_cast<double>(common) >
           kMaxNames * static_cast<double>(std::min(source_.jointCount(), target_.jointCount()));
  }

  // Chains of as many joints in both, joint by joint: each may move by itself.
  void splitChains() {
    std::vector<JointMatch> split;
    for (JointMatch& match : map_.matches) {
      if (match.source.size() != match.target.size() || match.source.size() < 2) {
        split.push_back(std::move(match));
        continue;
      }
      for (std::size_t i = 0; i < match.source.size(); ++i) {
        BodyPart part = match.part;
        part.piece += static_cast<Index>(i);
        const bool taken = i > 0 && (map_.find(part) || part.kind == PartKind::kOther);
        if (taken) part = {PartKind::kOther, Side::kCenter, 0, Segment::kWhole, match.target[i]};
        split.push_back({part, {match.source[i]}, {match.target[i]}, match.confidence, match.by});
      }
    }
    const std::span<const Index> order = targetTree_.order();
    std::vector<std::size_t> index(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) index[order[i]] = i;
    std::stable_sort(split.begin(), split.end(), [&](const JointMatch& a, const JointMatch& b) {
      return index[a.target.front()] < index[b.target.front()];
    });
    map_.matches = std::move(split);
  }

  void listUnmatched() {
    for (const bool ofTarget : {false, true}) {
      const BodyPieces& body = ofTarget ? to_ : from_;
      const JointTree& tree = ofTarget ? targetTree_ : sourceTree_;
      const auto& matched = ofTarget ? matchedTarget_ : matchedSource_;
      for (const Part& part : body.anatomy.parts) {
        if (part.kind == PartKind::kAttachment) continue;  // it moves with what it is attached to
        std::vector<Index> joints;
        for (const Index joint : part.joints) {
          if (matched.count(joint) == 0) joints.push_back(joint);
        }
        if (joints.size() < part.joints.size() || joints.empty()) continue;
        UnmatchedPart unmatched{{part.kind, part.side, part.pair, Segment::kWhole, 0}, ofTarget, joints, {}};
        const std::optional<std::size_t> above = matchAbove(tree, matched, joints.front());
        if (ofTarget && above) unmatched.carrier = map_.matches[*above].part;
        map_.left.push_back(std::move(unmatched));
      }
    }
  }

  [[noreturn]] void refuse() {
    listUnmatched();
    throw KnownError(
        ErrorKind::kUnlikeBodies,
        {ErrorCode::kUnsupported,
         fmt::format(
             "the motion's skeleton of {} and the character's of {} have too little in common to be matched: {}",
             counted(source_.jointCount(), "joint"), target_.jointCount(), whatDiffers()),
         "",
         unlikeBodiesMatch() ? "--unlike-bodies lets limbs follow others"
                             : "--map FILE says which joint follows which, as docs/retargeting.md tells"},
        {{"source", fmt::to_string(source_.jointCount())}, {"target", fmt::to_string(target_.jointCount())}});
  }

  bool unlikeBodiesMatch() const {
    if (unlikeBodies_) return false;
    try {
      Matcher(source_, target_, true, nullptr).match();  // `source_` rests in the pose already
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  // "left hind leg, arms and tail": the larger parts of one body that have no partner in the other.
  std::string unmatchedParts(bool ofTarget) const {
    const Anatomy& anatomy = (ofTarget ? to_ : from_).anatomy;
    const auto isUnmatched = [&](const BodyPart& part) {
      return std::any_of(map_.left.begin(), map_.left.end(),
                         [&](const UnmatchedPart& each) { return each.ofTarget == ofTarget && each.part == part; });
    };
    std::vector<std::string> labels;
    for (const UnmatchedPart& each : map_.left) {
      if (each.ofTarget != ofTarget || each.part.kind > PartKind::kFin) continue;  // fingers and smaller
      BodyPart mirrored = each.part;
      mirrored.side = opposite(each.part.side);
      const bool isPair = each.part.side != Side::kCenter && isUnmatched(mirrored);
      if (isPair && each.part.side == Side::kRight) continue;
      labels.push_back(labelOfWhole(anatomy, each.part, isPair));
    }
    std::string text;
    for (std::size_t i = 0; i < labels.size(); ++i)
      text += (i == 0 ? "" : i + 1 < labels.size() ? ", " : " and ") + labels[i];
    return text;
  }

  std::string whatDiffers() const {
    const std::string source = unmatchedParts(false), target = unmatchedParts(true);
    if (source.empty() && target.empty()) return whatIsSeen();
    const std::string ofSource = fmt::format("nothing in the character is like the motion's {}", source),
                      ofTarget = fmt::format("nothing in the motion is like the character's {}", target);
    return source.empty() ? ofTarget : target.empty() ? ofSource : ofSource + ", and " + ofTarget;
  }

  std::string whatIsSeen() const {
    const auto seen = [](const Anatomy& anatomy) {
      std::string text;
      for (const PartKind kind : {PartKind::kLeg, PartKind::kArm, PartKind::kWing, PartKind::kFin}) {
        const Index pairs = anatomy.pairsOf(kind);
        if (pairs > 0)
          text += (text.empty() ? "" : ", ") +
                  counted(pairs, fmt::format("pair of {}s", nameOf(kind)), fmt::format("pairs of {}s", nameOf(kind)));
      }
      if (anatomy.find(PartKind::kTail)) text += std::string(text.empty() ? "" : ", ") + "a tail";
      if (text.empty()) text = anatomy.find(PartKind::kTrunk) ? "a trunk without limbs" : "no body";
      return text;
    };
    return fmt::format("the motion's joints show {}, the character's {}", seen(from_.anatomy), seen(to_.anatomy));
  }

  const SkeletonReading sourceReading_, targetReading_;
  const Skeleton& given_;                // the source in its own rest pose
  const std::optional<Skeleton> posed_;  // and in the pose that it is read in, if another is given
  const Skeleton &source_, &target_;     // as they are read
  bool unlikeBodies_, areLines_ = false;
  BodyPieces from_, to_;
  JointTree sourceTree_, targetTree_;
  SkeletonMap map_;
  std::map<Index, std::size_t> matchedTarget_, matchedSource_;  // joint, its match
};

}  // namespace

const JointMatch* SkeletonMap::find(const BodyPart& part) const {
  const auto found =
      std::find_if(matches.begin(), matches.end(), [&](const JointMatch& match) { return match.part == part; });
  return found == matches.end() ? nullptr : &*found;
}

bool SkeletonMap::isBiped() const {
  const bool hasOthers = std::any_of(matches.begin(), matches.end(), [](const JointMatch& match) {
    return (match.part.kind == PartKind::kLeg && match.part.pair > 0) || match.part.kind == PartKind::kWing;
  });
  return !jointByJoint && !hasOthers && find(body_part::kPelvis) &&
         find(body_part::leg(Side::kLeft, Segment::kUpper)) && find(body_part::leg(Side::kRight, Segment::kUpper));
}

bool SkeletonMap::isQuadruped() const {
  return !jointByJoint && find(body_part::kPelvis) && find(body_part::leg(Side::kLeft, Segment::kUpper, 1)) &&
         find(body_part::leg(Side::kLeft, Segment::kUpper, 0)) &&
         !find(body_part::leg(Side::kLeft, Segment::kUpper, 2));
}

std::string nameOf(const JointMatch& match, const Skeleton& target) {
  if (match.part.kind != PartKind::kOther) return nameOf(match.part);
  const std::string& name = target.joints[match.target.front()].name;
  return bodyPartNamed(name) ? "joint " + name : name;  // "jaw" would be read as that part of the body
}

SkeletonMap matchSkeletons(const SkeletonReading& source, const SkeletonReading& target, bool unlikeBodies,
                           const Pose* sourcePose) {
  return Matcher(source, target, unlikeBodies, sourcePose).match();
}

void checkSkeletonMap(const SkeletonMap& map, const Skeleton& source, const Skeleton& target) {
  std::set<Index> moved;
  std::set<BodyPart> parts;
  if (map.matches.empty()) {
    throw KnownError(ErrorKind::kNothingMatched, {ErrorCode::kBadData, "the map matches nothing"});
  }
  for (const JointMatch& match : map.matches) {
    const std::string part = nameOf(match.part);
    const auto refuse = [&](const std::string& what) { throw Error(ErrorCode::kBadData, what, part); };
    const auto refuseKnown = [&](ErrorKind kind, const std::string& what, const std::string& joint = {}) {
      throw KnownError(kind, {ErrorCode::kBadData, what, part}, {{"part", part}, {"joint", joint}});
    };
    if (match.source.empty() || match.target.empty()) {
      refuseKnown(ErrorKind::kMatchWithoutJoint, "has no joint on one side");
    }
    if (!parts.insert(match.part).second) refuseKnown(ErrorKind::kMatchedTwice, "is matched twice");
    for (const Index joint : match.source) {
      if (joint >= source.jointCount()) refuse("names a joint that the motion does not have");
    }
    for (const Index joint : match.target) {
      if (joint >= target.jointCount()) refuse("names a joint that the character does not have");
      if (moved.insert(joint).second) continue;
      const std::string& name = target.joints[joint].name;
      refuseKnown(ErrorKind::kJointMatchedTwice, fmt::format("moves '{}' a second time", name), name);
    }
  }
}

}  // namespace limber
