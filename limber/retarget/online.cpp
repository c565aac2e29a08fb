#include "limber/retarget/online.h"

#include <cmath>
#include <optional>
#include <vector>

#include "limber/ik/ik_solver.h"
#include "limber/retarget/aligned.h"
#include "limber/retarget/limb_goals.h"

namespace limber {

namespace {

constexpr double kReferenceGain = 0.2;
constexpr Index kIterations = 30;  // a frame's limbs need about 5

class OnlineRetargeter : public FrameRetargeter {
 public:
  explicit OnlineRetargeter(const RetargetSetup& setup)
      : setup_(setup), aligned_(setup), goals_(setup, aligned_.root()) {
    for (const Leg& leg : goals_.legs()) addTask(leg);
    for (const Limb& arm : goals_.arms()) addTask(arm);
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
    if (!goals_.active() || !solver_) return;
    BodyFrame& frame = aligned_.targetFrame();
    if (setup_.options.contacts) {
      goals_.setFeet(aligned_.sourceFrame(), frame, seconds);
      const double up = goals_.pelvisShift(frame);
      if (std::abs(up) > 1e-9 * setup_.targetHipHeight) aligned_.root().movePelvis(Vec3(0, up, 0), target, frame);
    }
    goals_.setHands(aligned_.sourceFrame(), frame, seconds);
    std::size_t task = 0;
    for (const Leg& leg : goals_.legs()) setTask(leg, frame, task);
    for (const Limb& arm : goals_.arms()) setTask(arm, frame, task);
    solver_->setReference(target);
    solver_->solve(target, targets_);
    setup_.targetKinematics.globals(target, frame);
    aligned_.root().settle(target, frame);
  }

 private:
  bool isChain(const Limb& limb) const { return aligned_.root().carrierOf(limb.end) == limb.end; }

  void addTask(const Limb& limb) {
    if (!isChain(limb)) return;
    IkTarget& target = targets_.emplace_back();
    target.joint = limb.end;
    target.base = limb.upper;
    target.orientation = Quat::Identity();
  }

  // In the space of the target skeleton's own globals.
  void setTask(const Limb& limb, const BodyFrame& frame, std::size_t& task) {
    if (!isChain(limb)) return;
    IkTarget& target = targets_[task++];
    const Quat back = setup_.targetNeutral.toBody.conjugate();
    target.position = back * (limb.wanted ? limb.goal : frame.positions[limb.end]);
    target.orientation = (back * limb.turn * frame.rotations[limb.end]).normalized();
  }

  const RetargetSetup& setup_;
  AlignedRetargeter aligned_;
  LimbGoals goals_;
  std::vector<IkTarget> targets_;  // legs first
  std::optional<IkSolver> solver_;
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeOnline(const RetargetSetup& setup) {
  return std::make_unique<OnlineRetargeter>(setup);
}

}  // namespace limber
