#include "limber/document/fbx/import_fbx_transform.h"

#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/document/scene/mirrored_scale.h"

namespace limber {

namespace {

Quat turnAbout(int axis, double degrees) {
  const double half = 0.5 * kDegree * std::remainder(degrees, 720);
  Quat result(std::cos(half), 0, 0, 0);
  result.vec()[axis] = std::sin(half);
  return result;
}

}  // namespace

Quat fbxRotation(const Vec3& degrees, int order) {
  // The first axis is applied first.
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};
  const std::array<int, 3>& axes = kOrders[order >= 0 && order < 6 ? static_cast<std::size_t>(order) : 0];
  return (turnAbout(axes[2], degrees[axes[2]]) * turnAbout(axes[1], degrees[axes[1]]) *
          turnAbout(axes[0], degrees[axes[0]]))
      .normalized();
}

Transform FbxTransform::local(const FbxPose& pose) const {
  Transform result;
  result.rotation = (preRotation * fbxRotation(pose.rotation, rotationOrder) * postRotationInverse).normalized();
  result.scale = pose.scaling;
  result.translation = pose.translation + rotationOffset + rotationPivot + result.rotation * rotationArm(pose.scaling);
  return result;
}

Transform FbxTransform::localMirroredOnX(const FbxPose& pose) const {
  return turnedMirror(local(pose), halfTurnOfMirror(rest.scaling));
}

FbxTransform fbxTransform(const FbxProperties& model) {
  FbxTransform result;
  const Vec3 zero = Vec3::Zero();
  result.rest = {model.vector("Lcl Translation", zero), model.vector("Lcl Rotation", zero),
                 model.vector("Lcl Scaling", Vec3::Ones())};
  result.rotationOffset = model.vector("RotationOffset", zero);
  result.rotationPivot = model.vector("RotationPivot", zero);
  result.scalingOffset = model.vector("ScalingOffset", zero);
  result.scalingPivot = model.vector("ScalingPivot", zero);
  if (model.integer("RotationActive", 0) != 0) {  // else the SDK ignores these three
    result.preRotation = fbxRotation(model.vector("PreRotation", zero), 0);
    result.postRotationInverse = fbxRotation(model.vector("PostRotation", zero), 0).conjugate();
    result.rotationOrder = static_cast<int>(model.integer("RotationOrder", 0));
  }
  const std::int64_t inherit = model.integer("InheritType", 1);
  if (inherit == 0 || inherit == 2) result.inherit = static_cast<FbxInherit>(inherit);
  result.geometric.translate(model.vector("GeometricTranslation", zero));
  result.geometric.rotate(fbxRotation(model.vector("GeometricRotation", zero), 0));
  result.geometric.scale(model.vector("GeometricScaling", Vec3::Ones()));
  return result;
}

Affine inheritedWorld(const Affine& parentWorld, const Vec3& parentScaling, const Transform& local,
                      FbxInherit inherit) {
  if (inherit == FbxInherit::kRSrs) return parentWorld * local.toAffine();
  Affine result;
  result.translation() = parentWorld * local.translation;
  const Mat3 turn = local.rotation.toRotationMatrix();
  if (inherit == FbxInherit::kRrs) {
    const Vec3 undone = (parentScaling.array() == 0).select(1, parentScaling.cwiseInverse());
    result.linear() = parentWorld.linear() * undone.asDiagonal() * turn * local.scale.asDiagonal();
  } else {
    const Mat3 rotation = decompose(parentWorld).rotation.toRotationMatrix();
    result.linear() = rotation * turn * rotation.transpose() * parentWorld.linear() * local.scale.asDiagonal();
  }
  return result;
}

}  // namespace limber
