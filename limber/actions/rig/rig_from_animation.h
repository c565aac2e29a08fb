// From a mesh that moves to a rigged one: bones, weights and clips that do what the vertices did.
#pragma once

#include "limber/actions/motion/vertex_animation.h"
#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/rigging/decomposition/skin_decomposition.h"

namespace limber {

struct AnimationRigReport {
  Index sourceVertices = 0, points = 0;  // as the scene shows them; distinct trajectories
  Index frames = 0, clips = 0, joints = 0;
  Index maxInfluences = 0;
  double error = 0;  // root mean square over points and frames, of the rest pose's diagonal
  std::vector<StageTime> stages;
  Warnings warnings;
};

// Rigs in place: the animation of `asset` (readVertexAnimation, or frames from elsewhere for its vertices) becomes
// joints, weights and clips (decomposeSkin, skeletonOfBones). Materials, texture coordinates, normals and the rest pose
// stay; the rig, the morph targets and the animations that the meshes had go. The animation is taken over.
// Throws as decomposeSkin does, with the asset's name; the asset is then as it was.
AnimationRigReport rigFromAnimation(Asset& asset, VertexAnimation animation, const DecompositionOptions& options,
                                    Progress& progress);

}  // namespace limber
