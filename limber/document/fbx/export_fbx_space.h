// The space that an FBX file is written in: glTF's, turned and in another unit.
#pragma once

#include "limber/core/transform.h"

namespace limber {

class FbxSpace {
 public:
  // `unitsPerMetre`: lengths are multiplied by it. `zUp`: +Y of the document becomes +Z, its +Z becomes -Y.
  FbxSpace(double unitsPerMetre, bool zUp)
      : unit_(unitsPerMetre), turn_(zUp ? Quat(Eigen::AngleAxisd(M_PI_2, Vec3::UnitX())) : Quat::Identity()) {}

  Vec3 length(const Vec3& metres) const { return unit_ * metres; }

  // A transform below another node keeps its axes; one at the top of the scene turns with the world.
  Transform local(Transform transform, bool atRoot) const {
    transform.translation *= unit_;
    if (!atRoot) return transform;
    transform.translation = turn_ * transform.translation;
    transform.rotation = turn_ * transform.rotation;
    return transform;
  }

  // From a node's own space to the world.
  Affine world(Affine toWorld) const {
    toWorld.translation() *= unit_;
    return Affine(turn_) * toWorld;
  }

 private:
  double unit_;
  Quat turn_;
};

}  // namespace limber
