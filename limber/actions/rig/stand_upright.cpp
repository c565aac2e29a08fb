#include "limber/actions/rig/stand_upright.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/character/matching/neutral_pose.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/rotation.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/scene/turn_scene.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {

namespace {

constexpr const char *kName = "upright", *kTurned = "turned-upright";

Eigen::Index nearestAxis(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

bool isUpright(const Vec3& up) {
  return nearestAxis(up) == 1 && up.y() > 0;
}

std::string nameOfAxis(const Vec3& direction) {
  const Eigen::Index axis = nearestAxis(direction);
  return fmt::format("{}{}", direction[axis] < 0 ? '-' : '+', "XYZ"[axis]);
}

// The rotation of `up` onto +Y; a model that is upside down keeps its facing direction.
Quat turnOf(const Vec3& up) {
  const Eigen::Index axis = nearestAxis(up);
  const Vec3 along = std::copysign(1.0, up[axis]) * Vec3::Unit(axis);
  return axis == 1 && up.y() < 0 ? Quat(0, 0, 0, 1) : shortestRotation(along, Vec3::UnitY());
}

// A body with a head and two legs, each named, so that no form in another pose misleads.
bool isNamedBiped(const Anatomy& anatomy) {
  const auto body = anatomy.certainBody();
  const auto isNamed = [](const Part* part) { return part->evidence != Evidence::kForm; };
  return anatomy.pairsOf(PartKind::kLeg) == 1 && body && std::all_of(body->begin(), body->end(), isNamed);
}

// From a rest pose that lies to clips of which most begin upright along +Y; else the identity.
Quat turnOfClips(const Motion& motion, const SkeletonReading& skeleton) {
  const Quat turn = turnToStand(skeleton);
  if (turn.isApprox(Quat::Identity())) return turn;
  std::size_t standing = 0;
  for (const Clip& clip : motion.clips) {
    Pose pose = restPose(motion.skeleton);
    sampleClip(clip, 0, pose);
    const std::optional<Vec3> now = uprightAxis(skeleton, pose);
    if (now && isUpright(*now)) ++standing;
  }
  return 2 * standing > motion.clips.size() ? turn : Quat::Identity();
}

std::optional<Vec3> restsAlong(const Character& character) {
  return uprightAxis(character.reading(), restPose(character.skeleton()));
}

}  // namespace

std::optional<Vec3> uprightAxis(const SkeletonReading& reading, const Pose& pose) {
  const Skeleton& skeleton = reading.skeleton();
  if (!hasForm(skeleton, pose) || !isNamedBiped(reading.anatomy())) return {};
  const SkeletonMap map = matchSkeletons(reading, reading);
  if (!map.isBiped() || !isUpright(skeleton, pose, map, MapSide::kTarget)) return {};
  return neutralPose(skeleton, pose, map, MapSide::kTarget, {}).toBody.conjugate() * Vec3::UnitY();
}

Quat turnToStand(const SkeletonReading& reading) {
  const std::optional<Vec3> up = uprightAxis(reading, restPose(reading.skeleton()));
  return up && !isUpright(*up) ? turnOf(*up) : Quat::Identity();
}

void standUpright(Asset& asset, const Vec3& up, bool turn, Warnings& warnings) {
  if (isUpright(up)) return;
  if (turn) {
    turnScene(asset, turnOf(up), kName);
    warnings.add(kTurned, fmt::format("the model stands along {} and is turned to stand along +Y", nameOfAxis(up)));
  } else {
    warnings.add("not-upright", fmt::format("the model stands along {} and lies where +Y is up", nameOfAxis(up)));
  }
}

void warnMaybeLies(const Vec3& up, double confidence, Warnings& warnings) {
  if (isUpright(up)) return;
  warnings.add("maybe-not-upright", fmt::format("the model may stand along {} and lie where +Y is up ({:.0f} % sure)",
                                                nameOfAxis(up), 100 * confidence));
}

UprightCharacter standUpright(Asset& asset, Warnings& warnings) {
  const Character character(asset);
  const std::optional<Vec3> up = restsAlong(character);
  if (!up || isUpright(*up)) return {character};
  const Quat turn = turnOfClips(motionOf(asset, character.moving()), character.reading());
  if (turn.isApprox(Quat::Identity())) {
    gltf::Document before = asset.document;
    Warnings turned;
    standUpright(asset, *up, true, turned);
    const Character standing(asset);
    if (const std::optional<Vec3> now = restsAlong(standing); now && isUpright(*now)) {
      warnings.append(turned);
      return {standing};
    }
    asset.document = std::move(before);  // skins may be bound to where their mesh lies
  }
  warnings.add(kTurned,
               fmt::format("the model rests along {}; the new clips are turned to stand along +Y", nameOfAxis(*up)));
  return {character, turnOf(*up)};
}

Motion asItRests(Motion motion, const SkeletonReading& skeleton) {
  const Quat back = turnOfClips(motion, skeleton).conjugate();
  for (Clip& clip : motion.clips) clip = turnClip(std::move(clip), motion.skeleton, back);
  return motion;
}

}  // namespace limber
