// Dual quaternion skinning: joints' motions are blended as motions, so that a twisted limb keeps its volume.
#pragma once

#include "limber/deform/deformer.h"

namespace limber {

// Each transform is split into a scale and shear S about the joint's center, then a rigid motion. Two phases, as Kavan,
// Collins, Žára, O'Sullivan 2008 propose: S is blended linearly, then the motions as unit dual quaternions, all on the
// half sphere of the strongest influence's rotation. Where every transform is rigid the first phase is left out. A
// vertex without weights stays; a mirroring transform is a mirroring S. Cost: 8 multiplications and additions of four
// floats for the blend, some 40 for signs and the motion.
void dualQuaternion(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);
std::size_t dualQuaternionScratch(std::size_t vertexCount, Index jointCount);

}  // namespace limber
