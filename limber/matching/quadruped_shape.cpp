#include "limber/matching/quadruped_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

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

  // The leg's bones in as many groups as the other has, if that has fewer: each begins with the joint that lies where
  // one of the other's does along the leg.
  static std::vector<Joints> grouped(const Quadruped::Leg& leg, const Quadruped::Leg& other) {
    std::vector<Joints> groups;
    std::size_t at = 0;
    for (std::size_t i = 0; i < std::min(leg.bones.size(), other.bones.size()); ++i) {
      const std::size_t left = std::min(leg.bones.size(), other.bones.size()) - i;
      const auto away = [&](std::size_t j) { return std::abs(leg.along[j] - other.along[i]); };
      std::size_t begin = at;
      for (std::size_t j = at + 1; i > 0 && j + left <= leg.bones.size(); ++j) {
        if (away(j) < away(begin)) begin = j;
      }
      for (; at < begin; ++at) groups.back().push_back(leg.bones[at]);
      groups.push_back({leg.bones[at++]});
    }
    for (; at < leg.bones.size(); ++at) groups.back().push_back(leg.bones[at]);
    return groups;
  }

  void addLeg(const std::string& name, const Quadruped::Leg& source, const Quadruped::Leg& target) {
    // Blades that lie otherwise would take the legs elsewhere.
    if (source.bladeWay.dot(target.bladeWay) > kSameWay) add(name + "Blade", source.blade, target.blade);
    const std::vector<Joints> from = grouped(source, target), to = grouped(target, source);
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
