// Models that stand along another axis than +Y, as programs with Z up write them without a turn.
#pragma once

#include <optional>

#include "limber/character/character.h"
#include "limber/core/error.h"
#include "limber/document/asset.h"
#include "limber/skeleton/motion.h"
#include "limber/skeleton/pose.h"

namespace limber {

// The up axis of a person in that pose; none where the names of joints are not a person's, where the pose
// has no form (hasForm), or where head and feet lie to the same side of the hips.
std::optional<Vec3> uprightAxis(const SkeletonReading& skeleton, const Pose& pose);

// The rotation to +Y of a person whose up axis in rest pose is another; the identity for all others.
Quat turnToStand(const SkeletonReading& skeleton);

// Rotates a document whose up axis is the one nearest to `up` by a node above it (turnScene), with a warning
// "turned-upright"; where `turn` is false there is only the warning "not-upright". Nothing where up is about +Y.
void standUpright(Asset& asset, const Vec3& up, bool turn, Warnings& warnings);

// A warning "maybe-not-upright" where it is not certain that the model's up axis is another than +Y.
void warnMaybeLies(const Vec3& up, double confidence, Warnings& warnings);

// As standUpright, of a person's skeleton in a document, before clips are added. Where its clips stand and its rest
// pose lies, or where no node above it helps, the document stays as it is: new clips then need `turn`, else none.
struct UprightCharacter {
  Character character;  // of the document as it is now
  Quat turn = Quat::Identity();
};
UprightCharacter standUpright(Asset& asset, Warnings& warnings);

// A motion whose clips stand along +Y while its rest pose lies: with its clips turned to lie as well, so that one is
// measured against the other. Any other as it is.
//
// skeleton  of the motion
Motion asItRests(Motion motion, const SkeletonReading& skeleton);

}  // namespace limber
