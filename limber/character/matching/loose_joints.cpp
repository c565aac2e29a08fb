#include "limber/character/matching/loose_joints.h"

#include <algorithm>
#include <utility>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// Fractions of the extent of the body's joints.
// 1e-5 to 0.01; controls rest at the very position of their joints, but for rounding (1e-6 in the files seen); fingers
// begin 0.02 from the wrist.
constexpr double kSamePosition = 0.005;
constexpr double kNear = 0.1;  // 0.05 to 0.2; joints further off stay behind; set on a walking machine's claws

class LooseFinder {
 public:
  LooseFinder(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, std::span<const Vec3> rest)
      : skeleton_(skeleton),
        map_(map),
        side_(side),
        rest_(rest),
        hips_(jointsOf(*map.find(body_part::kPelvis)).front()),
        matched_(skeleton.jointCount()) {
    for (const Index joint : matchedJoints(map, side)) matched_[joint] = true;
  }

  std::vector<LooseJoint> find() {
    addMatched();
    addOthers();
    return std::move(loose_);
  }

 private:
  const std::vector<Index>& jointsOf(const JointMatch& match) const {
    return side_ == MapSide::kSource ? match.source : match.target;
  }

  void addMatched() {
    for (const JointMatch& match : map_.matches) {
      const JointMatch* parent = carrierOf(match.part);
      const Index joint = jointsOf(match).front();
      if (!parent || isAncestorOrSelf(skeleton_, hips_, joint)) continue;
      loose_.push_back({joint, jointsOf(*parent).back(), true});
    }
  }

  // What a person's part hangs on: of limbs the segment before, else the nearest part of the trunk that is matched.
  const JointMatch* carrierOf(const BodyPart& part) const {
    const auto first = [&](std::initializer_list<BodyPart> parts) -> const JointMatch* {
      for (const BodyPart& each : parts) {
        if (const JointMatch* match = map_.find(each)) return match;
      }
      return nullptr;
    };
    if (part.kind == PartKind::kLeg || part.kind == PartKind::kArm) {
      for (int segment = static_cast<int>(part.segment) - 1; segment > 0; --segment) {
        BodyPart before = part;
        before.segment = static_cast<Segment>(segment);
        if (const JointMatch* match = map_.find(before)) return match;
      }
      return part.kind == PartKind::kLeg ? first({body_part::kPelvis}) : first({body_part::kTrunk, body_part::kPelvis});
    }
    if (part.kind == PartKind::kFinger)
      return first({body_part::arm(part.side, Segment::kEnd), body_part::arm(part.side, Segment::kMiddle)});
    if (part == body_part::kHead) return first({body_part::kNeck, body_part::kTrunk, body_part::kPelvis});
    if (part == body_part::kNeck) return first({body_part::kTrunk, body_part::kPelvis});
    if (part == body_part::kTrunk) return first({body_part::kPelvis});
    return nullptr;
  }

  // Controls of inverse kinematics, such as Unreal's ik_foot_l, rest on the joint that they follow, wherever in their
  // own tree they are. The top of a tree that rests on none of the body stays with a parent that it rests on.
  void addOthers() {
    std::vector<Index> body;
    Box box;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (!isOfBody(j)) continue;
      body.push_back(j);
      box.add(rest_[j]);
    }
    const double same = kSamePosition * box.longestSide(), near = kNear * box.longestSide();
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (isOfBody(j) || carriesBody(j)) continue;
      const std::optional<Index>& parent = skeleton_.joints[j].parent;
      const bool isTop = !parent || carriesBody(*parent);
      if (const std::optional<Index> carrier = restsOn(j, body, same)) {
        loose_.push_back({j, *carrier, false});
      } else if (isTop && !(parent && distance(j, *parent) <= same)) {
        const Index nearest = *std::min_element(body.begin(), body.end(),
                                                [&](Index a, Index b) { return distance(j, a) < distance(j, b); });
        if (distance(j, nearest) < near) loose_.push_back({j, nearest, false});
      }
    }
  }

  double distance(Index a, Index b) const { return (rest_[a] - rest_[b]).norm(); }

  // Of several a matched one: a hand, not the end of the forearm or its twist joint. Then the nearest.
  std::optional<Index> restsOn(Index joint, std::span<const Index> body, double same) const {
    std::optional<Index> best;
    const auto rank = [&](Index j) { return std::pair(!matched_[j], distance(joint, j)); };
    for (const Index j : body) {
      if (distance(joint, j) <= same && (!best || rank(j) < rank(*best))) best = j;
    }
    return best;
  }

  bool isOfBody(Index joint) const {
    return isAncestorOrSelf(skeleton_, hips_, joint) ||
           std::any_of(loose_.begin(), loose_.end(), [&](const LooseJoint& loose) {
             return loose.matched && isAncestorOrSelf(skeleton_, loose.joint, joint);
           });
  }

  bool carriesBody(Index joint) const {
    return isAncestorOrSelf(skeleton_, joint, hips_) ||
           std::any_of(loose_.begin(), loose_.end(), [&](const LooseJoint& loose) {
             return loose.matched && isAncestorOrSelf(skeleton_, joint, loose.joint);
           });
  }

  const Skeleton& skeleton_;
  const SkeletonMap& map_;
  MapSide side_;
  std::span<const Vec3> rest_;
  Index hips_;
  std::vector<bool> matched_;  // #J
  std::vector<LooseJoint> loose_;
};

}  // namespace

std::vector<LooseJoint> looseJoints(const Skeleton& skeleton, const SkeletonMap& map, MapSide side,
                                    std::span<const Vec3> rest) {
  return LooseFinder(skeleton, map, side, rest).find();
}

}  // namespace limber
