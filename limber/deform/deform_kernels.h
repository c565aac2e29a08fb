// The inner loops of the deformers, built once for every machine and again for those with AVX2 and AVX-512; all builds
// give the same bits. Everything here is plain numbers on purpose: two builds must not have an inline function in
// common.
#pragma once

#include <cstddef>
#include <cstdint>

namespace limber {

// An affine map less the identity, as four columns of four floats; the fourth of each is 0.
inline constexpr std::size_t kFloatsPerColumns = 16;
// A unit dual quaternion: real x y z w, dual x y z w.
inline constexpr std::size_t kFloatsPerMotion = 8;

// Of four joints' first moments the x, then the y, z and weights.
inline constexpr std::size_t kFloatsPerMoments = 16;

// Vertices are three floats, one after the other; `slots` joints and weights each.
struct DeformJob {
  const float* positions = nullptr;
  const float* normals = nullptr;
  float* outPositions = nullptr;
  float* outNormals = nullptr;
  const std::uint32_t* joints = nullptr;
  const float* weights = nullptr;
  std::uint32_t slots = 0;
  const float* columns = nullptr;    // #J * kFloatsPerColumns: the joints' maps, or for dual quaternions their scales
  const float* stretches = nullptr;  // #J * kFloatsPerColumns: the scales, where columns are the maps
  const float* motions = nullptr;    // #J * kFloatsPerMotion
  const float* rotationCenters = nullptr;  // as positions

  // Direct delta mush: the row of each vertex, the entries of each row (of four joints each), and the smoothed
  // position.
  const std::uint32_t* rowOf = nullptr;      // #V
  const std::uint32_t* rowBegin = nullptr;   // #R + 1
  const std::uint32_t* rowJoints = nullptr;  // #E * 4
  const float* rowMoments = nullptr;         // #E * kFloatsPerMoments
  const float* rowPositions = nullptr;       // #R * 4
};

// Deforms the vertices begin <= v < end.
using DeformKernel = void (*)(const DeformJob& job, std::size_t begin, std::size_t end);

struct DeformKernels {
  DeformKernel linear[2][2];   // [four slots?][normals?]
  DeformKernel dual[2][2][2];  // [four slots?][normals?][scales?]
  DeformKernel centered[2][2][2];
};

// Direct delta mush's apart, so that a program without it has none of their code.
struct DirectKernels {
  DeformKernel direct[2][2];  // [normals?][scales?]
};

// Those for the machine that this runs on.
const DeformKernels& deformKernels();
const DirectKernels& directKernels();

const DeformKernels& baselineDeformKernels();
const DirectKernels& baselineDirectKernels();
// Null where the machine or the build has no AVX2.
const DeformKernels* avx2DeformKernels();
const DirectKernels* avx2DirectKernels();
// As well for AVX-512 (F, BW, DQ, VL).
const DeformKernels* avx512DeformKernels();
const DirectKernels* avx512DirectKernels();

}  // namespace limber
