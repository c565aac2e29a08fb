// Inverse kinematics, one interface for every method: targets for some joints in, a pose that serves them out. One
// table lists the methods by name.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "limber/core/random.h"
#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/ik/ik_system.h"

namespace limber {

// How a method improves a system's state. Made once for a system; run() takes no memory.
class IkIteration {
 public:
  virtual ~IkIteration() = default;
  // Improves the state for at most `budget` iterations, ends early when all targets are reached or nothing is gained
  // any more. Globals and positions are derived when it returns, and no limit is broken. Returns the iterations done.
  virtual Index run(IkSystem& system, Index budget) = 0;
};

struct IkMethod {
  std::string_view name;     // "fabrik"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  std::unique_ptr<IkIteration> (*make)(const IkSystem& system);
};

std::span<const IkMethod> ikMethods();
// Throws Error kBadArgument that lists the names there are.
const IkMethod& findIkMethod(std::string_view name);

// A method set up for one skeleton and one set of effectors; then solved again and again, from frame to frame, without
// taking memory. The start pose is the warm start. Same calls, same answers, bit for bit.
//
// The answer keeps every bone's length, breaks no limit and is never worse than the start pose bent into its limits, by
// IkSystem::cost(). Joints on no path from a base to an effector stay as they are. Where skeleton, limits, start pose
// and targets are the same left and right, so is the answer, even if a pose that differs would come nearer.
class IkSolver {
 public:
  // Skeleton and limits (none: null) must outlive the solver. Errors as of IkSystem; some methods refuse what they
  // cannot do (kBadArgument).
  IkSolver(const IkMethod& method, const Skeleton& skeleton, std::span<const IkTarget> targets,
           const JointLimits* limits = nullptr, const IkOptions& options = {});

  // The pose to stay near from now on, instead of IkOptions::reference; of that skeleton.
  void setReference(const Pose& reference) { system_.setReference(reference); }

  // `pose` is the start and becomes the answer. Errors as of IkSystem::load. The result lives until the next call.
  const IkResult& solve(Pose& pose, std::span<const IkTarget> targets);

 private:
  void attempt(double& best);
  void perturb(Index restart);
  void report();
  bool worthAnotherTry() const;

  IkSystem system_;
  std::unique_ptr<IkIteration> iteration_;
  IkSystem::State best_;
  IkResult result_;
  Random random_;
  bool stillGaining_ = false;  // when the last attempt's iterations were used up
};

// Turns every node that moves by the fraction `jump` towards a random rotation that its limits allow.
void perturbNodes(IkSystem& system, Random& random, double jump);

// The same as an IkSolver's for a single solve.
IkResult solveIk(const IkMethod& method, const Skeleton& skeleton, Pose& pose, std::span<const IkTarget> targets,
                 const JointLimits* limits = nullptr, const IkOptions& options = {});

}  // namespace limber
