// Linear blend skinning: v' = sum of w_j M_j v.
#pragma once

#include "limber/deform/deformer.h"

namespace limber {

// Computed as v + (sum of w_j (M_j - I)) v, so that what is missing to a sum of 1 stays at rest. Normals go by the
// cofactors of the blended matrix: they stay at right angles to the surface under any scale, and on their side where a
// joint mirrors. Cost: 16 multiplications and additions of four floats a vertex with four influences.
void linearBlend(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);
std::size_t linearBlendScratch(std::size_t vertexCount, Index jointCount);

// Its line of the table, for those who need no other: so that a program without the others has no code of theirs.
inline constexpr Deformer kLinearBlendDeformer = {
    "linear-blend",
    "weighted mean of what each joint alone would do",
    "Magnenat-Thalmann, Laperrière, Thalmann: Joint-Dependent Local Deformations, 1988",
    &linearBlendScratch,
    &linearBlend,
    nullptr,
    nullptr};

}  // namespace limber
