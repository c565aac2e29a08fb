// Weights of a file that are no weights.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Gives primitives with weights that are negative or not finite new ones, in which these are 0 and the vertex's others
// sum to 1 (warning "bad-weights" counts them); all others keep their bytes. Vertices of skinned meshes without any
// weight stay so (warning "unweighted-vertices"). The asset has passed checkAsset.
void repairWeights(Asset& asset);

}  // namespace limber
