#include "limber/rigging/read_template.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limber/character/anatomy/anatomy.h"
#include "limber/core/text/numbers.h"
#include "limber/reading/learned_reading.h"
#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/roles/role_reading.h"
#include "limber/rigging/template_rigger.h"
#include "limber/rigging/templates/humanoid_landmarks.h"
#include "limber/rigging/templates/joints_between.h"
#include "limber/rigging/templates/quadruped_landmarks.h"

namespace limber {

namespace {

constexpr double kAsymmetryScale = 0.1;   // asymmetry that counts as much as e times less probability of a stance
constexpr double kMinProbability = 1e-3;  // of a stance
constexpr double kUnusualUp = 0.1;        // models whose up is neither +Y nor +Z, to those whose up is one of these
constexpr double kDoubtfulJoint = 0.05;   // expected error, heights
constexpr double kWorthNaming = 0.01;     // confidence of a kind that is reported beside the likeliest
constexpr double kMissing = 100;          // above any error
constexpr double kLandmarkReach = 2;      // expected errors that a landmark may lie from the reading
constexpr double kMinReach = 0.03;        // heights
constexpr double kTipBeyond = 0.5;        // of a bone: its end beyond the joint, where no sample tells

// Of those with an axis that is up and one that is front. Rows: left, up, front.
double probabilityOf(const Mat3& axes, const LearnedStance& stance) {
  const std::array<Mat3, kStances> rotations = stanceRotations();
  std::size_t nearest = 0;
  const auto likeness = [&](std::size_t i) { return rotations[i].cwiseProduct(axes).sum(); };
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    if (likeness(i) > likeness(nearest)) nearest = i;
  }
  return stance.probabilities[nearest];
}

// Files have +Y or +Z up, whatever the shape says; the networks learned all 24 stances alike.
double priorOf(const AnatomicalFrame& frame) {
  return std::max(frame.axes(1, 1), frame.axes(1, 2)) > std::cos(kPi / 4) - 1e-6 ? 1 : kUnusualUp;
}

AnatomicalFrame likeliestFrame(const std::vector<AnatomicalFrame>& frames, const LearnedStance& stance) {
  const auto likelihood = [&](const AnatomicalFrame& frame) {
    const double probability = priorOf(frame) * std::max(probabilityOf(frame.axes, stance), kMinProbability);
    return std::log(probability) - frame.asymmetry / kAsymmetryScale;
  };
  return *std::max_element(frames.begin(), frames.end(), [&](const AnatomicalFrame& a, const AnatomicalFrame& b) {
    return likelihood(a) < likelihood(b);
  });
}

// ---- which skeleton

RoledSkeleton templateWithRoles(std::string_view name) {
  const TemplateSkeleton& skeleton = findTemplate(name);
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  const Skeleton rest = standingSkeleton(skeleton, positions, {});
  const std::vector<std::optional<RolePosition>> roles = jointRoles(rest, readAnatomy(rest));
  // Tips are among the template's joints, and no joints of the rest pose.
  RoledSkeleton made = {skeleton, {}};
  Index next = 0;
  for (TemplateJoint& joint : made.skeleton.joints) {
    if (joint.role == TemplateRole::kTip) {
      made.roles.push_back(made.roles[*joint.parent]);
    } else {
      made.roles.push_back(roles[next++]);
      joint.role = made.roles.back() ? TemplateRole::kPlaced : TemplateRole::kBetween;
    }
  }
  return made;
}

bool hasFingers(const RoleReading& reading) {
  return reading.fingers(Side::kLeft) + reading.fingers(Side::kRight) >= 8;
}

// What a plan gets where the user leaves the choice.
std::string kindOfPlan(std::string_view plan, const RoleReading& reading) {
  if (plan == "upright") return hasFingers(reading) ? "humanoid-fingers" : "humanoid";
  if (plan == "four") return "quadruped";
  if (plan == "bird") return "bird";
  if (plan == "many") return reading.has("midb_upper.L") && reading.has("midb_upper.R") ? "spider" : "insect";
  for (const BodyKind& kind : bodyKinds()) {
    if (kind.plan == plan) return std::string(kind.name);
  }
  return {};
}

RoledSkeleton skeletonNamed(std::string_view name, const RoleReading& reading) {
  const BodyKind* kind = findBodyKind(name);
  return kind ? skeletonOfKind(*kind, reading) : templateWithRoles(name);
}

// ---- its joints in the body

bool isMissing(const RoleReading& reading, const RolePosition& role) {
  return !reading.has(role.from) && !reading.has(role.to);
}

// Beyond the last joint of a limb: the end of its bone.
Vec3 tipOf(const RoledSkeleton& made, Index tip, const RoleReading& reading, const std::vector<Vec3>& positions) {
  const Index joint = made.skeleton.joints[tip].parent.value();
  const std::optional<Index> above = made.skeleton.joints[joint].parent;
  const Vec3 bone = above ? Vec3(positions[joint] - positions[*above]) : Vec3(0, 0.1, 0);
  if (made.roles[joint]) {
    if (const auto end = reading.boneEnd(partOfRole(made.roles[joint]->to), positions[joint])) return *end;
  }
  return positions[joint] + kTipBeyond * bone;
}

std::vector<Vec3> placed(const RoledSkeleton& made, const RoleReading& reading) {
  const std::vector<TemplateJoint>& joints = made.skeleton.joints;
  std::vector<Vec3> positions(joints.size(), Vec3::Zero());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].role == TemplateRole::kPlaced) positions[j] = reading.position(*made.roles[j]);
  }
  placeBetween(made.skeleton, positions);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].role == TemplateRole::kTip) positions[j] = tipOf(made, static_cast<Index>(j), reading, positions);
  }
  placeBetween(made.skeleton, positions);
  return positions;
}

// From where the reading has the joint. A raised heel, which refineHocks takes for the foot, is another role.
double strayed(const RolePosition& role, const RoleReading& reading, const Vec3& read, const Vec3& refined) {
  const double distance = (refined - read).norm();
  const std::string side = role.from.substr(role.from.size() - 2);
  std::string other;
  if (role.from.starts_with("hind_end")) other = "hind_hock" + side;
  if (role.from.starts_with("hind_toes")) other = "hind_end" + side;
  return other.empty() ? distance : std::min(distance, (refined - reading.position({other, other, 0})).norm());
}

// The shape of limbs shows where their joints are; what it shows far from where the reading has them is something else.
void refine(const RoledSkeleton& made, const BodyVolume& body, const RoleReading& reading,
            std::vector<Vec3>& positions) {
  const std::vector<Vec3> read = positions;
  const TemplateSkeleton& skeleton = made.skeleton;
  const TemplatePins pins(positions.size());
  refineHumanoid(skeleton, body, reading.frame(), pins, positions);
  placeBetween(skeleton, positions);
  refineHocks(skeleton, body, reading.frame(), pins, positions);
  refineQuadruped(skeleton, body, reading.frame(), pins, positions);
  for (std::size_t j = 0; j < positions.size(); ++j) {
    if (!made.roles[j] || skeleton.joints[j].role != TemplateRole::kPlaced) continue;
    const double reach = std::max(kLandmarkReach * reading.expectedError(*made.roles[j]), kMinReach);
    if (strayed(*made.roles[j], reading, read[j], positions[j]) > reach) positions[j] = read[j];
  }
  placeBetween(skeleton, positions);
}

// ---- how sure it is, and what to say of it

std::vector<TemplateLimb> limbsOf(const RoledSkeleton& made, const RoleReading& reading) {
  std::vector<TemplateLimb> limbs = limbChains(made.skeleton);
  for (TemplateLimb& limb : limbs) {
    bool hasRole = false, isThere = false;
    for (const Index joint : limb.joints) {
      // Few hands show their fingers: that they are not seen says nothing.
      if (!made.roles[joint] || made.roles[joint]->from.starts_with("finger")) continue;
      hasRole = true;
      isThere = isThere || !isMissing(reading, *made.roles[joint]);
    }
    limb.hasMatch = isThere || !hasRole;
  }
  return limbs;
}

// Of the plan, and the less the more limbs the body lacks.
double confidenceOf(double planProbability, const RoledSkeleton& made, const RoleReading& reading) {
  const std::vector<TemplateLimb> limbs = limbsOf(made, reading);
  double there = 0;
  for (const TemplateLimb& limb : limbs) there += limb.hasMatch ? 1.0 / static_cast<double>(limbs.size()) : 0;
  return planProbability * there * there * there;
}

std::vector<TemplateMatch> matchesOf(const RoleReading& reading, const ReadingWeights& weights) {
  std::vector<TemplateMatch> matches;
  for (const std::string& plan : weights.plans) {
    const std::string kind = kindOfPlan(plan, reading);
    if (kind.empty()) continue;
    matches.push_back({kind, confidenceOf(reading.probability(plan), skeletonNamed(kind, reading), reading)});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const TemplateMatch& a, const TemplateMatch& b) { return a.confidence > b.confidence; });
  return matches;
}

// Ends of limbs whose joints may be farthest from the truth, one of each pair, first things first; those that the body
// lacks come before all.
std::vector<std::string> doubtsOf(const RoledSkeleton& made, const RoleReading& reading) {
  const std::vector<TemplateJoint>& joints = made.skeleton.joints;
  struct Doubt {
    Index joint;
    double error;
  };
  std::vector<Doubt> doubts;
  for (const TemplateLimb& limb : limbsOf(made, reading)) {
    const Index end = limb.joints.back();
    if (!made.roles[end] || made.roles[end]->from.starts_with("finger")) continue;
    if (joints[end].name.starts_with("right")) continue;
    doubts.push_back({end, (limb.hasMatch ? 0 : kMissing) + reading.expectedError(*made.roles[end])});
  }
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) { return a.error > b.error; });
  std::vector<std::string> names;
  for (const Doubt& doubt : doubts) {
    if (names.size() < kMaxDoubts && doubt.error > kDoubtfulJoint) names.push_back(joints[doubt.joint].name);
  }
  return names;
}

}  // namespace

std::optional<ReadTemplate> readTemplate(const TriMesh& mesh, const BodyVolume& body,
                                         const std::vector<AnatomicalFrame>& frames, const ReadingWeights& weights) {
  const SurfaceSamples samples = sampleSurface(mesh, weights.sampleCount());
  ReadTemplate result;
  result.frame = likeliestFrame(frames, stanceOf(samples, weights));
  RoleReading reading(samples, weights, result.frame);
  result.matches = matchesOf(reading, weights);
  if (result.matches.empty() || result.matches.front().confidence < kSureTemplate) return std::nullopt;
  if (result.frame.symmetric()) reading.makeSymmetric();
  RoledSkeleton made = skeletonNamed(result.matches.front().name, reading);
  result.positions = placed(made, reading);
  refine(made, body, reading, result.positions);
  result.limbs = limbsOf(made, reading);
  result.doubts = doubtsOf(made, reading);
  std::erase_if(result.matches, [&](const TemplateMatch& match) { return match.confidence < kWorthNaming; });
  result.skeleton = std::move(made.skeleton);
  return result;
}

}  // namespace limber
