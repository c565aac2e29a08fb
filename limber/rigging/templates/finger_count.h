// Whether hands have fingers, as the surface tells: the grid of a body is too coarse for them.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

inline constexpr std::size_t kHandWithFingers = 4;  // counted, that are enough: thumbs lie across

// The most parts as thin as fingers that planes across a hand cut it into. Fingers that touch count as one.
//
// hand, tip  the wrist and about where the hand ends
// Cost: O(#F).
std::size_t countFingers(const TriMesh& mesh, const Vec3& hand, const Vec3& tip);

}  // namespace limber
