// A pose made with some handles, for other handles of the same model.
#pragma once

#include <vector>

#include "limber/session/rigged_model.h"
#include "limber/skeleton/clip/clip_layer.h"

namespace limber {

// From one rig of a model to another: each joint goes where the surface that it moves goes, by the rigid motion that
// fits best there (weighted least squares over its vertices; Kabsch 1976). A joint that moves too little of the surface
// to tell follows the joint above it. What the fit needs to know of the vertices is gathered once, so that poses are
// cheap: a whole clip goes over in a moment.
class PoseTransfer {
 public:
  // Both must outlive it. Cost: O(#S).
  PoseTransfer(const RiggedModel& from, const RiggedModel& to);

  // The pose of `to` nearest to `from` in `pose`. It is `to.home`, bit for bit, where `pose` is `from.home`, and where
  // the two do not hold the same vertices (a file's own rig can bind its parts elsewhere). Cost: O(pairs of joints that
  // hold the same vertices).
  Pose apply(const Pose& pose) const;

 private:
  // What a joint of `from` holds of the vertices that a joint of `to` holds: moments of the bound vertices about the
  // middle of the model.
  struct JointMoments {
    Index joint = 0;  // of `from`; its joint count: vertices that it leaves where they are
    double weight = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
  };
  struct Patch {
    double weight = 0, spread = 0;  // spread: of the squared distances from the mean
    Vec3 mean = Vec3::Zero();
    std::vector<JointMoments> moments;
  };

  void gather();

  const RiggedModel& from_;
  const RiggedModel& to_;
  Vec3 middle_ = Vec3::Zero();
  std::vector<Patch> patches_;  // #J of `to`; empty where the two do not hold the same vertices
};

// Once.
Pose transferPose(const RiggedModel& from, const Pose& pose, const RiggedModel& to);

// A clip of `from` as one of `to`: a key for each moment that has one, each pose transferred. Between keys it runs as
// before; cubic tangents are made anew.
Clip transferClip(const PoseTransfer& transfer, const RiggedModel& from, const Clip& clip, const RiggedModel& to);

// A layer of `clip`, both of `from`: at each of its keys' moments, what the corrected pose transferred differs by from
// the clip's own pose transferred.
ClipLayer transferLayer(const PoseTransfer& transfer, const RiggedModel& from, const Clip& clip,
                        const ClipLayer& layer);

}  // namespace limber
