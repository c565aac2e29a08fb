#include "limber/motion/retarget/limb_ik.h"

#include <array>
#include <vector>

#include "limber/motion/limbs/body/arm_clearance.h"
#include "limber/motion/limbs/hand_goals.h"
#include "limber/motion/limbs/limb_reach.h"
#include "limber/motion/limbs/spring.h"
#include "limber/motion/retarget/aligned.h"
#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

namespace {

class LimbIkRetargeter : public FrameRetargeter {
 public:
  explicit LimbIkRetargeter(const RetargetSetup& setup)
      : setup_(setup),
        aligned_(setup),
        goals_(setup, aligned_.root()),
        hands_(setup, aligned_.root()),
        reach_(setup, aligned_.root()),
        clearance_(setup, aligned_.root()) {
    findIkMethod(setup.options.solver);
    if (setup.options.solver == "two-bone") return;
    for (const Leg& leg : goals_.legs()) legSolvers_.push_back(solverOf(leg.spec));
    for (const Arm& arm : hands_.arms()) armSolvers_.push_back(solverOf(arm.spec));
  }

  void next(const Pose& source, double seconds, Pose& target) override {
    aligned_.next(source, seconds, target);
    if (!goals_.active()) return;
    if (setup_.options.contacts) {
      std::vector<Leg>& legs = goals_.legs();
      goals_.adaptPose(from(), seconds, target, to());
      if (goals_.atCut()) hands_.reset();
      goals_.setFeet(from(), to(), seconds);
      goals_.pelvis().apply(goals_.pelvisMove(to()), target, to());
      for (std::size_t i = 0; i < legs.size(); ++i) {
        goals_.bendAsSource(legs[i], to());
        reach(legs[i].spec, legs[i].goal, solver(legSolvers_, i), target);
        goals_.levelToes(legs[i], to(), target);
      }
      goals_.tail().apply(target, to());
    }
    hands_.set(from(), to(), seconds);
    std::vector<Arm>& arms = hands_.arms();
    for (std::size_t i = 0; i < arms.size(); ++i) {
      reach(arms[i].spec, arms[i].goal, solver(armSolvers_, i), target);
    }
    if (setup_.options.contacts) keepArmsOut(goals_.atCut() ? 0 : seconds, target);
  }

 private:
  using Solvers = std::vector<std::unique_ptr<IkSolver>>;

  const BodyFrame& from() const { return aligned_.sourceFrame(); }
  BodyFrame& to() { return aligned_.targetFrame(); }

  void keepArmsOut(double seconds, Pose& target) {
    displacementsOut_.resize(clearance_.arms());
    for (std::size_t i = 0; i < clearance_.arms(); ++i) {
      for (const ArmClearance::Bone bone : {ArmClearance::Bone::kUpper, ArmClearance::Bone::kForearm}) {
        Sprung& follow = displacementsOut_[i][static_cast<std::size_t>(bone)];
        follow.drawTo(clearance_.displacementOut(i, bone, to()), kArmRate, seconds);
        clearance_.swing(i, bone, follow.value, to(), target);
      }
    }
  }

  std::unique_ptr<IkSolver> solverOf(const LimbSpec& limb) const {
    // A limb whose end only rides on it is no chain: two bones serve it.
    if (aligned_.root().carrierOf(limb.end) != limb.end) return nullptr;
    IkTarget goal;
    goal.joint = limb.end;
    goal.base = limb.upper;
    IkOptions options;
    options.restarts = 0;
    return std::make_unique<IkSolver>(findIkMethod(setup_.options.solver), *setup_.target,
                                      std::span<const IkTarget>(&goal, 1), nullptr, options);
  }
  static IkSolver* solver(const Solvers& solvers, std::size_t i) {
    return solvers.empty() ? nullptr : solvers[i].get();
  }

  void reach(const LimbSpec& limb, const LimbGoal& goal, IkSolver* solver, Pose& target) {
    if (LimbReach::isThere(limb, goal, to())) return;
    if (!solver) return reach_.reach(limb, goal, to(), target);
    const Quat orientation = goal.turn * to().rotations[limb.end];
    reachBySolver(limb, goal, *solver, target);
    setup_.targetKinematics.globals(target, to());
    reach_.turnEnd(limb.end, orientation, to(), target);
  }

  void reachBySolver(const LimbSpec& limb, const LimbGoal& goal, IkSolver& solver, Pose& target) {
    IkTarget end;
    end.joint = limb.end;
    end.base = limb.upper;
    end.position = setup_.targetNeutral.toBody.conjugate() * goal.position;
    solver.solve(target, std::span<const IkTarget>(&end, 1));
  }

  const RetargetSetup& setup_;
  AlignedRetargeter aligned_;
  LimbGoals goals_;
  HandGoals hands_;
  LimbReach reach_;
  ArmClearance clearance_;
  std::vector<std::array<Sprung, 2>> displacementsOut_;  // of each arm's bones
  Solvers legSolvers_, armSolvers_;                      // empty: two-bone
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeLimbIk(const RetargetSetup& setup) {
  return std::make_unique<LimbIkRetargeter>(setup);
}

}  // namespace limber
