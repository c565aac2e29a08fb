#include "limber/document/clip/clip_moment.h"

#include "limber/document/clip/motion_io.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"

namespace limber {

Pose poseAt(const Asset& asset, const AssetSkeleton& skeleton, const ClipMoment& moment) {
  const Clip clip = findClip(asset, moment.clip);
  if (asset.document.animations.empty()) {
    throw Error(ErrorCode::kBadArgument, "has no clip to stand in", asset.name);
  }
  Pose pose = readNodePose(asset, skeleton);
  sampleClip(clip, moment.seconds, pose);
  return pose;
}

ShapeWeights shapesAt(const Asset& asset, const ClipMoment& moment) {
  return readShapeWeights(asset, animationNamed(asset.document, findClip(asset, moment.clip).name), moment.seconds);
}

void standAt(Asset& asset, const ClipMoment& moment) {
  const AssetSkeleton skeleton = readSkeleton(asset);
  setRestPose(asset, skeleton, poseAt(asset, skeleton, moment));
}

}  // namespace limber
