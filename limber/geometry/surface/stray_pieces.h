// Bits that float about a model, as scans leave them: they should not take handles from it, nor make it look larger.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/geometry/surface/surface_edges.h"

namespace limber {

// Per point how much its surface counts, 0 to 1. A cluster of pieces that is tiny beside the largest piece of what it
// is joined to, and farther from that than it is large itself, counts as (area / distance^2)^2 of its area: the farther
// away, the less it costs to merge it. All else counts fully. Clusters grow over the links from the shortest to the
// longest.
//
// points  #V
// areas   #V, of the surface round each point
// edges   of the surface
// links   pieceLinks(points, edges)
// Cost: O(#V + #edges + #links log #links).
std::vector<double> strayFractions(std::span<const Vec3f> points, std::span<const double> areas,
                                   std::span<const VertexPair> edges, std::span<const VertexPair> links);

// The same points with only those triangles that count for at least a half; nothing where all do. Cost: O(#V + #F) for
// a model of one piece, else that of surfaceEdges, pieceLinks and strayFractions.
std::optional<TriMesh> withoutStrays(const TriMesh& mesh);

}  // namespace limber
