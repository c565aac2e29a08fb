// From "more or less of this part" to parts with short boundaries.
#pragma once

#include <string>
#include <vector>

#include "limber/actions/parts/face_graph.h"
#include "limber/core/progress.h"

namespace limber {

// A part for each triangle. Every part has a triangle.
struct SurfaceParts {
  std::vector<Index> partOf;       // #F
  std::vector<std::string> names;  // #P, unique

  Index partCount() const { return static_cast<Index>(names.size()); }
};

// The likeliest part of each triangle, the next likely one, and by how much it leads: (p - q) / (p + q), 0 to 1.
struct FuzzyParts {
  std::vector<Index> first, second;  // #F, part numbers
  std::vector<float> lead;           // #F; 1 where there is no second
};

// The triangles that lead by less than `fuzziness` go to either of their two parts so that the boundary between them is
// the smallest cut through the arcs' capacities (Katz, Tal 2003, section 5), pair of parts by pair; all others, and
// fuzzy ones that do not lie between both parts, to their likeliest. Returns #F part numbers. Throws Error kCancelled.
// Cost: that of the flows.
std::vector<Index> cutFuzzyParts(const FaceGraph& graph, const FuzzyParts& fuzzy, double fuzziness, Progress& progress);

// Gives patches scattered over other parts to these: a connected patch of a part that has less than a tenth of its
// area, and is not its largest, goes to the part with which it has the longest common boundary. Pieces of the model
// are never split off or merged by this. Throws Error kCancelled. Cost: O(#F log #F) a round, at most 8 rounds.
void mergeIslands(const FaceGraph& graph, std::vector<Index>& partOf, Progress& progress);

}  // namespace limber
