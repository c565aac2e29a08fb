#include "limber/rigging/kind_choice.h"

#include <algorithm>
#include <set>
#include <span>
#include <string>

#include "limber/rigging/roles/finger_count.h"

namespace limber {

namespace {

constexpr std::size_t kLegsOfSpiders = 7;  // counted, from which on a body has eight
constexpr double kDoubtfulJoint = 0.05;    // expected error, heights
constexpr double kMinFraction = 0.008;     // of the samples, that are of a limb's further parts; fewer are mistaken
constexpr double kMissing = 100;           // above any error

bool isFirstOfLimb(std::string_view role) {
  const RoleName name = splitName(role);
  return name.segment == "base" || name.segment == "upper";
}

// Where a limb is cut off, a little of its first bone is mostly left, and the networks put all of its joints there.
// Hardly a sample then is of its further parts. Toys have limbs of one bone: no further joints are read either.
bool isThere(const TemplateLimb& limb, const RoledSkeleton& made, const RoleReading& reading) {
  bool hasRole = false, isRead = false;
  std::set<std::string> further;  // parts
  for (const Index joint : limb.joints) {
    // Few hands show their fingers: that they are not seen says nothing.
    if (!made.roles[joint] || made.roles[joint]->from.starts_with("finger")) continue;
    const auto& [from, to, fraction] = *made.roles[joint];
    hasRole = true;
    if (reading.isKnown(from)) return true;
    if (!reading.has(from) && !reading.has(to)) continue;
    isRead = true;
    if (isFirstOfLimb(from)) continue;
    further.insert(partOfRole(from));
  }
  if (!isRead || further.empty()) return !hasRole || isRead;
  double fraction = 0;
  for (const std::string& part : further) fraction += reading.fractionOf(part);
  return fraction >= kMinFraction;
}

// What a plan gets where the user leaves the choice; null where it gets handles.
const BodyKind* kindOfPlan(std::string_view plan, std::size_t fingers, std::size_t legs) {
  if (plan == "upright" && fingers >= kHandWithFingers) return &findBodyKind("humanoid-fingers");
  if (plan == "many" && legs >= kLegsOfSpiders) return &findBodyKind("spider");
  const std::span<const BodyKind> kinds = bodyKinds();
  const auto first = std::find_if(kinds.begin(), kinds.end(), [&](const BodyKind& kind) { return kind.plan == plan; });
  return first == kinds.end() ? nullptr : &*first;
}

}  // namespace

std::optional<std::string_view> planOf(const Anatomy& anatomy) {
  const Index legs = anatomy.pairsOf(PartKind::kLeg);
  const bool hasWings = anatomy.pairsOf(PartKind::kWing) > 0, hasArms = anatomy.pairsOf(PartKind::kArm) > 0;
  if (legs > 2) return "many";
  if (legs == 2) return hasWings ? "winged_four" : "four";
  if (hasWings && !hasArms) return "bird";
  if (legs == 1 || hasArms) return "upright";
  if (anatomy.pairsOf(PartKind::kFin) > 0) return "swims";
  return std::nullopt;
}

std::vector<TemplateLimb> limbsOf(const RoledSkeleton& made, const RoleReading& reading) {
  std::vector<TemplateLimb> limbs = limbChains(made.skeleton);
  for (TemplateLimb& limb : limbs) limb.isThere = isThere(limb, made, reading);
  return limbs;
}

double confidenceOf(double planProbability, const RoledSkeleton& made, const RoleReading& reading) {
  const std::vector<TemplateLimb> limbs = limbsOf(made, reading);
  double there = 0;
  for (const TemplateLimb& limb : limbs) there += limb.isThere ? 1.0 / static_cast<double>(limbs.size()) : 0;
  return planProbability * there * there * there;
}

std::vector<TemplateMatch> matchesOf(const RoleReading& reading, const ReadingWeights& weights, std::size_t fingers,
                                     std::size_t legs) {
  std::vector<TemplateMatch> matches;
  for (const std::string& plan : weights.plans) {
    const BodyKind* kind = kindOfPlan(plan, fingers, legs);
    if (!kind) continue;
    const double confidence = confidenceOf(reading.probability(plan), skeletonOfKind(*kind, reading), reading);
    matches.push_back({std::string(kind->name), confidence});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const TemplateMatch& a, const TemplateMatch& b) { return a.confidence > b.confidence; });
  return matches;
}

void dropUnlikely(std::vector<TemplateMatch>& matches) {
  const auto isUnlikely = [](const TemplateMatch& match) { return match.confidence < kWorthNaming; };
  matches.erase(std::remove_if(matches.begin() + 1, matches.end(), isUnlikely), matches.end());
}

std::vector<std::string> doubtsOf(const RoledSkeleton& made, const RoleReading& reading, const TemplatePins& pins) {
  const std::vector<TemplateJoint>& joints = made.skeleton.joints;
  struct Doubt {
    Index joint;
    double error;
  };
  std::vector<Doubt> doubts;
  for (const TemplateLimb& limb : limbsOf(made, reading)) {
    const Index end = limb.joints.back();
    const std::optional<Index> mirror = joints[end].mirror;
    if (!made.roles[end] || made.roles[end]->from.starts_with("finger")) continue;
    if (pins[end] || (mirror && pins[*mirror]) || joints[end].name.starts_with("right")) continue;
    doubts.push_back({end, (limb.isThere ? 0 : kMissing) + reading.expectedError(*made.roles[end])});
  }
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) { return a.error > b.error; });
  std::vector<std::string> names;
  for (const Doubt& doubt : doubts) {
    if (names.size() < kMaxDoubts && doubt.error > kDoubtfulJoint) names.push_back(joints[doubt.joint].name);
  }
  return names;
}

}  // namespace limber
