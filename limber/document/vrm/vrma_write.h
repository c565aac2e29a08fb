// Motions for VRMs: files that move any avatar, whatever its joints are called (VRMC_vrm_animation 1.0).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/vrm/t_pose.h"
#include "limber/skeleton/humanoid_bones.h"
#include "limber/skeleton/motion.h"

namespace limber {

// How much of an expression is shown over time, 0 to 1.
struct ExpressionTrack {
  std::string name;
  bool isPreset = true;  // one of vrmExpressionNames(); else the model's own
  Track<float> weight;
};

// Those that a clip of a model moves: of a VRM its own expressions, else those that blend shapes are called after
// (expressionsByName). An expression of several blend shapes counts where all of them move as one.
std::vector<ExpressionTrack> expressionTracks(const Asset& asset, Index animation);

// One clip as nodes without a mesh: a node for each bone, as `rest` has them but without rotations; rotations of all
// bones, and the trajectory of the hips. Rotations are those of whole bones: what joints between two bones do is part
// of the lower one's. Keys are the clip's own; where those of several joints meet in a bone, or curves are cubic, 60
// keys a second are added between them. Such a file cannot represent other joints or animated lengths and scales: a
// warning "vrma-lengths" is added to the asset's where joints of bones are therefore more than 0.001 of the skeleton's
// size from their positions in the clip, with the largest distance in metres. Nor can it represent eyes and the
// expressions lookUp, lookDown, lookLeft and lookRight: a warning "vrma-gaze" where the clip moves some.
//
// bones  vrmBones of the clip's skeleton
Asset vrmAnimation(const Skeleton& skeleton, const Clip& clip, const TPose& rest, std::span<const HumanoidJoint> bones,
                   std::span<const ExpressionTrack> expressions = {});

// Is the name that of such a motion, ".vrma" in any case?
bool isVrmaFormat(const std::filesystem::path& path);

}  // namespace limber
