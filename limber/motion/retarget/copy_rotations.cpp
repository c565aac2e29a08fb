#include "limber/motion/retarget/copy_rotations.h"

#include "limber/motion/limbs/body/root_motion.h"

namespace limber {

namespace {

class CopyRetargeter : public FrameRetargeter {
 public:
  explicit CopyRetargeter(const RetargetSetup& setup) : setup_(setup), root_(setup) {}

  void next(const Pose& source, double, Pose& target) override {
    setup_.sourceKinematics.globals(source, sourceFrame_);
    for (Index j = 0; j < setup_.target->jointCount(); ++j) target.locals[j] = setup_.target->joints[j].rest;
    for (const JointMatch& match : setup_.map.matches) {
      for (std::size_t i = 0; i < std::min(match.source.size(), match.target.size()); ++i) {
        const Quat rest = setup_.source->joints[match.source[i]].rest.rotation;
        const Quat turn = rest.conjugate() * source.locals[match.source[i]].rotation;
        Quat& rotation = target.locals[match.target[i]].rotation;
        rotation = (rotation * turn).normalized();
      }
    }
    setup_.targetKinematics.globals(target, targetFrame_);
    root_.apply(source, sourceFrame_, target, targetFrame_);
  }

 private:
  const RetargetSetup& setup_;
  RootPositioner root_;
  BodyFrame sourceFrame_, targetFrame_;
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeCopy(const RetargetSetup& setup) {
  return std::make_unique<CopyRetargeter>(setup);
}

}  // namespace limber
