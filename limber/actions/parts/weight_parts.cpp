#include "limber/actions/parts/weight_parts.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "limber/character/anatomy/body_part.h"
#include "limber/core/error.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

constexpr double kOpenBelow = 0.5;  // lead below which a triangle may go to either part: 3 to 1

bool goesWithCarrier(PartKind kind) {
  return kind == PartKind::kFinger || kind == PartKind::kEar || kind == PartKind::kJaw || kind == PartKind::kEye ||
         kind == PartKind::kHair || kind == PartKind::kAttachment;
}

// The part of the body that a joint counts as.
std::optional<std::size_t> limbOf(const Anatomy& anatomy, Index joint) {
  std::optional<std::size_t> number = anatomy.partOf[joint];
  if (!number) return std::nullopt;
  const Part& own = anatomy.parts[*number];
  if (own.upper && own.carrier && (own.kind == PartKind::kArm || own.kind == PartKind::kLeg)) {
    const auto upper = std::find(own.joints.begin(), own.joints.end(), *own.upper);
    if (std::find(own.joints.begin(), upper, joint) != upper) number = own.carrier;
  }
  while (goesWithCarrier(anatomy.parts[*number].kind) && anatomy.parts[*number].carrier) {
    number = anatomy.parts[*number].carrier;
  }
  return number;
}

std::string nameOfPart(const Skeleton& skeleton, const Part& part) {
  if ((part.kind == PartKind::kProp || part.kind == PartKind::kOther) && !part.joints.empty()) {
    return skeleton.joints[part.joints.front()].name;
  }
  return nameOf(BodyPart{part.kind, part.side, part.pair, Segment::kWhole, 0});
}

JointGroups limbGroups(const Skeleton& skeleton) {
  const Anatomy anatomy = readAnatomy(skeleton);
  JointGroups groups;
  UniqueNames names;
  std::vector<Index> groupOfPart(anatomy.parts.size(), kNoIndex);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const std::optional<std::size_t> part = limbOf(anatomy, j);
    if (!part && parent) {
      groups.groupOf.push_back(groups.groupOf[*parent]);
      continue;
    }
    // Ancestors of the body, such as an armature's root, belong to its first part.
    const std::size_t number = part.value_or(0);
    if (anatomy.parts.empty()) {
      groups.groupOf.push_back(static_cast<Index>(groups.names.size()));
      groups.names.push_back(names.add(skeleton.joints[j].name));
      continue;
    }
    if (groupOfPart[number] == kNoIndex) {
      groupOfPart[number] = static_cast<Index>(groups.names.size());
      groups.names.push_back(names.add(nameOfPart(skeleton, anatomy.parts[number])));
    }
    groups.groupOf.push_back(groupOfPart[number]);
  }
  return groups;
}

// Leaves out the parts that no triangle has.
SurfaceParts usedParts(std::vector<Index> partOf, const std::vector<std::string>& names) {
  std::vector<Index> number(names.size(), kNoIndex);
  for (const Index part : partOf) number[part] = 0;
  SurfaceParts parts;
  for (std::size_t g = 0; g < names.size(); ++g) {
    if (number[g] == kNoIndex) continue;
    number[g] = parts.partCount();
    parts.names.push_back(names[g]);
  }
  for (Index& part : partOf) part = number[part];
  parts.partOf = std::move(partOf);
  return parts;
}

}  // namespace

JointGroups jointGroups(const Skeleton& skeleton, PartDetail detail) {
  if (detail == PartDetail::kLimbs) return limbGroups(skeleton);
  JointGroups groups;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    groups.groupOf.push_back(j);
    groups.names.push_back(skeleton.joints[j].name);
  }
  return groups;
}

FuzzyParts fuzzyByWeights(std::span<const Triangle> triangles, const SkinWeights& weights, const JointGroups& groups) {
  FuzzyParts fuzzy;
  std::vector<double> sums(groups.names.size(), 0);
  std::vector<Index> met;
  for (const Triangle& triangle : triangles) {
    met.clear();
    for (const Index v : triangle) {
      for (Index slot = 0; slot < weights.slots; ++slot) {
        const double weight = static_cast<double>(weights.weightsOf(v)[slot]);
        if (!(weight > 0)) continue;
        const Index group = groups.groupOf[weights.jointsOf(v)[slot]];
        if (sums[group] == 0) met.push_back(group);
        sums[group] += weight;
      }
    }
    std::sort(met.begin(), met.end(), [&](Index a, Index b) { return sums[a] != sums[b] ? sums[a] > sums[b] : a < b; });
    const Index first = met.empty() ? kNoIndex : met[0], second = met.size() > 1 ? met[1] : first;
    const double p = met.empty() ? 0 : sums[first], q = met.size() > 1 ? sums[second] : 0;
    fuzzy.first.push_back(first);
    fuzzy.second.push_back(second);
    fuzzy.lead.push_back(p > 0 ? static_cast<float>((p - q) / (p + q)) : 0.0f);
    for (const Index group : met) sums[group] = 0;
  }
  return fuzzy;
}

void spreadParts(const FaceGraph& graph, FuzzyParts& fuzzy) {
  std::vector<double> distances(graph.faceCount(), std::numeric_limits<double>::infinity());
  std::vector<Index> sources;
  for (Index t = 0; t < graph.faceCount(); ++t) {
    if (fuzzy.first[t] == kNoIndex) continue;
    distances[t] = 0;
    sources.push_back(t);
  }
  shortenFrom(graph, sources, distances,
              [&](Index from, Index to) { fuzzy.first[to] = fuzzy.second[to] = fuzzy.first[from]; });
}

SurfaceParts partsByWeights(const FaceGraph& graph, std::span<const Triangle> triangles, const SkinWeights& weights,
                            const JointGroups& groups, Progress& progress) {
  FuzzyParts fuzzy = fuzzyByWeights(triangles, weights, groups);
  if (std::all_of(fuzzy.first.begin(), fuzzy.first.end(), [](Index part) { return part == kNoIndex; })) {
    throw Error(ErrorCode::kBadArgument, "no triangle has a skin weight", {},
                "make weights with limber rig, or take the parts by shape");
  }
  spreadParts(graph, fuzzy);
  progress.step("cuts");
  std::vector<Index> partOf = cutFuzzyParts(graph, fuzzy, kOpenBelow, progress);
  progress.step("islands");
  mergeIslands(graph, partOf, progress);
  return usedParts(std::move(partOf), groups.names);
}

}  // namespace limber
