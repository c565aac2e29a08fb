// What every way of moving a bound mesh with its joints is. One table lists them by name.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "limber/skeleton/skin_weights.h"

namespace limber {

// positions   #V, as bound
// normals     #V unit vectors, or empty
// weights     of #V vertices; every joint index below #J (checkWeights makes sure, once)
// transforms  #J, each from where a point is bound to where its joint takes it (skinTransforms)
// centers     #J joint positions as bound, or empty: the points about which dual quaternions scale, the origin where
//             empty. Without scale they do not matter.
// rotationCenters  #V points as bound (rotation_centers.h), for deformers that turn vertices about them; empty for all
//             others
struct DeformInput {
  std::span<const Vec3f> positions;
  std::span<const Vec3f> normals;
  const SkinWeights& weights;
  std::span<const Affine> transforms;
  std::span<const Vec3> centers;
  std::span<const Vec3f> rotationCenters = {};
};

// positions  #V
// normals    #V unit vectors, or empty where the input has none or none are wanted
// Each may be the very span of the input.
struct DeformOutput {
  std::span<Vec3f> positions;
  std::span<Vec3f> normals;
};

// Runs in parallel, allocates nothing; the result does not depend on the number of threads. A vertex whose joints'
// transforms are all exactly the identity comes out bit for bit; so does one without weights. Throws Error kBadArgument
// where sizes do not match.
//
// scratch  at least Deformer::scratchSize(#J) floats; holds nothing between calls
using DeformFunction = void (*)(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);

struct Deformer {
  std::string_view name;     // "linear-blend"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  std::size_t (*scratchSize)(Index jointCount);  // in floats
  DeformFunction deform;
  bool needsRotationCenters;  // of DeformInput
};

std::span<const Deformer> deformers();
// Throws Error kBadArgument that lists the names there are.
const Deformer& findDeformer(std::string_view name);

// Throws Error kBadData where a joint index is not below `jointCount`, or a weight is negative or not finite.
void checkWeights(const SkinWeights& weights, Index jointCount);

}  // namespace limber
