// The character whose motions are mixed: its skeleton without mirror images, what carries it and its legs.
#pragma once

#include <vector>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/motion/limbs/limb_goals.h"

namespace limber {

// Immutable once made; the skeleton must outlive it. Throws Error kUnsupported as matchSkeletons does.
class MixBody {
 public:
  explicit MixBody(const Skeleton& skeleton);
  // The setup points into it.
  MixBody(const MixBody&) = delete;
  MixBody& operator=(const MixBody&) = delete;

  const Skeleton& original() const { return original_; }
  const PlainSkeleton& plain() const { return plain_; }
  // From the plain skeleton to itself, solved for limbs as between two bodies.
  const RetargetSetup& setup() const { return setup_; }
  const RootPositioner& root() const { return root_; }
  const TrunkTilt& trunk() const { return goals_.pelvis().trunk(); }
  // Each bends to where its joint angles bend it.
  const std::vector<LegSpec>& legs() const { return legs_; }
  // The joint whose turn about the vertical is the body's heading.
  Index pelvis() const { return pelvis_; }

  void globals(const Pose& pose, BodyFrame& frame) const { setup_.targetKinematics.globals(pose, frame); }

 private:
  const Skeleton& original_;
  PlainSkeleton plain_;
  RetargetSetup setup_;
  RootPositioner root_;
  LimbGoals goals_;
  std::vector<LegSpec> legs_;
  Index pelvis_;
};

}  // namespace limber
