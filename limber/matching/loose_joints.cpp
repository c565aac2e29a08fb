#include "limber/matching/loose_joints.h"

#include <algorithm>

#include "limber/skeleton/chain.h"
#include "limber/skeleton/humanoid_names.h"

namespace limber {

namespace {

constexpr double kNear = 0.1;  // of the extent of all joints

class LooseFinder {
 public:
  LooseFinder(const Skeleton& skeleton, const SkeletonMap& map, MapSide side, std::span<const Vec3> rest)
      : skeleton_(skeleton), map_(map), side_(side), rest_(rest), hips_(jointsOf(*map.find("hips")).front()) {}

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
      const std::optional<std::string_view> above = humanoidParent(match.part);
      const JointMatch* parent = above ? map_.find(*above) : nullptr;
      const Index joint = jointsOf(match).front();
      if (!parent || match.part == "hips" || isAncestorOrSelf(skeleton_, hips_, joint)) continue;
      loose_.push_back({joint, jointsOf(*parent).back(), true});
    }
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
