// Common to the public functions and the inner loops of the deformers.
#pragma once

#include "limber/deform/deform_kernels.h"
#include "limber/deform/deformer.h"

namespace limber {

// Throws Error kBadArgument where the sizes of a call do not match.
void checkDeformCall(const DeformInput& input, const DeformOutput& output, std::size_t scratchSize,
                     std::size_t scratchNeeded);

// The preparation of type Own that the call holds; checkPreparedFor compares its numbers of vertices and joints. Throw
// Error kBadArgument where it is missing, another deformer's or another surface's.
[[noreturn]] void refusePreparation();
template <typename Own>
const Own& preparationOf(const DeformInput& input) {
  const auto* own = dynamic_cast<const Own*>(input.preparation);
  if (!own) refusePreparation();
  return *own;
}
void checkPreparedFor(std::size_t vertexCount, std::size_t jointCount, const DeformInput& input);

// The joints' maps start at a multiple of 64 bytes in the scratch, so that none of them lies across two lines of cache.
inline constexpr std::size_t kScratchAlignment = 16;  // floats
float* alignedScratch(std::span<float> scratch);

// Writes map - identity, kFloatsPerColumns floats.
void packColumns(const Affine& map, float* to);

// map = motion * stretch, the stretch (scale and shear) about `center`: kFloatsPerMotion floats of the rigid motion as
// a unit dual quaternion, kFloatsPerColumns of the stretch. Returns whether there is any stretch.
bool packMotion(const Affine& map, const Vec3& center, float* motion, float* stretchColumns);

// The job for all that the call itself holds; the joints' columns and motions are left to fill in.
DeformJob deformJob(const DeformInput& input, const DeformOutput& output);

// In parallel, without allocating.
void runDeformJob(DeformKernel kernel, const DeformJob& job, std::size_t vertexCount);

}  // namespace limber
