// Tasks as rows of errors with derivatives, for Jacobian methods.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "limber/skeleton/ik/ik_system.h"
#include "limber/skeleton/ik/ik_task.h"

namespace limber {

// One to three rows for each task, ordered by priority. Each row's derivative is kept as forces and torques on nodes,
// summed from the tips to the root, as a load is carried: of a turn about an axis through a point it is the moment
// about that axis. Angles count as metres by IkOptions::angleWeight of the body's size.
class IkTaskRows {
 public:
  IkTaskRows(const Skeleton& skeleton, std::span<const IkTask> tasks, const IkTaskOptions& options);

  // For IkSystem: joints that must be nodes, with all above them; and once these are there, in rest pose.
  std::vector<Index> joints() const;
  void bind(const IkSystem& system);

  // Couples followers to their leaders outright, where the tasks begin.
  void follow(IkSystem& system) const;
  // From now on the first `levels` priorities count; those before the last keep what they have, to the tolerance.
  void serve(const IkSystem& system, std::size_t levels);
  // A step from inside an obstacle may lead further out than its surface. Those inequalities count as equalities until
  // release(); whether there are any.
  bool press(const IkSystem& system);
  void release();

  // What is left of the last priority served: the sum of weight * error^2. Infinite where an earlier one lost.
  double cost(const IkSystem& system);
  double levelCost(std::size_t level) const;  // as last measured
  double slackOf(std::size_t level) const;    // a cost below which all its tasks are met
  bool met(const IkSystem& system);           // those of the priorities served
  IkTaskReport report(const IkSystem& system, std::size_t task);

  // Errors of all rows; with `slopes`, their derivatives and which inequalities are violated, too.
  void measure(const IkSystem& system, bool slopes);

  std::size_t levels() const { return levelBegin_.size() - 1; }
  std::size_t servedLevels() const { return served_; }
  std::span<const Eigen::Index> levelBegin() const { return levelBegin_; }
  double size() const { return size_; }
  // After measure(): the row's coefficient of a rotation about, or slide along, a global axis, at a node (minus the
  // error's derivative), times the root of its weight.
  double slope(const IkSystem& system, Eigen::Index row, int node, const Vec3& axis, bool slides) const;
  bool active(Eigen::Index row) const { return rows_[static_cast<std::size_t>(row)].active; }
  // The error where the slopes were measured, times the root of the weight; 0 for rows that are not active.
  double residual(Eigen::Index row) const;
  // Makes inequalities that `step` would violate active; whether there are any.
  bool activate(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& step, Eigen::Index columns);

 private:
  struct Row {
    double error = 0;            // as last measured
    double errorWithSlopes = 0;  // as last measured with slopes
    double rootWeight = 1;
    bool inequality = false, active = true;
    bool wasViolated = false, pressed = false;  // when serve() was called; by press()
  };
  class Measure;

  double errorOf(std::size_t task) const;  // in rows' units
  double toleranceOf(std::size_t task) const;

  std::vector<IkTask> tasks_;
  IkOptions options_;
  std::vector<PointMass> masses_;
  double totalMass_ = 0;
  std::vector<Row> rows_;
  std::vector<Eigen::Index> rowBegin_, rowCount_;  // #tasks
  std::vector<std::size_t> levelOf_;               // #tasks
  std::vector<Eigen::Index> levelBegin_;
  std::vector<double> caps_;                      // #levels
  std::vector<Quat> restRotations_, restLocals_;  // #nodes, global; in the parent
  std::vector<Vec3> forces_, moments_;            // #rows * #nodes; moments about the origin
  std::size_t served_ = 1;
  double size_ = 1, angleScale_ = 1;  // metres; metres for a radian
};

}  // namespace limber
