#include "limber/retarget/limb_ik.h"

#include <algorithm>
#include <cmath>

#include "limber/ik/ik_solver.h"
#include "limber/ik/rotation.h"
#include "limber/ik/two_bone.h"
#include "limber/retarget/aligned.h"
#include "limber/retarget/limb_goals.h"

namespace limber {

namespace {

constexpr double kKneesForward = 0.02;   // of the leg's length, added to its bend
constexpr double kOverstretched = 0.12;  // likewise, of a knee that is meant to bend backward

class LimbIkRetargeter : public FrameRetargeter {
 public:
  explicit LimbIkRetargeter(const RetargetSetup& setup)
      : setup_(setup), aligned_(setup), goals_(setup, aligned_.root()) {
    findIkMethod(setup.options.solver);
    if (setup.options.solver == "two-bone") return;
    for (const Leg& leg : goals_.legs()) legSolvers_.push_back(solverOf(leg));
    for (const Limb& arm : goals_.arms()) armSolvers_.push_back(solverOf(arm));
  }

  void next(const Pose& source, double seconds, Pose& target) override {
    aligned_.next(source, seconds, target);
    if (!goals_.active()) return;
    if (setup_.options.contacts) {
      goals_.setFeet(from(), to(), seconds);
      aligned_.root().turnPelvis(goals_.pelvisTurn(to()), target, to());
      const double up = goals_.pelvisShift(to());
      if (std::abs(up) > 1e-9 * setup_.targetHipHeight) aligned_.root().movePelvis(Vec3(0, up, 0), target, to());
      std::vector<Leg>& legs = goals_.legs();
      for (std::size_t i = 0; i < legs.size(); ++i) {
        reach(legs[i], solver(legSolvers_, i), &legs[i].kneeAhead, target);
        goals_.levelToes(legs[i], to(), target);
      }
    }
    goals_.setHands(from(), to(), seconds);
    std::vector<Limb>& arms = goals_.arms();
    for (std::size_t i = 0; i < arms.size(); ++i) {
      if (arms[i].wanted) reach(arms[i], solver(armSolvers_, i), nullptr, target);
    }
  }

 private:
  using Solvers = std::vector<std::unique_ptr<IkSolver>>;

  const BodyFrame& from() const { return aligned_.sourceFrame(); }
  BodyFrame& to() { return aligned_.targetFrame(); }

  std::unique_ptr<IkSolver> solverOf(const Limb& limb) const {
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

  void reach(const Limb& limb, IkSolver* solver, const Vec3* kneeAhead, Pose& target) {
    BodyFrame& frame = to();
    const bool stays = (limb.goal - frame.positions[limb.end]).norm() < 1e-9 * limb.length;
    if (stays && limb.turn.w() == 1) return;
    const Quat orientation = limb.turn * frame.rotations[limb.end];
    if (solver) {
      reachBySolver(limb, *solver, target);
    } else {
      turnTwoBones(limb, kneeAhead, target);
    }
    // The end stands as it did, turned where a planted foot asks for it.
    const BodyKinematics& kinematics = setup_.targetKinematics;
    kinematics.globals(target, frame);
    target.locals[limb.end].rotation =
        (kinematics.parentRotation(limb.end, frame).conjugate() * orientation).normalized();
    kinematics.globals(target, frame);
    aligned_.root().settle(target, frame);
  }

  void turnTwoBones(const Limb& limb, const Vec3* kneeAhead, Pose& target) {
    const BodyFrame& frame = to();
    TwoBone bones{
        frame.positions[limb.upper], frame.positions[limb.lower], frame.positions[limb.end], limb.goal, {}, {}};
    if (kneeAhead) bones.pole = kneePole(limb, bones, *kneeAhead);
    const TwoBoneTurns turns = solveTwoBone(bones);
    const BodyKinematics& kinematics = setup_.targetKinematics;
    const Quat aboveUpper = kinematics.parentRotation(limb.upper, frame);
    const Quat aboveLower = turns.start * kinematics.parentRotation(limb.lower, frame);
    target.locals[limb.upper].rotation =
        (aboveUpper.conjugate() * turns.start * frame.rotations[limb.upper]).normalized();
    target.locals[limb.lower].rotation =
        (aboveLower.conjugate() * turns.middle * frame.rotations[limb.lower]).normalized();
  }

  // Knees bend to where they bend now, and forward where they hardly do or are a little overstretched: else they would
  // snap from one side to the other.
  Vec3 kneePole(const Limb& limb, const TwoBone& bones, const Vec3& kneeAhead) const {
    const Vec3 way = (bones.end - bones.start).normalized(), knee = bones.middle - bones.start;
    const Quat turn =
        aligned_.targetFrame().rotations[limb.upper] * setup_.targetNeutral.rotations[limb.upper].conjugate();
    const Vec3 ahead = turn * kneeAhead, forward = (ahead - ahead.dot(way) * way).normalized();
    Vec3 bend = knee - knee.dot(way) * way;
    const double backward = std::max(-bend.dot(forward), 0.0);
    const double little = std::max(1 - backward / (kOverstretched * limb.length), 0.0);
    bend += little * (backward + kKneesForward * limb.length) * forward;
    // Seen from the way to the goal: of a leg that is nearly straight, the knee itself may lie on its other side.
    const Vec3 there = bones.target - bones.start;
    return bones.start + 0.5 * there + shortestRotation(way, there) * bend;
  }

  void reachBySolver(const Limb& limb, IkSolver& solver, Pose& target) {
    IkTarget wanted;
    wanted.joint = limb.end;
    wanted.base = limb.upper;
    wanted.position = setup_.targetNeutral.toBody.conjugate() * limb.goal;
    solver.solve(target, std::span<const IkTarget>(&wanted, 1));
  }

  const RetargetSetup& setup_;
  AlignedRetargeter aligned_;
  LimbGoals goals_;
  Solvers legSolvers_, armSolvers_;  // empty: two-bone
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeLimbIk(const RetargetSetup& setup) {
  return std::make_unique<LimbIkRetargeter>(setup);
}

}  // namespace limber
