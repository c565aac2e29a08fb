// Steps that methods of making weights have in common.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/weights/influence_table.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

inline constexpr Index kMaxSlots = 8;  // of WeightOptions::maxInfluences

// Throws Error kBadArgument for no bones, for a mesh without triangles (ErrorKind::kNoSurface) and for maxInfluences
// outside 1 to kMaxSlots.
void checkWeightArguments(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options);

// From a point to a bone's surface, 0 within it.
double distanceToBone(const Bone& bone, const Vec3& point);

// Gives rows without weights those of the nearest surface that has some. Returns these rows; none where no triangle has
// weights at all its corners.
std::vector<Index> bridgeBare(const TriMesh& mesh, InfluenceTable& table);

// PieceMode::kRigid: has each piece of the mesh follow the joint that holds most of it. Counts pieces with triangles in
// the warning `rigid-pieces`.
void bindWholePieces(const TriMesh& mesh, WeightResult& result);

// The rows scaled to a sum of 1; rows without weights stay so.
SkinWeights normalizedWeights(const InfluenceTable& table);

}  // namespace limber
