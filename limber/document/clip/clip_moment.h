// Characters as they stand at a moment of one of their clips.
#pragma once

#include <string>

#include "limber/document/asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/shape_surface.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct ClipMoment {
  std::string clip;    // as findClip reads it; empty: the first
  double seconds = 0;  // clamped to the clip's start and end
};

// How the joints stand then, those that the clip does not move as the file's nodes do. Of `skeleton`,
// readSkeleton(asset). Throws Error kBadArgument where the model has no such clip, or none at all.
Pose poseAt(const Asset& asset, const AssetSkeleton& skeleton, const ClipMoment& moment);

// The weights of blend shapes then. Throws Error kBadArgument where the model has no such clip.
ShapeWeights shapesAt(const Asset& asset, const ClipMoment& moment);

// Makes the pose of that moment the rest pose of the model (setRestPose): a still model whose true skeleton is known.
// Throws as poseAt and setRestPose do.
void standAt(Asset& asset, const ClipMoment& moment);

}  // namespace limber
