// Skin weights as smooth as they can be, through a model's inside.
#pragma once

#include <span>

#include "limber/rigging/weights/weight_method.h"

namespace limber {

struct BoundedBiharmonicOptions {
  double cells = 4'000;     // of the inside, about
  Index maxCells = 128;     // along the longest side, 8 to 512
  double tolerance = 2e-4;  // of weights on the lattice, see BiharmonicOptions; less is none
};

// Bounded biharmonic weights (Jacobson, Baran, Popović, Sorkine: Bounded Biharmonic Weights for Real-Time Deformation,
// 2011): each joint's weights are 1 on its bones, 0 on those of others, in [0, 1] everywhere, and of all such functions
// those with the least Laplacian energy. They hardly reach beyond the next bones, and seldom have maxima between. As
// the paper proposes, each joint is solved for by itself, and the weights of a vertex are scaled to a sum of 1.
//
// The paper fills the inside with tetrahedra, which many meshes do not allow; here it is the lattice of
// geodesicVoxelWeights (InsideLattice), coarser, so any mesh will do. The weights of a vertex are interpolated between
// the nodes round it. Nodes that bones of several joints pass through are shared, by how much of each lies there. Balls
// (handles) count by their centres, as the paper's point handles do. Models of parts that turn about their joints have
// each part follow its joint (jointedPieceWeights). What no bone reaches, and where no bone reaches anything, is as for
// geodesicVoxelWeights (WeightResult::bridged, `no-bone-in-sight`).
//
// mesh, bones  as for all methods
// Errors as checkWeightArguments, kCancelled. Cost: two lattices (three of sheets), and some hundred steps over the
// cells where each joint's weights are neither 0 nor 1, joints in parallel; 4 bytes for each cell and joint.
WeightResult boundedBiharmonicWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                      Progress& progress);
WeightResult boundedBiharmonicWeightsWith(const BoundedBiharmonicOptions& biharmonic, const TriMesh& mesh,
                                          std::span<const Bone> bones, const WeightOptions& options,
                                          Progress& progress);

}  // namespace limber
