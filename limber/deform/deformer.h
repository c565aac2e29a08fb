// The interface of every method that moves a bound mesh with its joints. One table lists them by name.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "limber/skeleton/skin_weights.h"

namespace limber {

// What a deformer computes once from a bound surface, so that a frame costs little; each deformer derives its own.
struct DeformPreparation {
  virtual ~DeformPreparation() = default;
};

// positions   #V, as bound
// normals     #V unit vectors, or empty
// weights     of #V vertices; every joint index below #J (checkWeights makes sure, once)
// transforms  #J, each from where a point is bound to where its joint takes it (skinTransforms)
// centers     #J joint positions as bound, or empty: the points about which dual quaternions scale, the origin where
//             empty. Without scale they do not matter.
// preparation  what the deformer's `prepare` gave for these positions and weights; null for deformers without one
struct DeformInput {
  std::span<const Vec3f> positions;
  std::span<const Vec3f> normals;
  const SkinWeights& weights;
  std::span<const Affine> transforms;
  std::span<const Vec3> centers;
  const DeformPreparation* preparation = nullptr;
};

// positions  #V
// normals    #V unit vectors, or empty where the input has none or none are wanted
// Each may be the very span of the input.
struct DeformOutput {
  std::span<Vec3f> positions;
  std::span<Vec3f> normals;
};

// Runs in parallel, allocates nothing; the result does not depend on the number of threads. A vertex whose joints'
// transforms are all exactly the identity comes out bit for bit; so does one without weights. (Delta mush means all
// vertices within its reach there.) Throws Error kBadArgument where sizes do not match or the preparation is another
// deformer's or surface's.
//
// scratch  at least Deformer::scratchSize(#V, #J) floats; holds nothing between calls
using DeformFunction = void (*)(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);

// A surface and how it is bound.
//
// positions  #V, as bound
// triangles  of #V vertices
// weights    of #V vertices, each with a sum of 1 or 0
struct BoundSurface {
  std::span<const Vec3f> positions;
  std::span<const Triangle> triangles;
  const SkinWeights& weights;
};

using PrepareFunction = std::shared_ptr<const DeformPreparation> (*)(const BoundSurface& surface, Index jointCount);

// A deformer as sums that a graphics card makes vertex by vertex: v' = p + sum of (M_j - I) [m_j; w_j] + R S (v - p).
// M_j are the joints' transforms; R and S their rotations and their scales and shears blended by w_j, the rotations as
// quaternions on the half sphere of the row's first joint. A row without entries leaves its vertices where they are.
struct DeformRows {
  std::vector<Index> rowOf;   // #V
  std::vector<Index> begin;   // #R + 1, into the entries
  std::vector<Index> joints;  // #E * 4, strongest first
  std::vector<float>
      moments;  // #E * 16: of four joints the x of m_j, then the y, z and w_j; zero where there are fewer
  std::vector<float> positions;  // #R * 4: p
};

// preparation  what `prepare` gave for that surface
using RowsFunction = std::shared_ptr<const DeformRows> (*)(const BoundSurface& surface,
                                                           const std::shared_ptr<const DeformPreparation>& preparation);

struct Deformer {
  std::string_view name;     // "linear-blend"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  std::size_t (*scratchSize)(std::size_t vertexCount, Index jointCount);  // in floats
  DeformFunction deform;
  PrepareFunction prepare;  // null where there is nothing to prepare
  RowsFunction rows;        // null where rows cannot say it
};

std::span<const Deformer> deformers();
// Throws Error kBadArgument that lists the names there are.
const Deformer& findDeformer(std::string_view name);

// What `deformer` needs for a surface; null where that is nothing. Throws Error kBadArgument where sizes do not match,
// a triangle names a vertex or a weight a joint that is not there.
std::shared_ptr<const DeformPreparation> prepareDeformer(const Deformer& deformer, const BoundSurface& surface,
                                                         Index jointCount);

// Throws Error kBadData where a joint index is not below `jointCount`, or a weight is negative or not finite.
void checkWeights(const SkinWeights& weights, Index jointCount);

}  // namespace limber
