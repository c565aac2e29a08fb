// A rigged model's surface in pose after pose.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "limber/deform/linear_blend.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "limber/skeleton/pose.h"

namespace limber {

// What the deformer needs of the surface is prepared once. Model and deformer must outlive it.
class ModelPoser {
 public:
  // The model's weights have a sum of 1 or 0 at each vertex. Throws Error kBadData as checkWeights does, and as
  // prepareDeformer.
  explicit ModelPoser(const SkinnedModel& model, const Deformer& deformer = kLinearBlendDeformer);

  // positions  #V, to be written
  // Throws Error kBadArgument where their number is another.
  void pose(const Pose& pose, std::span<Vec3f> positions);

 private:
  const SkinnedModel& model_;
  const Deformer& deformer_;
  std::vector<Vec3> centers_;  // of joints
  std::shared_ptr<const DeformPreparation> prepared_;
  std::vector<float> scratch_;
};

}  // namespace limber
