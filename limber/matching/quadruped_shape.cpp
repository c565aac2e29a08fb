#include "limber/matching/quadruped_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "limber/matching/limb_groups.h"
#include "limber/matching/quadruped.h"

namespace limber {

namespace {

constexpr double kConfidence = 0.8;
constexpr double kSameWay = 0.9;  // cosine between two blades, seen from where each faces, at least
constexpr std::array<const char*, 4> kLegs = {"leftHind", "rightHind", "leftFore", "rightFore"};

using Joints = Quadruped::Joints;

class Matcher {
 public:
  SkeletonMap match(const Quadruped& source, const Quadruped& target) {
    add(kHindquarters, {source.hindquarters}, {target.hindquarters});
    add("trunk", source.trunk, target.trunk);
    add("neck", source.neck, target.neck);
    add("head", source.head, target.head);
    add("tail", source.tail, target.tail);
    for (std::size_t i = 0; i < kLegs.size(); ++i) addLeg(kLegs[i], source.legs[i], target.legs[i]);
    return std::move(map_);
  }

 private:
  void add(const std::string& part, const Joints& source, const Joints& target) {
    if (source.empty() || target.empty()) return;
    map_.matches.push_back({part, source, target, kConfidence, MatchedBy::kShape});
  }

  void addLeg(const std::string& name, const Quadruped::Leg& source, const Quadruped::Leg& target) {
    // Blades that lie otherwise would take the legs elsewhere.
    if (source.bladeWay.dot(target.bladeWay) > kSameWay) add(name + "Blade", source.blade, target.blade);
    const std::vector<Joints> from = groupedAlong(source.bones, source.along, target.along),
                              to = groupedAlong(target.bones, target.along, source.along);
    for (std::size_t i = 0; i < to.size(); ++i) add(name + "Bone" + std::to_string(i + 1), from[i], to[i]);
    add(name + "Foot", source.foot, target.foot);
    add(name + "Toes", source.toes, target.toes);
  }

  SkeletonMap map_;
};

}  // namespace

std::optional<LegEnd> legEndOf(std::string_view part) {
  for (const std::string leg : kLegs) {
    if (part == leg + "Bone1") return LegEnd::kUpper;
    if (part == leg + "Foot") return LegEnd::kFoot;
  }
  return std::nullopt;
}

bool isForeleg(const SkeletonMap& map, Index upper) {
  return std::any_of(map.matches.begin(), map.matches.end(), [&](const JointMatch& match) {
    return match.target.front() == upper && (match.part == "leftForeBone1" || match.part == "rightForeBone1");
  });
}

std::optional<SkeletonMap> matchQuadrupeds(const Skeleton& source, const Skeleton& target) {
  const std::optional<Quadruped> from = readQuadruped(source), to = readQuadruped(target);
  if (!from || !to) return std::nullopt;
  return Matcher().match(*from, *to);
}

}  // namespace limber
