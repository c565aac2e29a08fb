// Rig transfer between documents: the rig of one Asset on the model of another.
#pragma once

#include <string>
#include <vector>

#include "limber/actions/transfer/transfer_colors.h"
#include "limber/character/character.h"
#include "limber/core/progress.h"
#include "limber/rigging/transfer/rig_transfer.h"

namespace limber {

struct TransferAssetOptions {
  RigTransferOptions rig;
  bool blendShapes = true;
  ColorTransfer colors;     // where the target is to have the source's (transferColors)
  bool ownSkeleton = true;  // a target that has a rig tells by it where its joints are; else it is read as bare
};

struct TransferReport {
  Index sourceVertices = 0, targetVertices = 0;  // welded
  Index joints = 0, landmarks = 0;
  Index removedJoints = 0, removedClips = 0;  // of the target's old rig
  std::string landmarksBy;                    // "its own skeleton", or a template's name
  double confidence = 1;                      // in that template, 0 to 1
  std::vector<std::string> blendShapes;       // that came along
  SurfaceGaps gaps;
  Warnings warnings;
  std::vector<StageTime> stages;
};

// Gives `target` the rig of `source`: its joints with their names, tree and axes, its weights, and its blend shapes
// where the target's meshes have none. The target's old rig goes, with its clips. The source stays as it is. With
// options.colors the target's own colours go, too.
//
// What only one of them wears or holds (findAccessories) is no part of the body: the target's follows one joint, with a
// warning "accessories"; the source's is left out. Nodes of the target that have a joint's name get another.
//
// Where the target has no rig, a template is fitted to both bodies (rigWithTemplate) to tell where the limbs are.
// Throws Error kUnsupported where the source has no rig or a body has no limbs that can be told, and as the stages do;
// the target is then as it was. where() begins with an asset's name.
TransferReport transferOnto(const Character& source, Asset& target, const TransferAssetOptions& options,
                            Progress& progress);

// {"rms", "p95", "worst" (% of the height), "beyond" (part of the surface, 0 to 1), "limit" (% of the height, beyond
// which it counts), "parts": [{"part", "area", "rms", "beyond"}]} (SurfaceGaps)
Json toJson(const SurfaceGaps& gaps);
// The report as JSON, keys in snake_case.
Json toJson(const TransferReport& report);

}  // namespace limber
