// How good a rigged model is, with nothing to compare it with.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/deform/linear_blend.h"
#include "limber/evaluate/rig/joint_placement.h"
#include "limber/evaluate/skin/surface_stretch.h"
#include "limber/evaluate/skin/weight_quality.h"

namespace limber {

// What the surface does in one pose, or in several in the mean.
struct SurfaceChange {
  SurfaceStretch stretch;
  // By how much a texture is stretched more than at rest, as a fraction: L2 stretch over that at rest, less 1. None
  // where there are no texture coordinates.
  std::optional<double> texture;
  double volumeLoss = 0;  // fraction of the volume at rest, less than 0 where there is more; 0 where it is next to none
};

struct PoseChange {
  std::string pose;  // "elbows"
  SurfaceChange change;
};

struct MotionQuality {
  std::string deformer;        // by which the surface moves
  SurfaceChange mean;          // over the poses; volumeLoss: those that gain some count as 0
  double selfPenetration = 0;  // SelfPenetration::mean
  std::string maxPenetrating;  // the pose in which the most goes inside; empty where nothing does
  std::vector<PoseChange> poses;
};

struct ModelQuality {
  Index joints = 0;
  double idleJoints = 0;  // fraction of the joints that move nothing (not among countedJoints)
  JointPlacement placement;
  std::optional<double> coverage;   // boneCoverage
  std::optional<double> asymmetry;  // jointAsymmetry
  WeightQuality weights;
  std::optional<MotionQuality> motion;  // in rangeOfMotion; none where the body has no part that moves
};

// Weights are cut to the four strongest of each vertex, as glTF readers do, whatever the deformer, so that all bend the
// same rig. The deformer changes `motion` alone. Two models are compared by these figures only where the surface is the
// same: they depend on how it is cut into triangles, and how thick a body is.
//
// uvs       of the model's vertices, or empty
// deformer  of deformers()
// Throws Error kBadData where a weight names a joint that is not there, and as prepareMesh and readAnatomy do.
ModelQuality measureModel(const SkinnedModel& model, std::span<const Vec2f> uvs = {},
                          const Deformer& deformer = kLinearBlendDeformer);
// With the texture coordinates TEXCOORD_0 of the file. Throws Error kUnsupported where it has no rig.
ModelQuality measureModel(const Character& character, const Deformer& deformer = kLinearBlendDeformer);

// Every figure by its name; null for what there is not.
Json toJson(const ModelQuality& quality);

// A few lines for a terminal.
std::string toText(const ModelQuality& quality);

}  // namespace limber
