// What all Jacobian methods have in common: build the Jacobian, take the method's step level by level of priority, fix
// joints at their limits, approach the reference pose in the null space, and keep only steps that gain.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/solvers/jacobian.h"

namespace limber {

// One level's rows of the Jacobian J, without what higher priorities need and joints at their limits cannot do.
struct JacobianRows {
  Eigen::Ref<const Eigen::MatrixXd> jacobian;  // #rows x #columns
  Eigen::Ref<Eigen::MatrixXd> gram;            // J * J^T; may be overwritten
  Eigen::Index begin = 0;                      // of the level's rows among all
  Index iteration = 0;                         // of this run
  double caution = 1;                          // doubled and more when a step gained nothing, lowered when one did
};

class JacobianIteration : public IkIteration {
 public:
  Index run(IkSystem& system, Index budget) final;

 protected:
  // gains as for IkJacobian, to be multiplied by each node's freedom.
  JacobianIteration(const IkSystem& system, std::vector<double> gains);
  explicit JacobianIteration(const IkSystem& system);

  // Turns `y`, what is left to go (#rows), into the weights with which the step J^T * y combines the rows.
  virtual void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) = 0;
  // Whether the method takes account of the caution itself; the step is shortened for others.
  virtual bool heedsCaution() const { return false; }

 private:
  bool improve(IkSystem& system);
  void becomeBolder();
  double firstOrderGain(const IkSystem& system) const;
  int servedLevels(const IkSystem& system) const;
  void findStep(const IkSystem& system);
  void findStepOfActive(const IkSystem& system);
  void addLevel(int level, bool last);
  void projectLevel(Eigen::Index begin, Eigen::Index end);
  void extendBasis(Eigen::Index begin, Eigen::Index end);
  void gramOfRows(Eigen::Index begin, Eigen::Index end, const Eigen::MatrixXd& matrix, bool dense);
  bool blockLimits(const IkSystem& system);
  bool blockNode(const IkSystem& system, int node);
  void addSecondary(const IkSystem& system);
  void shorten();
  void apply(IkSystem& system) const;
  double referenceDistance(const IkSystem& system) const;

  IkJacobian jacobian_;
  IkSystem::State before_, gained_;
  std::vector<std::vector<Eigen::Index>> rowsOf_;  // #nodes; rows that a node's columns can have entries in
  bool masksRows_ = false;                         // rows that are out of play are 0 in `reduced_`
  Eigen::MatrixXd reduced_;                        // the Jacobian without the directions in which limits block
  Eigen::MatrixXd projected_;                      // one level's rows of it, without what higher priorities span
  Eigen::MatrixXd basis_;                          // orthonormal rows: that span
  Eigen::Index basisRows_ = 0;
  Index iteration_ = 0;
  double caution_ = 1;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd error_, y_;                 // #rows
  Eigen::VectorXd fixed_, step_, secondary_;  // #columns
};

// The freedom (1 - stiffness) of each node.
std::vector<double> freedomsOf(const IkSystem& system);

}  // namespace limber
