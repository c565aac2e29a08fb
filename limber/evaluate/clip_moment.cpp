#include "limber/evaluate/clip_moment.h"

#include "limber/asset/motion_io.h"
#include "limber/asset/rest_pose.h"

namespace limber {

void standAt(Asset& asset, const ClipMoment& moment) {
  const Clip clip = findClip(asset, moment.clip);
  if (clip.translations.empty() && clip.rotations.empty() && clip.scales.empty()) {
    throw Error(ErrorCode::kBadArgument, "has no clip to stand in", asset.name);
  }
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = restPose(skeleton.skeleton);
  sampleClip(clip, moment.seconds, pose);
  setRestPose(asset, skeleton, pose);
}

}  // namespace limber
