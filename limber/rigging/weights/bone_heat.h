// Skin weights as the equilibrium of heat that flows from each bone over the surface.
#pragma once

#include <span>

#include <Eigen/Core>

#include "limber/rigging/weights/heat_sources.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber {

struct BoneHeatOptions {
  HeatSourceOptions sources;
  // Vertices: more are solved by multigrid, which takes less time and memory then (docs/scale.md), instead of by one
  // factorisation. Every weight is the same within 1e-3.
  Index directBelow = 300'000;
};

// Bone heat (Baran, Popović: Automatic Rigging and Animation of 3D Characters, 2007) on the Laplacian of
// robustLaplacian(), so that every mesh with a triangle gets weights in [0, 1] that sum to 1.
//
// Heat enters each vertex from its nearest bones in sight, or from the joint whose region it is of
// (WeightOptions::jointOf).
//
// Pieces from which no bone is in sight take the weights of the nearest surface point of a piece that does; the result
// lists their vertices. Where no vertex at all sees a bone, all bones count as in sight (`no-bone-in-sight`).
//
// Where bones are segments, models that are put together from parts get no heat: each piece follows its joint
// (jointsOfPieces). In others PieceRules binds hard parts whole and has pieces that hardly see a bone bridged. Both
// count such pieces in the warning `rigid-pieces`; WeightOptions::pieces has all pieces bound whole, or none.
//
// mesh   working mesh: centred, longest side 1
// bones  in the space of the mesh, at least one
// Throws Error kBadArgument for no bones, for maxInfluences outside 1 to 8, and kCancelled.
// Cost: one sparse factorisation, and one pair of triangular solves for every eight joints; O(#V) for what multigrid
// solves (HeatSolver).
WeightResult boneHeatWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                             Progress& progress);

// The weights before any cut, #V x (highest joint + 1), without bridging: rows of vertices in pieces that see no bone
// are 0. For tests and comparisons; memory is that of a dense matrix.
Eigen::MatrixXd fullBoneHeat(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones);

}  // namespace limber
