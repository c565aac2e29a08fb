// A model of many pieces of any size, and a function that writes it to a file.
#pragma once

#include <filesystem>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::bench {

// A four-legged robot: 19 closed limbs, each a piece of its own, that lie in each other. About `vertices` vertices
// (within 5 %), longest side about 1.
TriMesh robot(Index vertices);

// Writes the mesh as a GLB of one primitive.
void writeMeshGlb(const TriMesh& mesh, const std::filesystem::path& path);

}  // namespace limber::bench
