// What of a model moves, as a SkelAnimation.
#pragma once

#include "limber/document/usd/usd_model.h"
#include "limber/document/usd/usd_stage.h"

namespace limber {

class UsdMotion {
 public:
  // The model must outlive this.
  explicit UsdMotion(const UsdModel& model);

  // Has the model joints or blend shapes at all?
  bool isNeeded() const;
  // The clip's frame rate where that is a whole number, so that keys lie at whole time codes.
  double timeCodesPerSecond() const { return timeCodesPerSecond_; }
  // The time of the last key of all, in seconds; 0 where nothing is animated.
  double duration() const;

  // The prim "Motion": joints and weights of blend shapes, sampled at the keys of what moves, except where
  // interpolation between the neighbours gives the same; each once where it is constant.
  UsdPrim prim() const;

 private:
  void addJoints(UsdPrim& prim) const;
  void addShapes(UsdPrim& prim) const;
  Pose poseAt(double seconds) const;

  const UsdModel& model_;
  double timeCodesPerSecond_ = 24;
};

}  // namespace limber
