// The surface that delta mush smooths over: a file's vertices welded, and how neighbours flow into each other.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "limber/deform/deformer.h"

namespace limber {

// Vertices at one position whose weights agree at least by half are one, so that a seam stays closed; parts that only
// touch stay apart. A welded vertex has the weights of its first one.
//
// stiffness, diagonal  of the robust Laplacian (limber/geometry/solve/laplacian.h): smoothing is a random walk from a
// vertex to
//            its neighbours by their weights -stiffness / diagonal, as the paper's normalised Laplacian. 1 on the
//            diagonal where there is no neighbour, and the row of stiffness 0.
struct SmoothingSurface {
  std::vector<Index> weldedVertex;        // #V, below #S
  std::vector<Vec3f> positions;           // #S, as bound
  SkinWeights weights;                    // #S
  Eigen::SparseMatrix<double> stiffness;  // #S x #S, lower triangle with the whole diagonal
  Eigen::VectorXd diagonal;               // #S, positive
  double longestSide = 1;                 // of modelBox; 1 without triangles
  double meanSquaredStep = 0;  // of the walk, by area, in squared units of the positions; 0 without triangles

  Index vertexCount() const { return static_cast<Index>(positions.size()); }

  // How far the walk has to go, in mean squared steps, for a root mean square distance of `reach` longest sides. The
  // same surface is smoothed alike however finely it is cut; within it, fine parts less far than coarse ones, as in the
  // paper. At least 1: the immediate neighbours.
  double stepsFor(double reach) const;
};

// Any triangles: open, non-manifold, in pieces, degenerate, or none at all. Cost: O(#V + #F).
SmoothingSurface smoothingSurface(const BoundSurface& surface);

}  // namespace limber
