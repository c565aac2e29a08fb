#include "limber/matching/body_plan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/matching/limb_groups.h"
#include "limber/matching/loose_feet.h"

namespace limber {

namespace {

constexpr double kByForm = 0.6, kByFormAndWord = 0.8;  // confidence
constexpr double kMiddle = 0.03;   // of the skeleton's size: joints this near to the plane of symmetry lie in it
constexpr double kClearly = 1.2;   // times as many
constexpr double kMirrored = 0.1;  // of the spine's length: how far left and right may be off being mirror images
constexpr double kShort = 0.5;     // of the longest limb on the same joint: shorter ones are feathers, say
constexpr double kTail = 0.15;     // of the skeleton's size: how far its end is from where the trunk begins, at least
constexpr double kLow = 0.15;      // of the skeleton's height: over the lowest joint
constexpr double kUnlike = 1;      // between two limbs of which no word tells the kind
constexpr double kSameWay = 0.9;   // cosine between where the two face, at least
constexpr std::size_t kMostJoints = 1000;  // of a body: finding mirror images takes each with each

using Joints = std::vector<Index>;  // root to tip

enum class LimbKind { kUnknown, kWing, kFin, kLeg };

// Two limbs that are mirror images.
struct MirroredLimb {
  Joints left, right;
  LimbKind kind = LimbKind::kUnknown;
  // Of the left one, forward, up and to the left: where it begins, in lengths of the spine, and which way it points.
  Vec3 base = Vec3::Zero(), way = Vec3::Zero();
};

struct BodyPlan {
  Index middle = 0;
  Joints trunk, tail;
  std::vector<MirroredLimb> limbs;
  Vec3 forward = Vec3::Zero();
  bool leavesFeetBehind = false;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

class BodyPlanReader {
 public:
  explicit BodyPlanReader(const Skeleton& skeleton) {
    for (const Affine& global : restGlobals(skeleton)) positions_.push_back(global.translation());
    for (const Joint& joint : skeleton.joints) names_.push_back(lower(joint.name));
    parents_ = parentsWithLegsJoined(skeleton, positions_);
    children_.resize(parents_.size());
    for (Index j = 0; j < parents_.size(); ++j) {
      if (parents_[j]) children_[*parents_[j]].push_back(j);
      box_.add(positions_[j]);
    }
  }

  std::optional<BodyPlan> read() {
    if (parents_.size() < 3 || parents_.size() > kMostJoints || !(box_.diagonal() > 0)) return std::nullopt;
    findPlane();
    const std::optional<Index> head = headJoint();
    if (!head) return std::nullopt;
    const std::optional<Index> tail = tailEnd(*head);
    BodyPlan plan;
    plan.middle = tail ? meeting(*head, *tail) : carrierOf(*head);
    if (tail) plan.tail = pathBelow(plan.middle, *tail);
    if (plan.middle == *head) plan.middle = *parents_[*head];  // that the whole body hangs on
    plan.trunk = pathBelow(plan.middle, *head);
    face(tail ? Vec3(at(*head) - at(*tail)) : wayOfHead(*head), plan);
    findLimbs(*head, plan);
    return plan;
  }

 private:
  const Vec3& at(Index joint) const { return positions_[joint]; }
  double aside(Index joint) const { return at(joint)[lateral_] - center_; }
  bool isMiddle(Index joint) const { return std::abs(aside(joint)) < kMiddle * size_; }

  bool isBelow(Index joint, Index above) const {
    std::optional<Index> up = joint;
    while (up && *up != above) up = parents_[*up];
    return up.has_value();
  }
  Index meeting(Index one, Index other) const {
    Index up = one;
    while (!isBelow(other, up)) up = *parents_[up];
    return up;
  }
  bool meet(Index one, Index other) const { return rootOf(one) == rootOf(other); }
  Index rootOf(Index joint) const {
    while (parents_[joint]) joint = *parents_[joint];
    return joint;
  }
  Joints pathBelow(Index above, Index joint) const {
    Joints path;
    for (Index j = joint; j != above; j = *parents_[j]) path.push_back(j);
    std::reverse(path.begin(), path.end());
    return path;
  }

  // The plane of symmetry: across X, or across Z where clearly more joints have a mirror image along that.
  void findPlane() {
    double most = 0;
    for (const Eigen::Index axis : {0, 2}) {
      double center = 0;
      for (const Vec3& position : positions_) center += position[axis] / static_cast<double>(positions_.size());
      const auto mirrored = std::count_if(positions_.begin(), positions_.end(), [&](const Vec3& position) {
        Vec3 image = position;
        image[axis] = 2 * center - image[axis];
        return std::any_of(positions_.begin(), positions_.end(),
                           [&](const Vec3& other) { return (other - image).norm() < kMiddle * box_.diagonal(); });
      });
      if (static_cast<double>(mirrored) <= most) continue;
      most = kClearly * static_cast<double>(mirrored);
      lateral_ = axis;
      center_ = center;
    }
    size_ = std::hypot(box_.size()[2 - lateral_], box_.size().y());  // however wide wings are
  }

  // The joint of that name, else the foremost end in the middle.
  std::optional<Index> headJoint() const {
    std::optional<Index> front;
    for (Index j = 0; j < parents_.size(); ++j) {
      if (!isMiddle(j)) continue;
      if (parents_[j] && names_[j].find("head") != std::string::npos) return j;
      if (parents_[j] && (!front || at(j)[2 - lateral_] > at(*front)[2 - lateral_])) front = j;
    }
    return front;
  }

  // The end in the middle that is farthest from the head, those of joints called tail first.
  std::optional<Index> tailEnd(Index head) const {
    std::optional<Index> end;
    std::pair<bool, double> best = {false, kTail * size_};
    for (Index j = 0; j < parents_.size(); ++j) {
      if (!children_[j].empty() || !isMiddle(j) || !meet(j, head)) continue;
      const bool isTail = names_[j].find("tail") != std::string::npos;
      const Index begin = meeting(j, head);
      if (begin == j || (!isTail && (begin == head || *parents_[j] == begin))) continue;  // a nose, a helper
      const std::pair<bool, double> far = {isTail, (at(j) - at(begin)).norm()};
      if (far <= best) continue;
      best = far;
      end = j;
    }
    return end;
  }

  // The lowest joint that the head and all limbs hang on.
  Index carrierOf(Index head) const {
    Index carrier = *parents_[head];
    for (Index j = 0; j < parents_.size(); ++j) {
      const bool isOfLimb = !isMiddle(j) && !isBelow(j, head) && meet(j, head);
      if (isOfLimb && isMiddle(parents_[j].value_or(j)) && !children_[j].empty()) carrier = meeting(carrier, j);
    }
    return carrier;
  }

  // From the joint that it hangs on to its farthest end.
  Vec3 wayOfHead(Index head) const {
    const Vec3& from = at(*parents_[head]);
    Index end = head;
    for (Index j = 0; j < parents_.size(); ++j) {
      if (isMiddle(j) && isBelow(j, head) && (at(j) - from).norm() > (at(end) - from).norm()) end = j;
    }
    return at(end) - from;
  }

  void face(const Vec3& way, BodyPlan& plan) {
    plan.forward = Vec3::Unit(2 - lateral_);
    if (way[2 - lateral_] < 0) plan.forward = -plan.forward;
    left_ = Vec3::UnitY().cross(plan.forward);
    spine_ = 0;
    for (const Joints& chain : {plan.trunk, plan.tail}) {
      for (const Index joint : chain) spine_ += (at(joint) - at(*parents_[joint])).norm();
    }
  }

  // What begins beside the middle, with the joints above that carry nothing else.
  Joints limbAt(Index joint, const BodyPlan& plan) const {
    Index end = joint;
    for (Index j = 0; j < parents_.size(); ++j) {
      const bool farther = (at(j) - at(joint)).norm() > (at(end) - at(joint)).norm();
      if (children_[j].empty() && isBelow(j, joint) && farther) end = j;
    }
    Joints limb = pathBelow(joint, end);
    limb.insert(limb.begin(), joint);
    while (parents_[limb.front()] && children_[*parents_[limb.front()]].size() == 1) {
      const Index above = *parents_[limb.front()];
      const auto isIn = [&](const Joints& chain) {
        return std::find(chain.begin(), chain.end(), above) != chain.end();
      };
      if (above == plan.middle || isIn(plan.trunk) || isIn(plan.tail) || !parents_[above]) break;
      limb.insert(limb.begin(), above);
    }
    return limb;
  }

  void findLimbs(Index head, BodyPlan& plan) const {
    std::vector<Joints> lefts, rights;
    for (Index j = 0; j < parents_.size(); ++j) {
      if (isMiddle(j) || isBelow(j, head) || (parents_[j] && !isMiddle(*parents_[j]))) continue;
      Joints limb = limbAt(j, plan);
      if (limb.size() > 1) {
        ((at(limb.back()) - at(plan.middle)).dot(left_) > 0 ? lefts : rights).push_back(std::move(limb));
      } else if (at(j).y() - box_.min.y() < kLow * box_.size().y()) {
        plan.leavesFeetBehind = true;
      }
    }
    for (const Joints& left : lefts) {
      const auto right = std::find_if(rights.begin(), rights.end(), [&](const Joints& r) { return isMirror(left, r); });
      if (right == rights.end()) continue;
      plan.limbs.push_back(described(left, *right, plan));
      rights.erase(right);
    }
    leaveOut(plan.limbs);
  }

  // Feathers beside a wing; horns and ears, where others are limbs by their names.
  void leaveOut(std::vector<MirroredLimb>& limbs) const {
    const auto length = [&](const MirroredLimb& limb) { return (at(limb.left.back()) - at(limb.left.front())).norm(); };
    const auto isKnown = [](const MirroredLimb& limb) { return limb.kind != LimbKind::kUnknown; };
    const bool named = std::any_of(limbs.begin(), limbs.end(), isKnown);
    const std::vector<MirroredLimb> all = limbs;
    std::erase_if(limbs, [&](const MirroredLimb& limb) {
      const auto outdoes = [&](const MirroredLimb& other) {
        return parents_[other.left.front()] == parents_[limb.left.front()] && length(limb) < kShort * length(other);
      };
      return (named && !isKnown(limb)) || std::any_of(all.begin(), all.end(), outdoes);
    });
  }

  bool isMirror(const Joints& one, const Joints& other) const {
    if (one.size() != other.size()) return false;
    const auto isImage = [&](Index a, Index b) {
      Vec3 image = at(a);
      image[lateral_] = 2 * center_ - image[lateral_];
      return (image - at(b)).norm() < kMirrored * spine_;
    };
    return isImage(one.front(), other.front()) && isImage(one.back(), other.back());
  }

  MirroredLimb described(const Joints& left, const Joints& right, const BodyPlan& plan) const {
    MirroredLimb limb{left, right, kindOf(left), Vec3::Zero(), Vec3::Zero()};
    const auto inBody = [&](const Vec3& way) { return Vec3(way.dot(plan.forward), way.y(), way.dot(left_)); };
    limb.base = inBody(at(left.front()) - at(plan.middle)) / spine_;
    limb.way = inBody((at(left.back()) - at(left.front())).normalized());
    return limb;
  }

  LimbKind kindOf(const Joints& limb) const {
    struct Word {
      const char* word;
      LimbKind kind;
    };
    constexpr std::array<Word, 6> kWords = {{{"wing", LimbKind::kWing},
                                             {"fin_", LimbKind::kFin},
                                             {"flipper", LimbKind::kFin},
                                             {"leg", LimbKind::kLeg},
                                             {"foot", LimbKind::kLeg},
                                             {"thigh", LimbKind::kLeg}}};
    for (const Word& known : kWords) {
      const auto says = [&](Index joint) { return names_[joint].find(known.word) != std::string::npos; };
      if (std::any_of(limb.begin(), limb.end(), says)) return known.kind;
    }
    return LimbKind::kUnknown;
  }

  std::vector<Vec3> positions_;
  std::vector<std::string> names_;  // in lower case
  std::vector<std::optional<Index>> parents_;
  std::vector<Joints> children_;
  Box box_;
  double size_ = 0;
  Eigen::Index lateral_ = 0;
  double center_ = 0, spine_ = 1;
  Vec3 left_ = Vec3::UnitX();
};

// One pair of limbs that may be legs.
bool isLegs(const BodyPlan& plan) {
  return plan.limbs.size() == 1 && plan.limbs[0].kind != LimbKind::kWing && plan.limbs[0].kind != LimbKind::kFin;
}

// Empty where they may be matched.
std::string whyUnlike(const BodyPlan& from, const BodyPlan& to) {
  const std::size_t one = from.limbs.size(), other = to.limbs.size();
  if (from.forward.dot(to.forward) < kSameWay) return "they face different ways";
  if (std::max(one, other) > std::min(one, other) + 1) {
    return fmt::format("the motion's has {} of limbs, the character's {}", counted(one, "pair"), other);
  }
  if (to.leavesFeetBehind) return "the character's feet hang on a root of their own, and no leg reaches them";
  const bool limbless = one == 0 || other == 0;
  return limbless && (from.tail.empty() || to.tail.empty()) ? "they have neither limbs nor tails in common" : "";
}

// Where each joint lies along a limb, from 0 to 1.
std::vector<double> placesAlong(const Joints& limb, const std::vector<Affine>& globals) {
  std::vector<double> places = {0};
  for (std::size_t i = 1; i < limb.size(); ++i) {
    const Vec3 bone = globals[limb[i]].translation() - globals[limb[i - 1]].translation();
    places.push_back(places.back() + bone.norm());
  }
  for (double& place : places) place /= std::max(places.back(), 1e-12);
  return places;
}

class Matcher {
 public:
  Matcher(const Skeleton& source, const Skeleton& target)
      : sourceGlobals_(restGlobals(source)), targetGlobals_(restGlobals(target)) {}

  std::optional<SkeletonMap> match(const BodyPlan& source, const BodyPlan& target) {
    add("body", {source.middle}, {target.middle}, kByForm);
    add("trunk", source.trunk, target.trunk, kByForm);
    add("tail", source.tail, target.tail, kByForm);
    if (!addLimbs(source.limbs, target.limbs)) return std::nullopt;
    return std::move(map_);
  }

 private:
  void add(const std::string& part, const Joints& source, const Joints& target, double confidence) {
    if (source.empty() || target.empty()) return;
    map_.matches.push_back({part, source, target, confidence, MatchedBy::kShape});
  }

  static bool bothKnown(const MirroredLimb& one, const MirroredLimb& other) {
    return one.kind != LimbKind::kUnknown && other.kind != LimbKind::kUnknown;
  }
  static bool mayFollow(const MirroredLimb& one, const MirroredLimb& other) {
    return bothKnown(one, other) ? one.kind == other.kind : unlike(one, other) < kUnlike;
  }
  static double unlike(const MirroredLimb& one, const MirroredLimb& other) {
    return (one.base - other.base).norm() + (one.way - other.way).norm();
  }

  // The most alike first. Whether each limb of the one that has fewer found its like.
  bool addLimbs(const std::vector<MirroredLimb>& source, const std::vector<MirroredLimb>& target) {
    std::vector<bool> usedSource(source.size(), false), usedTarget(target.size(), false);
    const std::size_t fewer = std::min(source.size(), target.size());
    for (std::size_t n = 0; n < fewer; ++n) {
      std::optional<std::pair<std::size_t, std::size_t>> best;
      for (std::size_t s = 0; s < source.size(); ++s) {
        for (std::size_t t = 0; t < target.size(); ++t) {
          if (usedSource[s] || usedTarget[t] || !mayFollow(source[s], target[t])) continue;
          if (!best || unlike(source[s], target[t]) < unlike(source[best->first], target[best->second])) best = {s, t};
        }
      }
      if (!best) return false;
      const MirroredLimb &from = source[best->first], &to = target[best->second];
      usedSource[best->first] = usedTarget[best->second] = true;
      const double confidence = bothKnown(from, to) ? kByFormAndWord : kByForm;
      const std::string limb = "Limb" + std::to_string(n + 1) + "Bone";
      addLimb("left" + limb, from.left, to.left, confidence);
      addLimb("right" + limb, from.right, to.right, confidence);
    }
    return true;
  }

  void addLimb(const std::string& part, const Joints& source, const Joints& target, double confidence) {
    const std::vector<double> from = placesAlong(source, sourceGlobals_), to = placesAlong(target, targetGlobals_);
    const std::vector<Joints> one = groupedAlong(source, from, to), other = groupedAlong(target, to, from);
    for (std::size_t i = 0; i < one.size(); ++i) add(part + std::to_string(i + 1), one[i], other[i], confidence);
  }

  std::vector<Affine> sourceGlobals_, targetGlobals_;
  SkeletonMap map_;
};

}  // namespace

std::optional<SkeletonMap> matchBodyPlans(const Skeleton& source, const Skeleton& target) {
  const std::optional<BodyPlan> from = BodyPlanReader(source).read(), to = BodyPlanReader(target).read();
  if (!from || !to || !whyUnlike(*from, *to).empty()) return std::nullopt;
  if (isLegs(*from) && isLegs(*to)) return std::nullopt;
  return Matcher(source, target).match(*from, *to);
}

std::string whyBodyPlansDiffer(const Skeleton& source, const Skeleton& target) {
  const std::optional<BodyPlan> from = BodyPlanReader(source).read(), to = BodyPlanReader(target).read();
  if (!from) return "the motion's joints show no head on a trunk";
  if (!to) return "the character's joints show no head on a trunk";
  const std::string why = whyUnlike(*from, *to);
  return why.empty() ? "their limbs are not alike" : why;
}

}  // namespace limber
