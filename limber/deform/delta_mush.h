// Delta mush: the skinned surface is smoothed, and the detail that smoothing takes is put back.
#pragma once

#include <vector>

#include "limber/core/grouped.h"
#include "limber/deform/deformer.h"

namespace limber {

struct DeltaMushOptions {
  double reach = 0.025;     // root mean square distance of smoothing, in longest sides of the model
  double step = 0.5;        // of each of the smoothings, in (0, 1]: how far a vertex goes to its neighbours' mean
  int maxSmoothings = 100;  // where the surface is so fine that the reach takes more, it is smoothed less
};

struct MushNeighbour {
  Index vertex;
  float flow;  // those of all neighbours of a vertex sum to 1
};

// The welded surface (SmoothingSurface), its neighbourhoods, and what smoothing takes from it at rest.
struct DeltaMushSurface : DeformPreparation {
  std::vector<Index> weldedVertex;    // #V
  std::vector<Vec3f> positions;       // #S, as bound
  SkinWeights weights;                // #S
  Grouped<MushNeighbour> neighbours;  // #S
  std::vector<Vec3f> smoothed;        // #S, positions after the smoothings
  float step = 0;
  int smoothings = 0;
  Index jointCount = 0;
};

std::shared_ptr<const DeformPreparation> prepareDeltaMush(const BoundSurface& surface, Index jointCount);
// Throws Error kBadArgument where an option is out of its range. Cost: O(#V + #F), as long as some frames.
std::shared_ptr<const DeltaMushSurface> deltaMushSurface(const BoundSurface& surface, Index jointCount,
                                                         const DeltaMushOptions& options = {});

// v' = s' + R (v - s): s is the vertex of the smoothed rest pose, s' of the linear blend smoothed alike, R the rotation
// between the two surfaces there (Mancewicz and others 2014). Where the paper takes R from a normal and a tangent, it
// is here the rotation nearest to what becomes of the vertex' edges, so that no choice of a tangent shows and any
// triangles serve. The neighbours of a vertex count by the robust Laplacian's weights. Joints' scales and shears are
// blended for v - s.
// Cost: each smoothing that of a linear blend; then one rotation fitted for each vertex, about 100 ns.
void deltaMush(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);
std::size_t deltaMushScratch(std::size_t vertexCount, Index jointCount);

}  // namespace limber
