// From an Asset to a rigged Asset: every stage in order. The command line, the studio and WebAssembly all call this.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber {

struct RigCheck;

// What to do with a model that has a rig of its own.
enum class ExistingRig {
  kRefuse,        // throw Error kUnsupported that names both alternatives
  kReplace,       // take it out first
  kKeepSkeleton,  // keep it, make only the weights anew; no rigger runs
};

struct AutoRigOptions {
  std::string rigger = "sphere-mesh";
  std::string skinning = "bone-heat";
  RigOptions rig;  // pins in world space
  WeightOptions weights;
  ExistingRig existingRig = ExistingRig::kRefuse;
  bool chains = false;  // appendages get joints of their own that swing (HangingChain), where a rigger finds bodies
  bool standUpright = false;  // rotate a model whose up axis is not +Y; else there is a warning
  // Called with the check of the body (checkRigging) before a rigger that looks for limbs begins, which reads the body
  // no second time.
  std::function<void(const RigCheck&)> onCheck = {};
};

// A node whose mesh has vertices that no bone reaches.
struct BridgedNode {
  std::string name;                 // "nodes[3]" where it has none
  Index vertices = 0, bridged = 0;  // as the scene shows them; those that took the weights of what is nearest
};

struct AutoRigReport {
  std::string rigger, skinning;  // the methods that ran; no rigger where the skeleton was kept
  Index sourceVertices = 0, weldedVertices = 0, triangles = 0, pieces = 0, joints = 0;
  Index maxInfluences = 0;                    // as asked for
  Index removedJoints = 0, removedClips = 0;  // of the old rig, with ExistingRig::kReplace
  std::vector<HandleSuggestion> suggestions;
  bool isAbstained = false;            // handles instead of a template (AutoRig)
  std::vector<TemplateMatch> matches;  // as in AutoRig
  std::vector<std::string> chains;     // names of chains that got joints of their own (AutoRigOptions::chains)
  std::vector<std::string> doubts;     // ambiguous joints, whose pins would settle most (AutoRig)
  std::vector<BridgedNode> bridged;    // most vertices first
  Warnings warnings;                   // of reading and of every stage
  std::vector<StageTime> stages;
};

// Rigs in place. Warnings of its own: bridged-pieces and bridged-vertices (`where` is the node that has most of them),
// single-joint (the kept skeleton moves everything by one joint), turned-upright and not-upright (where a template is
// sure, or `rig.up` says, that the model's up axis is not +Y), maybe-not-upright (where it is not sure).
// On an Error, whose where() begins with the asset's name, the asset is as it was.
AutoRigReport autoRig(Asset& asset, const AutoRigOptions& options, Progress& progress);

}  // namespace limber
