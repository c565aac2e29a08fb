// The model as a program is given it: welded, rotated and scaled; and the inverse.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/adapters/adapter.h"
#include "limber/core/file/file.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

struct HandedModel {
  TriMesh mesh;                                // every vertex has a triangle; in the space of the file
  std::vector<std::optional<Index>> vertexOf;  // #V of the model: its vertex in `mesh`; none for one without a triangle
};

// What a file's space is, seen from the working space: a turn and a uniform scale, no offset.
Affine toHandedSpace(AdapterUp up, double size);

// working  welded, centred, longest side 1 (PreparedMesh)
HandedModel handedModel(const TriMesh& working, const Adapter& adapter);

// Positions and faces alone, in the mesh's order: what reorders vertices by normals or materials has no cause to.
// Numbers are written so that they read back equal.
Bytes handedObj(const TriMesh& mesh);

// The skeleton under a map that rotates, scales uniformly and translates. Rest scales are taken into the positions of
// the joints: the result has none.
Skeleton movedSkeleton(const Skeleton& skeleton, const Affine& map);

}  // namespace limber
