// Characters as they stand at a moment of one of their clips.
#pragma once

#include <string>

#include "limber/asset/asset.h"

namespace limber {

struct ClipMoment {
  std::string clip;    // as findClip reads it; empty: the first
  double seconds = 0;  // before its start and after its end the clip stands still
};

// Makes the pose of that moment the rest pose of the model (setRestPose): a still model whose true skeleton is known.
// Throws Error kBadArgument where it has no such clip, or none at all, and as setRestPose does.
void standAt(Asset& asset, const ClipMoment& moment);

}  // namespace limber
