#include "limber/crowd/body_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/asset/clip_io.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/node_edit.h"
#include "limber/crowd/crowd.h"
#include "limber/pipeline/stand_upright.h"
#include "limber/retarget/retarget_clip.h"

namespace limber {

namespace {

void removeClips(Asset& asset) {
  removeChannels(asset, [](Index, std::string_view) { return true; });
}

// Tracks of one value keep one key. A clip in which all stands then has no duration to be held by a second key.
template <typename Value>
void keepOneKeyOfStill(std::vector<Track<Value>>& tracks) {
  for (Track<Value>& track : tracks) {
    const auto isFirst = [&](const Value& value) { return value.isApprox(track.values.front(), 0); };
    if (!std::all_of(track.values.begin(), track.values.end(), isFirst)) continue;
    track.times.resize(1);
    track.values.resize(1);
  }
}

}  // namespace

BodyMotion moveBuild(const Asset& character, const BodyBuild& build, std::span<const Motion> motions,
                     const CrowdOptions& options, SkeletonMatches& matches) {
  BodyMotion body;
  try {
    Asset asset = character.clone();
    if (!hasRig(asset)) {
      throw Error(ErrorCode::kUnsupported, "the model has no rig to move", {}, "limber rig or animate makes one");
    }
    Warnings warnings = asset.warnings;
    RetargetAssetOptions retarget = options.retarget;
    retarget.turn = standUpright(asset, warnings);
    retarget.matches = &matches;
    retarget.frameRate = options.framesPerSecond;
    asset.warnings = warnings;
    changeBuild(asset, build);
    body.still = asset.clone();
    std::vector<std::string> names;
    for (const Motion& motion : motions) {
      for (const RetargetedClip& clip : retargetOnto(asset, motion, retarget)) names.push_back(clip.name);
    }
    editClips(asset, names, options.edits);
    Warnings ofKeys;
    body.clips = readClips(asset, animatedSkeleton(asset), ofKeys);
    removeClips(asset);
    body.moving = std::move(asset);
  } catch (const Error& error) {
    throw error.within(character.name);
  }
  for (const Clip& clip : body.clips) {
    body.cycles.push_back(std::max<Index>(1, frameCount(clip, options.framesPerSecond) - 1));
  }
  return body;
}

void lengthenClips(BodyMotion& body, Index frames, double framesPerSecond) {
  const AssetSkeleton character = animatedSkeleton(body.moving);
  std::vector<Clip> lengthened;
  for (std::size_t c = 0; c < body.clips.size(); ++c) {
    const std::size_t cycle = body.cycles[c];
    const PoseSequence once = sampleFrames(character.skeleton, body.clips[c], framesPerSecond);
    PoseSequence all;
    all.frameSeconds = once.frameSeconds;
    for (std::size_t f = 0; f < frames + cycle; ++f) all.poses.push_back(once.poses[f % cycle]);
    Clip clip = clipOf(character.skeleton, all, body.clips[c].name);
    keepOneKeyOfStill(clip.translations);
    keepOneKeyOfStill(clip.rotations);
    lengthened.push_back(std::move(clip));
  }
  addClips(body.moving, character, lengthened);
}

}  // namespace limber
