#include "limber/anatomy/anatomy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limber/anatomy/body_reading.h"
#include "limber/anatomy/joint_words.h"
#include "limber/anatomy/part_maker.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, kPartKinds> kKindNames = {"trunk", "neck", "head", "tail",   "leg",
                                                                 "arm",   "wing", "fin",  "finger", "ear",
                                                                 "jaw",   "eye",  "hair", "prop",   "other"};

std::vector<std::uint32_t> allowedStates(const BodyReading& reading, std::span<const FixedLabel> fixed) {
  constexpr std::uint32_t kAll = (1u << kPartStates) - 1;
  std::vector<std::uint32_t> ofJoint(reading.tree.size(), kAll);
  for (const FixedLabel& label : fixed) {
    std::uint32_t mask = 0;
    for (std::size_t s = 0; s < kPartStates; ++s) {
      if (kindOf(static_cast<PartState>(s)) == label.kind) mask |= 1u << s;
    }
    if (label.joint < ofJoint.size() && mask != 0) ofJoint[label.joint] = mask;
  }
  std::vector<std::uint32_t> allowed;
  for (const HalfJoint& half : reading.body.joints) {
    std::uint32_t both = ofJoint[half.joint];
    if (half.partner && (both & ofJoint[*half.partner]) != 0) both &= ofJoint[*half.partner];
    allowed.push_back(both);
  }
  return allowed;
}

}  // namespace

std::string_view nameOf(PartKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::string_view nameOf(Side side) {
  return side == Side::kLeft ? "left" : side == Side::kRight ? "right" : "center";
}

std::optional<PartKind> partKindNamed(std::string_view name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  return found == kKindNames.end() ? std::nullopt : std::optional(static_cast<PartKind>(found - kKindNames.begin()));
}

std::optional<Side> sideNamed(std::string_view name) {
  for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
    if (nameOf(side) == name) return side;
  }
  return std::nullopt;
}

Side opposite(Side side) {
  return side == Side::kLeft ? Side::kRight : side == Side::kRight ? Side::kLeft : Side::kCenter;
}

std::string_view nameOf(Evidence evidence) {
  constexpr std::array<std::string_view, 4> kNames = {"form", "names", "both", "user"};
  return kNames[static_cast<std::size_t>(evidence)];
}

bool Part::has(Index joint) const {
  return std::find(joints.begin(), joints.end(), joint) != joints.end() ||
         std::find(branches.begin(), branches.end(), joint) != branches.end();
}

const Part* Anatomy::find(PartKind kind, Side side, Index pair) const {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
    return part.kind == kind && part.side == side && part.pair == pair;
  });
  return found == parts.end() ? nullptr : &*found;
}

Index Anatomy::pairsOf(PartKind kind) const {
  Index pairs = 0;
  for (const Part& part : parts) {
    if (part.kind == kind) pairs = std::max(pairs, part.pair + 1);
  }
  return pairs;
}

Anatomy readAnatomy(const Skeleton& skeleton, const AnatomyOptions& options) {
  return readAnatomy(skeleton, restPose(skeleton), options);
}

Anatomy readAnatomy(const Skeleton& skeleton, const Pose& pose, const AnatomyOptions& options) {
  Anatomy anatomy;
  anatomy.partOf.resize(skeleton.jointCount());
  if (skeleton.joints.empty()) return anatomy;
  const BodyReading reading(skeleton, pose, options.names);
  const std::vector<std::uint32_t> allowed = allowedStates(reading, options.fixed);
  const PartWeights& weights = fittedPartWeights();
  StateScores steady(reading.measures.size());
  addScores(reading.measures.steadyFeatures(), weights, steady);

  std::vector<double> scores;
  std::optional<PartField> field;  // of the best guess so far
  std::size_t best = 0;
  for (const Axes& axes : reading.guesses) {
    StateScores own = steady;
    addScores(reading.measures.features(axes), weights, own);
    PartField other(reading.body, own, weights, allowed);
    scores.push_back(axesScore(reading.measures, axes, other, weights));
    if (field && scores.back() <= scores[best]) continue;
    best = scores.size() - 1;
    field.emplace(std::move(other));
  }
  double all = 0, sameSides = 0;
  const Axes& axes = reading.guesses[best];
  for (std::size_t g = 0; g < scores.size(); ++g) {
    const double share = std::exp(scores[g] - scores[best]);
    all += share;
    if (reading.guesses[g].left().dot(axes.left()) > 0) sameSides += share;
  }

  anatomy.axes = axes;
  anatomy.confidence = 1 / all;
  anatomy.parts = partsOf(reading, {axes, sameSides / all, field->best(), field->marginals()});
  anatomy.ground = std::numeric_limits<double>::infinity();
  Box box;
  for (std::size_t p = 0; p < anatomy.parts.size(); ++p) {
    Part& part = anatomy.parts[p];
    for (const Index joint : part.branches) anatomy.partOf[joint] = p;
    for (const Index joint : part.joints) {
      anatomy.partOf[joint] = p;
      box.add(reading.positions[joint]);
      anatomy.ground = std::min(anatomy.ground, axes.up.dot(reading.positions[joint]));
    }
    const bool byUser = std::any_of(options.fixed.begin(), options.fixed.end(), [&](const FixedLabel& label) {
      return part.has(label.joint) && part.kind == label.kind;
    });
    const bool named = options.names && std::any_of(part.joints.begin(), part.joints.end(),
                                                    [&](Index joint) { return reading.words[joint].word != 0; });
    part.evidence = byUser ? Evidence::kUser : named ? Evidence::kBoth : Evidence::kForm;
  }
  if (box.empty()) anatomy.ground = 0;
  anatomy.size = box.empty() ? 0 : box.diagonal();
  return anatomy;
}

}  // namespace limber
