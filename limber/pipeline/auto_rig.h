// From an Asset to a rigged Asset: every stage in order. The command line, the studio and WebAssembly all call this.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/core/progress.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/skinning/weight_method.h"

namespace limber {

// What to do with a model that has a rig of its own.
enum class ExistingRig {
  kRefuse,        // throw Error kUnsupported that names both ways out
  kReplace,       // take it out first
  kKeepSkeleton,  // keep it, make only the weights anew; no rigger runs
};

struct AutoRigOptions {
  std::string rigger = "sphere-mesh";
  std::string skinning = "bone-heat";
  RigOptions rig;
  WeightOptions weights;
  ExistingRig existingRig = ExistingRig::kRefuse;
};

struct AutoRigReport {
  Index sourceVertices = 0, weldedVertices = 0, triangles = 0, pieces = 0, joints = 0;
  std::vector<HandleSuggestion> suggestions;
  Warnings warnings;  // of reading and of every stage
  std::vector<StageTime> stages;
};

// Rigs in place. On an Error the asset is as it was.
AutoRigReport autoRig(Asset& asset, const AutoRigOptions& options, Progress& progress);

}  // namespace limber
