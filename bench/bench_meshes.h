// Models of growing size for the benchmarks, made in code.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::bench {

// A closed, smooth, hilly creature with six limbs and about that many vertices (within 2 %), longest side 1. It has no
// mirror plane unless `symmetric`, and its vertices are stored in rows.
TriMesh creature(Index vertexCount, bool symmetric = false);

// Creatures of 100 vertices or so in a cloud, each a piece of its own, together about that many vertices.
TriMesh swarm(Index vertexCount);

}  // namespace limber::bench
