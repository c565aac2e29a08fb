// retargetOnto's counterpart for programs of the user's.
#pragma once

#include <vector>

#include "limber/actions/motion/retarget_asset.h"
#include "limber/adapters/adapter.h"
#include "limber/character/character.h"
#include "limber/core/progress.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct ProgramClips {
  std::vector<RetargetedClip> clips;  // without maps: the program matches joints for itself
  Warnings warnings;                  // of readReturnedMotion
};

// By an adapter of kind retarget: a clip for each clip of `motion`, each by a run of its own, added to the document as
// retargetOnto adds them, as the program has them: nothing of limber's is done to feet or smoothness. A character or a
// motion that lies in rest pose is handed over standing. Of the options count `frameRate` and `turn`. Throws as
// retargetOnto does where the document cannot move or the motion has no clip, and as runProgram and readReturnedMotion;
// the document is then as it was.
ProgramClips retargetByProgram(Asset& asset, const Character& character, const Motion& motion, const Adapter& adapter,
                               const RetargetAssetOptions& options, Progress& progress);

}  // namespace limber
