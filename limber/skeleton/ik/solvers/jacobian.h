// How effectors move when joints turn and slide a little.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "limber/skeleton/ik/ik_system.h"

namespace limber {

// Rows: for each effector the 3 coordinates of its position, then, where it has an orientation, the 3 of its rotation
// times its angleScale; all times the root of its weight. Ordered by priority. For a system with tasks, their rows
// (IkTaskRows) instead. Columns: for each node the axes about which it may turn, in radians, then along which it may
// slide, in units of slideLength(); times its gain.
class IkJacobian {
 public:
  struct Freedom {
    int node = 0;
    bool slides = false;
    Vec3 axis = Vec3::UnitX();  // turn: in the node's own frame; slide: in the parent's
  };

  // gains  #nodes: how willing each node is to move, 0 or more
  IkJacobian(const IkSystem& system, std::vector<double> gains);

  // At the system's present state. `matrix` holds rows() x columns(); what lies right of that is left over.
  void build(const IkSystem& system);
  // What is left to go, in the units of the rows.
  void residual(const IkSystem& system, Eigen::VectorXd& error) const;

  Eigen::Index rows() const { return matrix.rows(); }
  Eigen::Index columns() const { return static_cast<Eigen::Index>(freedoms.size()); }
  Eigen::Index maxColumns() const { return matrix.cols(); }
  int levels() const { return static_cast<int>(levelBegin.size()) - 1; }
  double gain(int node) const { return gains_[static_cast<std::size_t>(node)]; }
  double slideLength() const { return slideLength_; }

  // The node's rotation, as a vector in its own frame, and slide in its parent's, for a step (#columns).
  Vec3 turnOf(int node, const Eigen::VectorXd& step) const;
  Vec3 slideOf(int node, const Eigen::VectorXd& step) const;

  Eigen::MatrixXd matrix;
  std::vector<Freedom> freedoms;
  std::vector<int> nodeBegin;            // #nodes + 1; columns of node n: nodeBegin[n] .. nodeBegin[n + 1]
  std::vector<Eigen::Index> rowBegin;    // #effectors; its first row
  std::vector<int> rowCount;             // #effectors; 3 or 6
  std::vector<Eigen::Index> levelBegin;  // #priorities + 1

 private:
  void addColumn(const IkSystem& system, int node, bool slides, const Vec3& axis, const Vec3& globalAxis);

  std::vector<double> gains_;
  double slideLength_ = 1;
};

}  // namespace limber
