// Edges that join the separate pieces of a model, so that a collapse can run from one to the next.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/surface/surface_edges.h"

namespace limber {

// Joins everything into one piece: first, points of different pieces that nearly touch (closer than the edges there are
// long), then pieces by the shortest links between their points, nearest first, like a minimum spanning tree. No pair
// comes twice. Cost: O((#points + #edges) log #pieces) for models as they are made; nothing where there is one piece.
std::vector<VertexPair> pieceLinks(std::span<const Vec3f> points, std::span<const VertexPair> edges);

}  // namespace limber
