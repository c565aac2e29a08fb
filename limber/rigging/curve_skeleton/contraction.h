// A surface shrunk to next to no volume by smoothing: what is left lies along the middle of the body's parts.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// The positions p' that minimise  |smoothing L p'|^2 + sum_i (attraction_i |p'_i - p_i|)^2
// (Au, Tai, Chu, Cohen-Or, Lee: Skeleton Extraction by Mesh Contraction, 2008, equation 2), by the normal equations.
//
// stiffness   #V x #V as in Laplacian: lower triangle and diagonal
// attraction  #V, positive
// Cost: one factorisation of a matrix that couples each vertex with the neighbours of its neighbours.
std::vector<Vec3> contractedOnce(const std::vector<Vec3>& positions, const Eigen::SparseMatrix<double>& stiffness,
                                 double smoothing, const std::vector<double>& attraction);

// Repeats that, each time over the Laplacian of the shrunken surface, with smoothing that grows and attraction that
// grows as the surface about a vertex shrinks (equation 3), until the area is kContracted of what it was.
//
// The paper begins at 1e-3 times the root of the mean face's area, which depends on the mesh's unit and spends the
// first half of its steps on nothing; here the first step smooths over a fixed part of the whole surface.
//
// Cotangents are those of the tufted cover (robustLaplacian), so any triangles serve. A vertex without triangles stays.
// Returns #V positions. Cost: at most kMaxContractions factorisations.
std::vector<Vec3> contractSurface(const TriMesh& mesh, Progress& progress);

inline constexpr double kContracted = 0.004;
inline constexpr int kMaxContractions = 7;

}  // namespace limber
