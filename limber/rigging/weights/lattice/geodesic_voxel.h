// Skin weights by path lengths through a model's inside.
#pragma once

#include <span>

#include "limber/rigging/weights/weight_method.h"

namespace limber {

struct GeodesicVoxelOptions {
  Index maxCells = 128;    // of the grid along the longest side, 8 to 512
  double nodes = 400'000;  // of the grid, about: bulky models get fewer cells
  double falloff = 0.2;    // 0 to 1: how much faster than with distance itself weights fall off far from a bone
};

// Geodesic voxel binding (Dionne, de Lasa: Geodesic Voxel Binding for Production Character Meshes, 2013). The inside of
// the mesh and all that its surface passes through are the cells of a grid; from the cells of each joint's bones the
// shortest paths through them run to all others. A vertex whose path to a bone has the length d (hundredths of the
// longest side, as the centimetres of a model of a metre; interpolated between cells) is bound to it by the weight
// 1 / ((1 - falloff) d + falloff d^2)^2. So no weight leaps a gap as wide as a cell, whatever the mesh: open, with
// reversed faces, in components that overlap.
//
// Only the nearest few joints of each cell are followed (options.maxInfluences and two more, at least four), all at
// once. Path lengths are counted in tenths of a cell (10, 14, 17 to the neighbors by face, edge and corner), whole
// numbers, so that results are the same on every machine. Pieces that no path leads to take the weights of the nearest
// surface that has some (WeightResult::bridged). Where no bone reaches the mesh at all, each vertex takes its nearest
// bone (`no-bone-in-sight`).
//
// mesh, bones  as for all methods; bones outside the mesh hold the cells that they pass through
// Errors as checkWeightArguments, kCancelled. Cost: that of InsideLattice, and O(cells within x joints followed).
WeightResult geodesicVoxelWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                  Progress& progress);
WeightResult geodesicVoxelWeightsWith(const GeodesicVoxelOptions& voxels, const TriMesh& mesh,
                                      std::span<const Bone> bones, const WeightOptions& options, Progress& progress);

}  // namespace limber
