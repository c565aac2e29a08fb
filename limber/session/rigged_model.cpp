#include "limber/session/rigged_model.h"

#include <algorithm>
#include <utility>

#include "limber/asset/pose_io.h"
#include "limber/skinning/deformer.h"

namespace limber {

namespace {

constexpr double kShareOfBone = 1.0 / 6, kLeastShare = 1e-3;

std::shared_ptr<RiggedModel> readModel(Asset asset) {
  auto model = std::make_shared<RiggedModel>();
  model->asset = std::move(asset);
  model->geometry = collectGeometry(model->asset);
  model->normals = readNormals(model->asset, model->geometry);
  model->binding = readSkeleton(model->asset);
  model->inverseBind = inverseBindOf(model->skeleton());
  model->weights = readWeights(model->asset, model->geometry, model->binding);
  normalizeWeights(model->weights);
  model->home = restPose(model->skeleton());
  Box box;
  for (const Vec3f& position : model->geometry.positions) box.add(position.cast<double>());
  model->radii = handleRadii(model->skeleton(), box.longestSide());
  return model;
}

}  // namespace

std::shared_ptr<const RiggedModel> openRiggedModel(const Asset& source) {
  if (!hasRig(source)) throw Error(ErrorCode::kBadArgument, "the model has no rig", source.name);
  return readModel(source.clone());
}

std::shared_ptr<const RiggedModel> makeRiggedModel(const Asset& source, const AutoRigOptions& options,
                                                   Progress& progress) {
  Asset asset = source.clone();
  AutoRigReport report = autoRig(asset, options, progress);
  std::shared_ptr<RiggedModel> model = readModel(std::move(asset));
  model->report = std::move(report);
  model->home = readNodePose(model->asset, model->binding);  // the bind pose but for rounding, and no node changes
  return model;
}

std::vector<double> handleRadii(const Skeleton& skeleton, double size) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<double> shortest(globals.size(), size);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (!parent) continue;
    const double length = (globals[j].translation() - globals[*parent].translation()).norm();
    shortest[j] = std::min(shortest[j], length);
    shortest[*parent] = std::min(shortest[*parent], length);
  }
  std::vector<double> radii;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const double radius = skeleton.joints[j].radius;
    radii.push_back(std::max(radius > 0 ? radius : kShareOfBone * shortest[j], kLeastShare * size));
  }
  return radii;
}

bool sameTransform(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs() && a.scale == b.scale;
}

bool samePose(const Pose& a, const Pose& b) {
  return std::equal(a.locals.begin(), a.locals.end(), b.locals.begin(), b.locals.end(), sameTransform);
}

std::vector<Vec3f> posedPositions(const RiggedModel& model, const Pose& pose) {
  std::vector<Affine> transforms(model.inverseBind.size());
  skinTransforms(poseGlobals(model.skeleton(), pose), model.inverseBind, transforms);
  std::vector<Vec3f> positions = model.geometry.positions;
  const Deformer& deformer = findDeformer("linear-blend");
  std::vector<float> scratch(deformer.scratchSize(model.skeleton().jointCount()));
  deformer.deform({positions, {}, model.weights, transforms, {}}, {positions, {}}, scratch);
  return positions;
}

}  // namespace limber
