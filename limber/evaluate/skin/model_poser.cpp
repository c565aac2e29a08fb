#include "limber/evaluate/skin/model_poser.h"

namespace limber {

ModelPoser::ModelPoser(const SkinnedModel& model, const Deformer& deformer) : model_(model), deformer_(deformer) {
  const Index joints = model.skeleton.jointCount();
  checkWeights(model.weights, joints);
  centers_ = restPositions(model.skeleton);
  prepared_ = prepareDeformer(deformer, {model.mesh.positions, model.mesh.triangles, model.weights}, joints);
  scratch_.resize(deformer.scratchSize(model.mesh.positions.size(), joints));
}

void ModelPoser::pose(const Pose& pose, std::span<Vec3f> positions) {
  const std::vector<Affine> transforms = skinTransforms(model_.skeleton, pose);
  deformer_.deform({model_.mesh.positions, {}, model_.weights, transforms, centers_, prepared_.get()}, {positions, {}},
                   scratch_);
}

}  // namespace limber
