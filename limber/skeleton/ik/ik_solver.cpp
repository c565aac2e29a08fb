#include "limber/skeleton/ik/ik_solver.h"

#include <string>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/core/text/names.h"
#include "limber/skeleton/ik/solvers/ccd.h"
#include "limber/skeleton/ik/solvers/damped_least_squares.h"
#include "limber/skeleton/ik/solvers/fabrik.h"
#include "limber/skeleton/ik/solvers/jacobian_transpose.h"
#include "limber/skeleton/ik/solvers/mass_spring.h"
#include "limber/skeleton/ik/solvers/particle_ik.h"
#include "limber/skeleton/ik/solvers/pseudo_inverse.h"
#include "limber/skeleton/ik/solvers/selectively_damped.h"
#include "limber/skeleton/ik/solvers/two_bone.h"
#include "limber/skeleton/ik/solvers/whole_body.h"

namespace limber {

namespace {

constexpr IkMethod kMethods[] = {
    {"two-bone", "analytic, for limbs of two bones; bends to a pole", "law of cosines", &makeTwoBone},
    {"ccd", "cyclic coordinate descent from the tip to the base",
     "Wang, Chen: A combined optimization method for solving the inverse kinematics problem, 1991", &makeCcdBackward},
    {"ccd-forward", "cyclic coordinate descent from the base to the tip",
     "Wang, Chen: A combined optimization method for solving the inverse kinematics problem, 1991", &makeCcdForward},
    {"fabrik", "forward and backward reaching, for chains and trees",
     "Aristidou, Chrysanthou, Lasenby: Extending FABRIK with model constraints, 2016", &makeFabrik},
    {"particle", "joints as particles at fixed distances, the spine first, then the limbs",
     "Hecker and others: Real-time motion retargeting to highly varied user-created morphologies, 2008",
     &makeParticleIk},
    {"jacobian-transpose", "steepest descent that goes on in the last step's direction too",
     "Wolovich, Elliott: A computational technique for inverse kinematics, 1984", &makeJacobianTranspose},
    {"pseudo-inverse", "smallest step by singular values", "Whitney: Resolved motion rate control, 1969",
     &makePseudoInverse},
    {"dls", "damped least squares, the damping scaled to what is left to go",
     "Sugihara: Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, 2011",
     &makeDampedLeastSquares},
    {"sdls", "selectively damped least squares",
     "Buss, Kim: Selectively damped least squares for inverse kinematics, 2005", &makeSelectivelyDamped},
    {"mass-spring", "springs to the targets pull at bones with masses: light tips go first",
     "Sekiguchi, Takesue: Fast and robust numerical method for inverse kinematics with prioritized multiple targets "
     "for redundant robots, 2020",
     &makeMassSpring},
    {"whole-body", "damped least squares with priorities, for many effectors and a moving root",
     "Baerlocher, Boulic: An inverse kinematics architecture enforcing an arbitrary number of strict priority levels, "
     "2004",
     &makeWholeBody},
};

constexpr double kNudge = 0.1;  // fraction of the rotation to a random one
constexpr double kSmallestJump = 0.2;
constexpr double kWorthwhile = 1e-12;
constexpr double kWorthGoingOn = 0.5;  // of the cost before, after all iterations of an attempt

}  // namespace

std::span<const IkMethod> ikMethods() {
  return kMethods;
}

const IkMethod& findIkMethod(std::string_view name) {
  return findByName(kMethods, "inverse kinematics method", name);
}

IkSolver::IkSolver(const IkMethod& method, const Skeleton& skeleton, std::span<const IkTarget> targets,
                   const JointLimits* limits, const IkOptions& options)
    : system_(skeleton, targets, limits, options), best_(system_.makeState()) {
  result_.targets.resize(targets.size());
  iteration_ = method.make(system_);
}

const IkResult& IkSolver::solve(Pose& pose, std::span<const IkTarget> targets) {
  system_.load(pose, targets);
  result_.iterations = result_.restarts = 0;
  stillGaining_ = false;
  random_ = Random(system_.options().seed);

  system_.save(best_);
  double best = system_.cost();
  if (!system_.allReached() || system_.options().referenceGain > 0) attempt(best);
  while (result_.restarts < system_.options().restarts && worthAnotherTry()) {
    if (!stillGaining_) perturb(result_.restarts);
    ++result_.restarts;
    attempt(best);
  }
  report();
  system_.store(pose);
  return result_;
}

// Runs the method from the system's state, and leaves the best state so far in the system.
void IkSolver::attempt(double& best) {
  const Index iterations = iteration_->run(system_, system_.options().maxIterations);
  if (system_.symmetric()) system_.forward();
  const double cost = system_.cost();
  result_.iterations += iterations;
  stillGaining_ = iterations >= system_.options().maxIterations && cost < kWorthGoingOn * best;
  // Once reached, what the method did besides (a reference pose approached) counts, not the last billionth.
  if (cost < best * (1 - kWorthwhile) || (system_.allReached() && result_.restarts == 0)) {
    best = std::min(best, cost);
    system_.save(best_);
  } else {
    system_.restore(best_);
  }
}

bool IkSolver::worthAnotherTry() const {
  for (std::size_t e = 0; e < system_.effectors.size(); ++e) {
    if (!system_.reached(e) && !system_.outOfReach(e)) return true;
  }
  return false;
}

// Jumps get shorter: from anywhere to near the best state.
void IkSolver::perturb(Index restart) {
  const Index count = system_.options().restarts;
  const double cooled = count > 2 ? (restart - 1.0) / (count - 2.0) : 0;
  perturbNodes(system_, random_, restart == 0 ? kNudge : 1 + cooled * (kSmallestJump - 1));
}

void IkSolver::report() {
  for (std::size_t e = 0; e < system_.effectors.size(); ++e) {
    IkTargetResult& target = result_.targets[e];
    target.distance = system_.distance(e);
    target.angle = system_.angle(e);
    target.outcome = system_.reached(e)      ? IkOutcome::kReached
                     : system_.outOfReach(e) ? IkOutcome::kOutOfReach
                                             : IkOutcome::kStuck;
  }
}

void perturbNodes(IkSystem& system, Random& random, double jump) {
  static const JointLimit kFree;
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const IkSystem::Node& node = system.nodes[i];
    if (node.freedom == 0) continue;
    // One after the other: in which order arguments are evaluated differs between compilers.
    const double z = random.uniform(), y = random.uniform(), x = random.uniform();
    const Quat anywhere = allowedRotation(node.limit ? *node.limit : kFree, Vec3(x, y, z));
    system.locals[i] = system.locals[i].slerp(jump, anywhere);
    system.limitNode(n);
  }
  system.forward();
}

IkResult solveIk(const IkMethod& method, const Skeleton& skeleton, Pose& pose, std::span<const IkTarget> targets,
                 const JointLimits* limits, const IkOptions& options) {
  return IkSolver(method, skeleton, targets, limits, options).solve(pose, targets);
}

}  // namespace limber
