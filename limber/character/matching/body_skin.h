// A character's skin, as far as it matters where its body is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Positions in the frames of the joints that carry them (their rotations, metres).
struct BodySkin {
  std::vector<Vec3> positions;
  std::vector<Index> joints;
};

// A character's skin, each sample where the joint that moves it most carries it. Evenly chosen in the order of the
// vertices, a few thousand.
//
// bound  #V positions in the pose in which the skeleton rests, metres
std::shared_ptr<const BodySkin> makeBodySkin(const Skeleton& skeleton, std::span<const Vec3f> bound,
                                             const SkinWeights& weights);

}  // namespace limber
