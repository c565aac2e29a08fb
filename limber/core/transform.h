// Translation, rotation and scale, as a glTF node stores them.
#pragma once

#include "limber/core/types.h"

namespace limber {

// Applied to a point as translation + rotation * (scale * point). Rotation is a unit quaternion.
struct Transform {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();

  Affine toAffine() const;
};

// The Transform nearest to an affine map: exact where the map has no shear; shear is dropped (the rotation is then the
// nearest one of the polar decomposition) and reported through `sheared` if given. A mirroring map gets a negative
// scale.
Transform decompose(const Affine& affine, bool* sheared = nullptr);

}  // namespace limber
