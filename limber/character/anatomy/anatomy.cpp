#include "limber/character/anatomy/anatomy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limber/character/anatomy/body_reading.h"
#include "limber/character/anatomy/certain_states.h"
#include "limber/character/anatomy/names/joint_words.h"
#include "limber/character/anatomy/part_maker.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, kPartKinds> kKindNames = {"trunk", "neck", "head",       "tail", "leg", "arm",
                                                                 "wing",  "fin",  "finger",     "ear",  "jaw", "eye",
                                                                 "hair",  "prop", "attachment", "other"};

// Under each guess of the axes, and the field of the likeliest.
struct Hypotheses {
  std::vector<double> scores;  // axesScore
  std::size_t best = 0;
  std::optional<PartField> field;
};

// What the names of a convention say for a hypothesis of the axes, a log-likelihood: people are upright from their feet
// to their shoulders. Of sides they say no more than other words do where form tells: a model that was mirrored has the
// names of before.
double conventionScore(const BodyReading& reading, const Axes& axes, bool sidesByNames) {
  constexpr double kUp = 10, kSides = 7;  // of flat rest poses read in a frame that crawls from 5 on right
  if (!reading.convention) return 0;
  double score = 0, votes = 0;
  const std::optional<Vec3> arms = meanPosition(reading.declared, reading.positions, {JointRole::kUpperArm}),
                            feet = meanPosition(reading.declared, reading.positions, {JointRole::kFoot});
  if (arms && feet && (*arms - *feet).norm() > 0) score += kUp * axes.up.dot((*arms - *feet).normalized());
  if (!sidesByNames) return score;
  for (const HalfJoint& half : reading.body.joints) {
    if (!half.partner || !reading.declared[half.joint]) continue;
    const Side side = reading.declared[half.joint]->side;
    if (side != Side::kCenter) votes += side == Side::kLeft ? 1 : -1;
  }
  return score + (votes * axes.left().dot(reading.body.lateral) > 0 ? kSides : 0);
}

Hypotheses readUnderEach(const BodyReading& reading, std::span<const std::uint32_t> allowed, const PartWeights& weights,
                         bool sidesByNames) {
  StateScores steady(reading.measures.size());
  addScores(reading.measures.steadyFeatures(), weights, steady);
  Hypotheses hypotheses;
  for (const Axes& axes : reading.hypotheses) {
    StateScores own = steady;
    addScores(reading.measures.features(axes), weights, own);
    PartField other(reading.body, own, weights, allowed);
    hypotheses.scores.push_back(axesScore(reading.measures, axes, other, weights) +
                                conventionScore(reading, axes, sidesByNames));
    if (hypotheses.field && hypotheses.scores.back() <= hypotheses.scores[hypotheses.best]) continue;
    hypotheses.best = hypotheses.scores.size() - 1;
    hypotheses.field.emplace(std::move(other));
  }
  return hypotheses;
}

bool isDeclared(const Joint& joint) {
  return !joint.declaredBone.empty();
}

Skeleton withoutDeclaredBones(Skeleton skeleton) {
  for (Joint& joint : skeleton.joints) joint.declaredBone = {};
  return skeleton;
}

Anatomy read(const Skeleton& skeleton, const Pose& pose, const AnatomyOptions& options, bool conventions,
             const PartWeights& weights) {
  Anatomy anatomy;
  anatomy.partOf.resize(skeleton.jointCount());
  if (skeleton.joints.empty()) return anatomy;
  const BodyReading reading(skeleton, pose, options.names, conventions);
  const Hypotheses hypotheses = readUnderEach(reading, certainStates(reading, options), weights, options.sidesByNames);
  const bool isPossible = hypotheses.field->logSum() > static_cast<double>(kNever) / 2;
  // What names are certain of goes first, then what the file declares.
  if (!isPossible && reading.convention) return read(skeleton, pose, options, false, weights);
  if (!isPossible && options.names && std::any_of(skeleton.joints.begin(), skeleton.joints.end(), isDeclared)) {
    anatomy = read(withoutDeclaredBones(skeleton), pose, options, true, weights);
    anatomy.believesFile = false;
    return anatomy;
  }
  const auto& [scores, best, field] = hypotheses;
  double all = 0, sameSides = 0;
  const Axes& axes = reading.hypotheses[best];
  for (std::size_t g = 0; g < scores.size(); ++g) {
    const double fraction = std::exp(scores[g] - scores[best]);
    all += fraction;
    if (reading.hypotheses[g].left().dot(axes.left()) > 0) sameSides += fraction;
  }

  anatomy.axes = axes;
  if (reading.convention) {
    anatomy.convention = reading.convention->convention->name;
    anatomy.contradicted = reading.convention->contradicted;
  }
  for (Index j = 0; j < skeleton.jointCount() && !anatomy.declaredHips; ++j) {
    if (reading.declared[j] && reading.declared[j]->role == JointRole::kHips) anatomy.declaredHips = j;
  }
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

std::optional<std::array<const Part*, 4>> Anatomy::certainBody() const {
  const std::array<const Part*, 4> body = {find(PartKind::kTrunk), find(PartKind::kHead),
                                           find(PartKind::kLeg, Side::kLeft), find(PartKind::kLeg, Side::kRight)};
  const auto isSure = [](const Part* part) { return part && part->confidence >= kDoubtful; };
  return std::all_of(body.begin(), body.end(), isSure) ? std::optional(body) : std::nullopt;
}

Anatomy readAnatomy(const Skeleton& skeleton, const AnatomyOptions& options) {
  return readAnatomy(skeleton, restPose(skeleton), options);
}

Anatomy readAnatomy(const Skeleton& skeleton, const Pose& pose, const AnatomyOptions& options) {
  return readAnatomyWith(fittedPartWeights(), skeleton, pose, options);
}

Anatomy readAnatomyWith(const PartWeights& weights, const Skeleton& skeleton, const Pose& pose,
                        const AnatomyOptions& options) {
  return read(skeleton, pose, options, true, weights);
}

Skeleton believedSkeleton(Skeleton skeleton, const Anatomy& anatomy) {
  return anatomy.believesFile ? skeleton : withoutDeclaredBones(std::move(skeleton));
}

}  // namespace limber
