#include "limber/retarget/online.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limber/ik/ik_solver.h"
#include "limber/limbs/hand_goals.h"
#include "limber/limbs/limb_goals.h"
#include "limber/limbs/limb_reach.h"
#include "limber/retarget/aligned.h"

namespace limber {

namespace {

constexpr double kReferenceGain = 0.2;
constexpr double kLeastBend = 0.2;      // radians: of a reference's knee that is straight, about
constexpr double kOverstretched = 0.5;  // likewise, of a knee that is meant to bend backward
constexpr Index kIterations = 30;       // a frame's limbs need about 5

class OnlineRetargeter : public FrameRetargeter {
 public:
  explicit OnlineRetargeter(const RetargetSetup& setup)
      : setup_(setup),
        aligned_(setup),
        goals_(setup, aligned_.root()),
        hands_(setup, aligned_.root()),
        reach_(setup, aligned_.root()) {
    for (const Leg& leg : goals_.legs()) addTask(leg);
    for (const Limb& arm : hands_.arms()) addTask(arm);
    if (targets_.empty()) return;
    IkOptions options;
    options.restarts = 0;  // another attempt might jump to another pose
    options.maxIterations = kIterations;
    options.tolerance = 1e-5;
    options.referenceGain = kReferenceGain;
    solver_.emplace(findIkMethod("dls"), *setup.target, targets_, nullptr, options);
  }

  void next(const Pose& source, double seconds, Pose& target) override {
    aligned_.next(source, seconds, target);
    if (!goals_.active()) return;
    BodyFrame& frame = aligned_.targetFrame();
    if (setup_.options.contacts) {
      goals_.calm(aligned_.sourceFrame(), seconds, target, frame);
      if (goals_.atCut()) hands_.reset();
      goals_.setFeet(aligned_.sourceFrame(), frame, seconds);
      goals_.pelvis().apply(goals_.pelvisMove(frame), target, frame);
      for (Leg& leg : goals_.legs()) goals_.bendAsSource(leg, frame);
    }
    hands_.set(aligned_.sourceFrame(), frame, seconds);
    std::size_t task = 0;
    for (const Leg& leg : goals_.legs()) {
      setTask(leg, frame, task);
      if (!isSolved(leg)) continue;
      if (setup_.person) bendKnee(leg, frame, target);
      // From a reference that bends to the other side the solver would have to snap.
      if (leg.ownBend && leg.wanted) reach_.reach(leg, &leg.kneeAhead, frame, target);
    }
    for (const Limb& arm : hands_.arms()) setTask(arm, frame, task);
    if (solver_) {
      solver_->setReference(target);
      // From where they reach: from joint angles that are far off there is more than one way.
      for (const Limb& arm : hands_.arms()) {
        if (isSolved(arm) && arm.wanted && !LimbReach::isThere(arm, frame)) reach_.reach(arm, nullptr, frame, target);
      }
      solver_->solve(target, targets_);
    }
    setup_.targetKinematics.globals(target, frame);
    aligned_.root().settle(target, frame);
    for (const Leg& leg : goals_.legs()) {
      if (!isSolved(leg) && leg.wanted && !LimbReach::isThere(leg, frame)) {
        reach_.reach(leg, &leg.kneeAhead, frame, target);
      }
      goals_.levelToes(leg, frame, target);
    }
    if (setup_.options.contacts) goals_.tail().apply(target, frame);
  }

 private:
  // By the solver, from the joint angles; else in closed form.
  bool isSolved(const Limb& limb) const { return isChain(limb) && !limb.ownWay; }
  bool isChain(const Limb& limb) const { return aligned_.root().carrierOf(limb.end) == limb.end; }

  void addTask(const Limb& limb) {
    if (!isSolved(limb)) return;
    IkTarget& target = targets_.emplace_back();
    target.joint = limb.end;
    target.base = limb.upper;
    target.orientation = Quat::Identity();
  }

  // In the space of the target skeleton's own globals.
  void setTask(const Limb& limb, const BodyFrame& frame, std::size_t& task) {
    if (!isSolved(limb)) return;
    IkTarget& target = targets_[task++];
    const Quat back = setup_.targetNeutral.toBody.conjugate();
    target.position = back * (limb.wanted ? limb.goal : frame.positions[limb.end]);
    target.orientation = (back * limb.turn * frame.rotations[limb.end]).normalized();
  }

  // Knees of the reference that are straight or a little overstretched bend forward: else they would snap from one side
  // to the other where the legs have to be bent.
  void bendKnee(const Leg& leg, const BodyFrame& frame, Pose& reference) const {
    const Vec3 upper = (frame.positions[leg.lower] - frame.positions[leg.upper]).normalized();
    const Vec3 lower = (frame.positions[leg.end] - frame.positions[leg.lower]).normalized();
    const Quat turn = frame.rotations[leg.upper] * setup_.targetNeutral.rotations[leg.upper].conjugate();
    const Vec3 axis = (turn * Vec3::UnitZ()).cross(upper).normalized();
    const double bend = std::atan2(axis.dot(upper.cross(lower)), upper.dot(lower));
    const double little = std::clamp(2 * (1 + bend / kOverstretched), 0.0, 1.0);
    const double more = little * (0.5 * (bend + std::hypot(bend, 2 * kLeastBend)) - bend);
    const Quat above = setup_.targetKinematics.parentRotation(leg.lower, frame);
    reference.locals[leg.lower].rotation =
        (above.conjugate() * Eigen::AngleAxisd(more, axis) * frame.rotations[leg.lower]).normalized();
  }

  const RetargetSetup& setup_;
  AlignedRetargeter aligned_;
  LimbGoals goals_;
  HandGoals hands_;
  LimbReach reach_;                // of legs that end on a root of their own, or bend to a side of their own
  std::vector<IkTarget> targets_;  // legs first
  std::optional<IkSolver> solver_;
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeOnline(const RetargetSetup& setup) {
  return std::make_unique<OnlineRetargeter>(setup);
}

}  // namespace limber
