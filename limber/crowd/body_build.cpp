#include "limber/crowd/body_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "limber/character/anatomy/body_part.h"
#include "limber/character/character.h"
#include "limber/core/random.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

// What a part's bones are multiplied by; hands, feet and heads keep their form.
struct BoneFactors {
  double along = 1, across = 1;
};

// The ankle or wrist, or behind it?
bool isLimbEnd(const Part& part, Index joint) {
  if (!part.end) return false;
  const auto end = std::find(part.joints.begin(), part.joints.end(), *part.end);
  return std::find(end, part.joints.end(), joint) != part.joints.end();
}

// None for what goes along with the joint above it.
std::optional<BoneFactors> factorsOf(const Anatomy& anatomy, Index joint, const BodyBuild& build) {
  if (!anatomy.partOf[joint]) return std::nullopt;
  const Part& part = anatomy.parts[*anatomy.partOf[joint]];
  const double plain = build.height;
  switch (part.kind) {
    case PartKind::kTrunk:
    case PartKind::kTail:
      return BoneFactors{plain * build.trunk, plain * build.girth};
    case PartKind::kNeck:
      return BoneFactors{plain, plain * build.girth};
    case PartKind::kHead:
      return BoneFactors{plain * build.head, plain * build.head};
    case PartKind::kLeg:
      if (isLimbEnd(part, joint)) return BoneFactors{plain, plain};
      return BoneFactors{plain * build.legs, plain * build.girth};
    case PartKind::kArm:
    case PartKind::kWing:
    case PartKind::kFin:
      if (isLimbEnd(part, joint)) return BoneFactors{plain, plain};
      return BoneFactors{plain * build.arms, plain * build.girth};
    default:
      return std::nullopt;
  }
}

// #J unit vectors in the joints' own frames, of those that have a bone.
std::vector<std::optional<Vec3>> boneDirections(const Skeleton& skeleton) {
  std::vector<std::optional<Vec3>> directions(skeleton.joints.size());
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (const Bone& bone : bonesOf(skeleton)) {
    if (directions[bone.joint]) continue;
    const Vec3 along = globals[bone.joint].linear().inverse() * (bone.b - bone.a);
    if (along.allFinite() && along.norm() > 0) directions[bone.joint] = along.normalized();
  }
  return directions;
}

std::vector<Mat3> stretchesFor(const Character& character, const BodyBuild& build) {
  const Skeleton& skeleton = character.skeleton();
  const Anatomy& anatomy = character.anatomy();
  const std::vector<std::optional<Vec3>> directions = boneDirections(skeleton);
  std::vector<Mat3> stretches;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<BoneFactors> factors = factorsOf(anatomy, j, build);
    const bool isEven = factors && factors->along == factors->across;
    if (factors && (isEven || directions[j])) {
      const Vec3 along = isEven ? Vec3(Vec3::UnitX()) : *directions[j];
      stretches.push_back(factors->across * Mat3::Identity() +
                          (factors->along - factors->across) * along * along.transpose());
    } else if (const std::optional<Index> parent = skeleton.joints[j].parent) {
      const Mat3 turn = skeleton.joints[j].rest.rotation.toRotationMatrix();
      stretches.push_back(turn.transpose() * stretches[*parent] * turn);
    } else {
      stretches.push_back(build.height * Mat3::Identity());
    }
  }
  return stretches;
}

double lowestOf(const Character& character) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3f& position : character.surface().positions) {
    lowest = std::min(lowest, static_cast<double>(position.y()));
  }
  return lowest;
}

void checkBuild(const BodyBuild& build) {
  for (const double factor : {build.height, build.legs, build.arms, build.trunk, build.girth, build.head}) {
    if (!(factor > 0) || !std::isfinite(factor)) {
      throw Error(ErrorCode::kBadArgument, "a factor of a build is not positive and finite");
    }
  }
}

}  // namespace

BodyBuild randomBuild(std::uint64_t seed, double variety) {
  Random random(seed);
  const auto factor = [&](double deviation) { return 1 + variety * deviation * random.normal(); };
  BodyBuild build;
  build.height = factor(0.04);
  build.legs = factor(0.03);
  build.arms = factor(0.03);
  build.trunk = factor(0.03);
  build.girth = factor(0.1);
  build.head = factor(0.02);
  return build;
}

void changeBuild(Asset& asset, const BodyBuild& build) {
  checkBuild(build);
  removeChannels(asset, [](Index, std::string_view) { return true; });
  const Character given(asset);
  const double lowest = lowestOf(given);
  const Warnings before = asset.warnings;
  const Skeleton& skeleton = given.binding().skeleton;
  const std::vector<Mat3> stretches = stretchesFor(given, build);
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Vec3& offset = pose.locals[j].translation;
    if (const std::optional<Index> parent = skeleton.joints[j].parent) {
      offset = stretches[*parent] * offset;
    } else {
      offset *= build.height;
    }
  }
  setRestPose(asset, given.binding(), pose, stretches);
  const Character built(asset);
  const double lift = lowest - lowestOf(built);
  const Skeleton& grown = built.binding().skeleton;
  Pose lifted = restPose(grown);
  for (Index j = 0; j < grown.jointCount(); ++j) {
    if (!grown.joints[j].parent) lifted.locals[j].translation.y() += lift;
  }
  setRestPose(asset, built.binding(), lifted);
  asset.warnings = before;  // that surfaces are shared by joints is no loss: there are no clips
}

}  // namespace limber
