#include "limber/matching/loose_joints.h"

#include <algorithm>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kNear = 0.1;  // of the extent of all joints

class LooseFinder {
 public:
  LooseFinder(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, std::span<const Vec3> rest)
      : skeleton_(skeleton),
        map_(map),
        side_(side),
        rest_(rest),
        hips_(jointsOf(*map.find(body_part::kPelvis)).front()) {}

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

  void addOthers() {
    std::vector<Index> body, others;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (isOfBody(j)) {
        body.push_back(j);
      } else if (!carriesBody(j) && (!skeleton_.joints[j].parent || carriesBody(*skeleton_.joints[j].parent))) {
        others.push_back(j);
      }
    }
    Box box;
    for (const Index j : body) box.add(rest_[j]);
    for (const Index other : others) {
      const auto away = [&](Index j) { return (rest_[j] - rest_[other]).norm(); };
      const Index carrier =
          *std::min_element(body.begin(), body.end(), [&](Index a, Index b) { return away(a) < away(b); });
      if (away(carrier) < kNear * box.longestSide()) loose_.push_back({other, carrier, false});
    }
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
  std::vector<LooseJoint> loose_;
};

}  // namespace

std::vector<LooseJoint> looseJoints(const Skeleton& skeleton, const SkeletonMap& map, MapSide side,
                                    std::span<const Vec3> rest) {
  return LooseFinder(skeleton, map, side, rest).find();
}

}  // namespace limber
