#include "limber/asset/clip_moment.h"

#include "limber/asset/motion_io.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/rest_pose.h"

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
