#include "limber/skinning/deformer.h"

#include <limits>
#include <string>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/names.h"
#include "limber/skinning/centers_of_rotation.h"
#include "limber/skinning/dual_quaternion.h"
#include "limber/skinning/linear_blend.h"

namespace limber {

namespace {

constexpr Deformer kDeformers[] = {
    {"linear-blend", "weighted mean of what each joint alone would do",
     "Magnenat-Thalmann, Laperrière, Thalmann: Joint-Dependent Local Deformations, 1988", &linearBlendScratch,
     &linearBlend, false},
    {"dual-quaternion", "weighted mean of the joints' motions; keeps volume where joints twist",
     "Kavan, Collins, Žára, O'Sullivan: Geometric Skinning with Approximate Dual Quaternion Blending, 2008",
     &dualQuaternionScratch, &dualQuaternion, false},
    {"centers-of-rotation", "turns each vertex about the middle of what is bound like it; no bulge where joints bend",
     "Le, Hodgins: Real-time Skeletal Skinning with Optimized Centers of Rotation, 2016", &centersOfRotationScratch,
     &centersOfRotation, true},
};

}  // namespace

std::span<const Deformer> deformers() {
  return kDeformers;
}

const Deformer& findDeformer(std::string_view name) {
  return findByName(kDeformers, "deformer", name);
}

void checkWeights(const SkinWeights& weights, Index jointCount) {
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const Index joint = weights.jointsOf(v)[slot];
      const float weight = weights.weightsOf(v)[slot];
      if (joint >= jointCount) {
        throw Error(ErrorCode::kBadData, fmt::format("is bound to joint {} of {}", joint, jointCount),
                    fmt::format("vertex {}", v));
      }
      if (!(weight >= 0) || weight > std::numeric_limits<float>::max()) {
        throw Error(ErrorCode::kBadData, fmt::format("has a weight of {}", weight), fmt::format("vertex {}", v));
      }
    }
  }
}

}  // namespace limber
