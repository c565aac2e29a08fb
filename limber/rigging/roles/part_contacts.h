// Parts of a body that are grown together where no body's are: a hand onto a hip, legs to each other.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// Names of ReadingWeights::parts; `length` of the border between them, which zigzags between vertices, heights.
struct PartContact {
  std::string one, other;
  double length = 0;
};

// Each vertex is of the part of the sample that is nearest to it along the surface, so parts that are close in space
// alone do not touch. Parts that a body has next to each other are no contact, nor are props, hair and what is unknown.
//
// samples  of the mesh, in its space
// partOf   by sample
// height   of the body, in the same unit
// Returns contacts that are long enough to hold limbs together, the longest first.
// Cost: O(#V log #V).
std::vector<PartContact> grownTogether(const TriMesh& mesh, std::span<const SurfaceSample> samples,
                                       std::span<const std::string_view> partOf, double height);

// mesh  that the reading's samples are of
std::vector<PartContact> grownTogether(const TriMesh& mesh, const RoleReading& reading);

}  // namespace limber
