// Parts of a surface by its shape alone, cut where it is concave.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/core/progress.h"

namespace limber {

inline constexpr Index kMaxShapeParts = 20;  // as in the paper

struct ShapePartOptions {
  std::optional<Index> count;  // 1 to kMostShapeParts; none: found from the shape
};

// Katz, Tal 2003, k parts at once: representatives as far apart as can be by FaceGraph distances, the first one the
// middle of all; each triangle fuzzy between its two nearest; the fuzzy ones cut along concave edges.
//
// Distances between all pairs are taken between at most 1000 patches of triangles, grown from seeds as far apart as can
// be; distances from the chosen representatives are exact. Up to 1000 triangles each is its own patch, and all is as in
// the paper but for these:
// - lengths count as much as bends: delta = 0.5 (FaceGraph)
// - capacities of cuts are weighted by the edges' lengths, sums by area
// - pieces are linked where they are nearest (FaceGraph)
// - each part is nearest to a hundredth of the surface at least: farthest triangles lie in ears and folds
// - as many parts as are at least half as far from those before them as the second is from the first: the paper's
//   largest drop of that distance mostly finds two
// - a representative moves to the middle of what is nearest to it: with the paper's sum over everything those of limbs
//   drift into the body
//
// mesh  any, each triangle with three different vertices; loose pieces are linked where they are nearest
// Parts are numbered and named from the largest, "part_01" on. There may be fewer than asked for: no more than patches.
// Throws Error kBadArgument for a count out of range, kCancelled. Cost: O(#F log #F) in practice; memory for 1000^2
// distances.
SurfaceParts partsByShape(const TriMesh& mesh, const ShapePartOptions& options, Progress& progress);

// The same on a graph that is there already.
SurfaceParts partsByShape(const FaceGraph& graph, const ShapePartOptions& options, Progress& progress);

// The stages, for who wants to see between them.

// Triangles grown together from at most `most` seeds. Throws Error kCancelled. Cost: O(most #F).
struct FacePatches {
  std::vector<Index> patchOf;        // #F
  std::vector<Index> seeds;          // #patches, triangles
  std::vector<double> seedDistance;  // #F, to the seed of the own patch
};
FacePatches growPatches(const FaceGraph& graph, Index most, Progress& progress);

// Of triangles with these distances to representatives, distances[r][f]: the nearest first, with the lead
// (d2 - d1) / (d1 + d2), which is p1 - p2 of the paper's probabilities p1 = d2 / (d1 + d2).
FuzzyParts fuzzyByDistance(std::span<const std::vector<double>> distances);

}  // namespace limber
