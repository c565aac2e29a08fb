// The Laplacian of any triangle mesh, with nonnegative weights.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// stiffness  #V x #V, symmetric, only its lower triangle and diagonal are stored; positive semidefinite. An entry off
// the
//            diagonal is minus the edge's weight and never positive, rows sum to 0; a vertex without triangles has a
//            row of zeros. For a smooth function f, x^T stiffness x is the integral of |grad f|^2.
// mass       #V, the area that belongs to each vertex; sums to the area of the mesh
struct Laplacian {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd mass;
};

// Cotangent weights over the intrinsic Delaunay triangulation of the tufted cover (Sharp, Crane: A Laplacian for
// Nonmanifold Triangle Meshes, 2020): open, non-manifold, inconsistently oriented and degenerate triangles are all
// right. On a closed, oriented, edge-manifold mesh whose edges are Delaunay it is the usual cotangent Laplacian. Mass
// is that of the circumcentric dual cells.
//
// piece  #V, from vertexComponents(mesh)
// Cost: O(#F) in practice.
Laplacian robustLaplacian(const TriMesh& mesh, const std::vector<Index>& piece);

}  // namespace limber
