// Several motions onto the character in a document as one.
#pragma once

#include <span>
#include <vector>

#include "limber/actions/motion/retarget_asset.h"

namespace limber {

struct CombineOptions {
  std::vector<double> blendWeights;  // a clip for each, of two motions: 0 the first, 1 the second (blendMotions)
  double crossfadeSeconds = 0.3;     // without weights: one after the other (joinMotions)
};

// Each motion goes onto the character as retargetOnto takes it there, then they are combined. The clips that are added
// are the combined ones alone, called "walk_run_0.40" by the weight, or "walk_run_jump". Reports are those of the first
// motion, but for names, frames and rates. What blendMotions and joinMotions warn of is added to the asset's warnings.
// Throws as retargetOnto, blendMotions and joinMotions do, and Error kBadArgument where the motions have not as many
// clips: two for a blend, two or more else.
std::vector<RetargetedClip> combineOnto(Asset& asset, const Character& character, std::span<const Motion> motions,
                                        const RetargetAssetOptions& options, const CombineOptions& combine);

}  // namespace limber
