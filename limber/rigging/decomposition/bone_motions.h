// How bones move over the frames of a sequence.
#pragma once

#include <vector>

#include "limber/core/types.h"

namespace limber {

// A rotation beside a translation: takes a point as bound to where the bone takes it.
using RigidMotion = Eigen::Matrix<double, 3, 4>;

struct BoneMotions {
  Index frameCount = 0;
  std::vector<RigidMotion> motions;  // #bones * #frames, a bone's frames one behind the other

  Index boneCount() const { return frameCount == 0 ? 0 : static_cast<Index>(motions.size() / frameCount); }
  RigidMotion* of(Index bone) { return motions.data() + std::size_t{bone} * frameCount; }
  const RigidMotion* of(Index bone) const { return motions.data() + std::size_t{bone} * frameCount; }
};

// Takes out the bones for which `isUsed` is false. Returns the new number of each (#bones), kNoIndex for those that
// went.
std::vector<Index> compactBones(BoneMotions& motions, const std::vector<bool>& isUsed);

}  // namespace limber
