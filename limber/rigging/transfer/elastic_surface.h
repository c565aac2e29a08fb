// A surface that resists stretching and bending and is pulled to goals.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "limber/core/grouped.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/solve/sparse_cholesky.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

// Each vertex keeps the shape of its neighbourhood up to a rotation and one scale (as similar as possible), as near as
// possible to those of its neighbours: as-rigid-as-possible surface modelling (Sorkine, Alexa 2007) with a scale for
// each vertex. The two steps of that method are called in turn, with goals that change between.
class ElasticSurface {
 public:
  // rest   the undeformed shape; cotangent weights, kept positive
  // links  edges between pieces, which hold them together; may be empty. A piece without links holds by its pulls.
  ElasticSurface(const TriMesh& rest, std::span<const VertexPair> links);
  ~ElasticSurface();

  Index vertexCount() const { return static_cast<Index>(rest_.size()); }
  const std::vector<double>& masses() const { return masses_; }  // #V, area that belongs to each vertex

  // The local step: #V turns, each times its scale (0.5 to 2), which bring the neighbourhoods at rest nearest to those
  // of `positions` (#V).
  std::vector<Mat3> frames(std::span<const Vec3> positions) const;

  // The global step: the positions x that minimise
  //   stiffness * sum over edges w_ij |x_i - x_j - (T_i + T_j) / 2 (r_i - r_j)|^2 + sum over vertices c_i |x_i - g_i|^2
  // frames  #V, T;  pulls  #V, c, not negative, a positive one for each piece;  goals  #V, g
  std::vector<Vec3> solve(std::span<const Mat3> frames, double stiffness, std::span<const double> pulls,
                          std::span<const Vec3> goals);

  struct Edge {
    Index a, b;
    double weight;
  };
  const std::vector<Edge>& edges() const { return edges_; }

 private:
  struct Neighbour {
    Index vertex;
    double weight;
  };

  void buildMatrix();

  std::vector<Vec3> rest_;
  std::vector<double> masses_;
  std::vector<Edge> edges_;                  // a < b, in order
  Grouped<Neighbour> neighbours_;            // by vertex, in the order of their edges
  Eigen::SparseMatrix<double> matrix_;       // lower triangle
  std::vector<std::ptrdiff_t> diagonal_;     // #V, where in its values
  std::vector<std::ptrdiff_t> offDiagonal_;  // of each edge
  std::unique_ptr<SparseCholesky> factor_;
};

}  // namespace limber
