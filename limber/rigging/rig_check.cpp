#include "limber/rigging/rig_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/loose_vertices.h"
#include "limber/rigging/kind_choice.h"
#include "limber/rigging/measured_model.h"

namespace limber {

namespace {

// Degrees that arms hang below level, and that legs are off straight down or straight.
constexpr double kLevel = 22, kLowered = 62, kBentArm = 50, kSpreadLeg = 30, kBentLeg = 35;

double degreesBetween(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / kPi;
}

// Of one side.
BodyPose poseOf(const RoleReading& reading, const std::string& side) {
  const auto position = [&](const char* role) { return reading.position(atRole(role + side)); };
  const Vec3 thigh = position("hind_middle") - position("hind_upper"),
             shin = position("hind_end") - position("hind_middle");
  if (degreesBetween(thigh, -Vec3::UnitY()) > kSpreadLeg || degreesBetween(thigh, shin) > kBentLeg) {
    return BodyPose::kOther;
  }
  const Vec3 arm = position("fore_middle") - position("fore_upper"),
             forearm = position("fore_end") - position("fore_middle");
  const double below = 90 - degreesBetween(arm, -Vec3::UnitY());
  const bool isSideways = std::abs(arm.z()) < std::hypot(arm.x(), arm.y());
  if (degreesBetween(arm, forearm) > kBentArm || !isSideways || below < -kLevel) return BodyPose::kOther;
  return below < kLevel ? BodyPose::kT : below < kLowered ? BodyPose::kA : BodyPose::kHanging;
}

std::optional<BodyPose> poseOf(const RoleReading& reading) {
  for (const char* role : {"fore_upper.L", "fore_end.L", "hind_upper.L", "hind_end.L"}) {
    if (!reading.has(role)) return std::nullopt;
  }
  const BodyPose left = poseOf(reading, ".L"), right = poseOf(reading, ".R");
  return left == right ? left : BodyPose::kOther;
}

std::vector<std::string> missingOf(const RoledSkeleton& made, const RoleReading& reading) {
  std::vector<std::string> missing;
  for (const TemplateLimb& limb : limbsOf(made, reading)) {
    if (!limb.isThere) missing.push_back(missingLimbs(made.skeleton, std::vector<TemplateLimb>{limb}));
  }
  return missing;
}

}  // namespace

std::string_view nameOf(BodyPose pose) {
  constexpr std::array<std::string_view, 4> kNames = {"T", "A", "hanging", "other"};
  return kNames[static_cast<std::size_t>(pose)];
}

RigCheck checkRigging(const TriMesh& mesh, const RigOptions& options) {
  const std::optional<BareSurface> bare = withoutLooseVertices(mesh);  // as riggers are given it
  const TriMesh& surface = bare ? bare->mesh : mesh;
  const std::shared_ptr<const MeasuredModel> measured = measureModel(surface, options);
  const RoleReading& reading = measured->reading;
  RigCheck check;
  check.kinds = matchesOf(reading, *measured->weights, measured->fingers, measured->legs);
  dropUnlikely(check.kinds);
  const TemplateMatch& likeliest = check.kinds.front();
  check.isSure = likeliest.confidence >= kSureTemplate;
  check.isUpright = measured->frame().axes(1, 1) > std::cos(kPi / 4);
  const BodyKind& kind = findBodyKind(likeliest.name);
  if (reading.probability(kind.plan) < kLikelyTemplate) return check;  // what a thing lacks says nothing
  const RoledSkeleton made = skeletonOfKind(kind, reading);
  if (kind.plan == "upright") check.pose = poseOf(reading);
  check.missing = missingOf(made, reading);
  check.grownTogether = grownTogether(measured->cleared ? *measured->cleared : surface, reading);
  check.doubts = doubtsOf(made, reading, TemplatePins(made.skeleton.joints.size()));
  return check;
}

}  // namespace limber
