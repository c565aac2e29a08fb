// autoRig's counterpart for programs of the user's: what they give is attached to the untouched model.
#pragma once

#include "limber/actions/rig/auto_rig.h"
#include "limber/adapters/adapter.h"

namespace limber {

// Rigs in place by an adapter of kind rig. Of the options count `existingRig` (not kKeepSkeleton), `weights` and, where
// the program gives a skeleton alone, `skinning`; the report names the adapter as the rigger, and as the skinning
// method where the weights are its own. The program gets the surface that limber's own methods read (readFigureToRig);
// what is left out of it is bound by bindLeftOut. Warnings of its own: those of readReturnedRig.
// Throws as runProgram and readReturnedRig do, and as autoRig does for a model with a rig; the asset is then as it was.
AutoRigReport rigByProgram(Asset& asset, const Adapter& adapter, const AutoRigOptions& options, Progress& progress);

// Makes the weights of a rigged model anew by an adapter of kind weights, likewise; the skeleton stays. Returned
// joints are matched by their names, else by their positions. Throws likewise, and Error kBadData where a joint that
// moves something is none of the model's.
Warnings weightsByProgram(Asset& asset, const Adapter& adapter, const WeightOptions& options, Progress& progress);

}  // namespace limber
