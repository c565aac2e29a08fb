// An FBX model's transform relative to its parent.
#pragma once

#include "limber/core/transform.h"
#include "limber/core/types.h"
#include "limber/document/fbx/import_fbx_objects.h"

namespace limber {

// The three properties that curves move.
struct FbxPose {
  Vec3 translation = Vec3::Zero();  // in units of the file
  Vec3 rotation = Vec3::Zero();     // degrees round x, y, z, in the model's own order
  Vec3 scaling = Vec3::Ones();
};

// How a parent's scale comes down to a model ("InheritType"). RSrs is what glTF has: the parent's whole map before the
// child's. Else a child is not sheared by its parent (RrSs), and in Rrs does not feel the parent's own scale either.
enum class FbxInherit { kRrSs = 0, kRSrs = 1, kRrs = 2 };

// The constant part of a model's transform: T Roff Rp Rpre R Rpost^-1 Rp^-1 Soff Sp S Sp^-1, as in the FBX SDK's
// documentation ("Computing transformation matrices").
struct FbxTransform {
  FbxPose rest;
  Vec3 rotationOffset = Vec3::Zero(), rotationPivot = Vec3::Zero();
  Vec3 scalingOffset = Vec3::Zero(), scalingPivot = Vec3::Zero();
  Quat preRotation = Quat::Identity(), postRotationInverse = Quat::Identity();
  int rotationOrder = 0;  // of FBX: 0 turns round x first, then y, then z
  FbxInherit inherit = FbxInherit::kRSrs;
  Affine geometric = Affine::Identity();  // of the mesh alone, not of children

  Transform local(const FbxPose& pose) const;
  // The same map with what the rest's scaling mirrors mirrored on x alone (halfTurnOfMirror). The node has it so, and a
  // track of rotations alone has to fit the node's scale.
  Transform localMirroredOnX(const FbxPose& pose) const;

  // Does the position depend on how the model is rotated or scaled?
  bool turnsAboutPivot() const { return !rotationArm(Vec3::Ones()).isZero(0) || !scalingPivot.isZero(0); }

 private:
  // From the rotation's pivot to what is turned about it.
  Vec3 rotationArm(const Vec3& scaling) const {
    return scalingOffset + scalingPivot - rotationPivot - scaling.cwiseProduct(scalingPivot);
  }
};

FbxTransform fbxTransform(const FbxProperties& model);

// Degrees round the three axes, in one of FBX's orders.
Quat fbxRotation(const Vec3& degrees, int order);

// The child's map to the world by the parent's and the child's own; `parentScaling` is the parent's Lcl Scaling.
Affine inheritedWorld(const Affine& parentWorld, const Vec3& parentScaling, const Transform& local, FbxInherit inherit);

}  // namespace limber
