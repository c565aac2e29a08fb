// Whether hands have fingers, as the surface tells: the samples of a body are too far apart for them.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

inline constexpr std::size_t kHandWithFingers = 4;  // counted, that are enough: thumbs lie across

// Of the hand that shows fewest, by where the forearms lead; 0 for a reading without two hands.
//
// mesh  of the reading
// Cost: O(#F).
std::size_t countFingers(const TriMesh& mesh, const RoleReading& reading);

// The most parts as thin as fingers that planes across a hand cut it into. Fingers that touch count as one.
//
// hand, tip  the wrist and about where the hand ends
// Cost: O(#F).
std::size_t countFingers(const TriMesh& mesh, const Vec3& hand, const Vec3& tip);

}  // namespace limber
