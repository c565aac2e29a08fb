// How large a model is, whatever a few bits far away from it.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// In longest sides of a model: what lies farther away from it is far away.
inline constexpr double kFarAway = 1;

// Of all that triangles use. Cost: O(#F).
Box surfaceBox(const TriMesh& mesh);

// The box of the surface without its far pieces: connected pieces that all together are at most 2 hundredths of the
// area, farther out than the rest, and more than kFarAway longest sides of the rest away from it. Vertices without a
// triangle do not count, unless there is no triangle at all. Any units. Cost: O(#V + #F), and sorting the pieces.
Box modelBox(const TriMesh& mesh);

}  // namespace limber
