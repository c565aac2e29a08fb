// Methods that move joints as points and fit the rotations afterwards: FABRIK, particles.
#pragma once

#include <vector>

#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/solvers/leap.h"

namespace limber {

// One iteration: the method says where every joint should go, then, from the base on, each joint turns as is best for
// all its children and is bent into its limits, so that every iteration ends in an allowed pose. A limited joint also
// twists to bring the effectors beyond the next joint nearer.
class GoalIteration : public IkIteration {
 public:
  explicit GoalIteration(const IkSystem& system);
  Index run(IkSystem& system, Index budget) final;

 protected:
  // Fills goals_ and weights_ for the system's current state.
  virtual void setGoals(const IkSystem& system) = 0;

  std::vector<Vec3> goals_;      // #nodes
  std::vector<double> weights_;  // #nodes, against those of the same parent
  std::vector<double> heed_;     // #effectors, their weights in this iteration

 private:
  bool isTurnOfEffectors(Index done) const;
  void forward(IkSystem& system);
  void recordEffectorOffsets(const IkSystem& system);
  static void updatePosition(IkSystem& system, int node);
  void turn(IkSystem& system, int node) const;
  Quat wantedTurn(const IkSystem& system, int node) const;
  static bool hasOrientation(const IkSystem& system, int node);
  Quat twistAlong(const IkSystem& system, int node, const Quat& global) const;
  Quat turnForEffectors(const IkSystem& system, int node) const;
  Mat3 effectorsAgainstTargets(const IkSystem& system, int node, const Quat& global) const;

  std::vector<std::size_t> firstOffset_;  // #nodes, into effectorOffsets_
  std::vector<Vec3> effectorOffsets_;     // for each node and each effector below it
  Leap leap_;
  IkSystem::State best_;
  bool servesEffectors_ = false;  // in this iteration, rather than the joints' goals
};

}  // namespace limber
