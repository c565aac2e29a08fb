#include "limber/deform/deformer.h"

#include <algorithm>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/deform/centers_of_rotation.h"
#include "limber/deform/delta_mush.h"
#include "limber/deform/direct_delta_mush.h"
#include "limber/deform/dual_quaternion.h"
#include "limber/deform/linear_blend.h"

namespace limber {

namespace {

constexpr Deformer kDeformers[] = {
    kLinearBlendDeformer,
    {"dual-quaternion", "weighted mean of the joints' motions; keeps volume where joints twist",
     "Kavan, Collins, Žára, O'Sullivan: Geometric Skinning with Approximate Dual Quaternion Blending, 2008",
     &dualQuaternionScratch, &dualQuaternion, nullptr, nullptr},
    {"centers-of-rotation", "turns each vertex about the middle of what is bound like it; no bulge where joints bend",
     "Le, Hodgins: Real-time Skeletal Skinning with Optimized Centers of Rotation, 2016", &centersOfRotationScratch,
     &centersOfRotation, &prepareRotationCenters, &centersOfRotationRows},
    {"delta-mush", "smooths the bent surface and puts its detail back; soft joints whatever the weights",
     "Mancewicz, Derksen, Rijpkema, Wilson: Delta Mush: Smoothing Deformations While Preserving Detail, 2014",
     &deltaMushScratch, &deltaMush, &prepareDeltaMush, nullptr},
    {"direct-delta-mush", "delta mush with its smoothing done once, so that a frame takes a small part of the time",
     "Le, Lewis: Direct Delta Mush Skinning and Variants, 2019", &directDeltaMushScratch, &directDeltaMush,
     &prepareDirectDeltaMush, &directDeltaMushDrawRows},
};

}  // namespace

std::span<const Deformer> deformers() {
  return kDeformers;
}

const Deformer& findDeformer(std::string_view name) {
  return findByName(kDeformers, "deformer", name);
}

std::shared_ptr<const DeformPreparation> prepareDeformer(const Deformer& deformer, const BoundSurface& surface,
                                                         Index jointCount) {
  if (!deformer.prepare) return nullptr;
  const std::size_t count = surface.positions.size(), entries = count * surface.weights.slots;
  if (surface.weights.weights.size() != entries || surface.weights.joints.size() != entries) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} weights, {} needed", surface.weights.weights.size(), entries));
  }
  for (const Triangle& t : surface.triangles) {
    if (*std::max_element(t.begin(), t.end()) < count) continue;
    throw Error(ErrorCode::kBadArgument, fmt::format("a triangle of a vertex beyond the {} there are", count));
  }
  for (const Index joint : surface.weights.joints) {
    if (joint < jointCount) continue;
    throw Error(ErrorCode::kBadArgument, fmt::format("a weight for joint {} of {}", joint, jointCount));
  }
  return deformer.prepare(surface, jointCount);
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
