#include "limber/crowd/body_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/actions/rig/stand_upright.h"
#include "limber/crowd/crowd.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/node_edit.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/clip/root_trajectory.h"

namespace limber {

namespace {

void removeClips(Asset& asset) {
  removeChannels(asset, [](Index, std::string_view) { return true; });
}

// Tracks of one value keep one key. So a clip without any motion has no duration, which only a second key could give.
template <typename Value>
void keepOneKeyOfStill(std::vector<Track<Value>>& tracks) {
  for (Track<Value>& track : tracks) {
    const auto isFirst = [&](const Value& value) { return value.isApprox(track.values.front(), 0); };
    if (!std::all_of(track.values.begin(), track.values.end(), isFirst)) continue;
    track.times.resize(1);
    track.values.resize(1);
  }
}

// What a build is like in rest pose, once its clips' turn makes it stand.
struct StandingBody {
  Skeleton skeleton;
  Index body;  // its bodyJoint
  Box box;     // of its surface
};

StandingBody standingBody(const Geometry& still, const Skeleton& skeleton, const Quat& turn) {
  StandingBody body{skeleton, 0, {}};
  for (Joint& joint : body.skeleton.joints) {
    if (joint.parent) continue;
    joint.rest.translation = turn * joint.rest.translation;
    joint.rest.rotation = turn * joint.rest.rotation;
  }
  body.body = bodyJoint(body.skeleton);
  for (const Vec3f& position : still.positions) body.box.add(turn * position.cast<double>());
  return body;
}

// Where the body has gone over the ground, and turned, from its rest pose when a clip begins: recordings begin
// anywhere.
Vec3 startOf(const StandingBody& body, const Clip& clip) {
  RootMotionOptions options;
  options.body = body.body;
  options.heading = true;
  options.smoothing = 0;
  const Vec3 rest(body.box.center().x(), body.box.min.y(), body.box.center().z());
  return rootTrajectory(body.skeleton, clip, options).at(0).toAffine() * rest;
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
    retarget.turn = standUpright(asset, warnings).turn;
    retarget.matches = &matches;
    retarget.frameRate = options.framesPerSecond;
    asset.warnings = warnings;
    changeBuild(asset, build);
    body.still = asset.clone();
    const Character built(body.still);
    std::vector<std::string> names;
    for (const Motion& motion : motions) {
      try {
        for (const RetargetedClip& clip : retargetOnto(asset, built, motion, retarget)) names.push_back(clip.name);
      } catch (const Error& error) {
        throw error.within(motion.name);
      }
    }
    editClips(asset, names, options.edits, built.reading());
    Warnings ofKeys;
    body.skeleton = animatedSkeleton(asset);  // clips may have got a root joint
    const StandingBody standing = standingBody(built.surface(), body.skeleton.skeleton, retarget.turn);
    body.width = std::max(standing.box.size().x(), standing.box.size().z());
    for (Clip& clip : readClips(asset, body.skeleton, ofKeys)) {
      const Index cycle = std::max<Index>(1, frameCount(clip, options.framesPerSecond) - 1);
      const Vec3 start = startOf(standing, clip);
      body.clips.push_back({std::move(clip), cycle, start});
    }
    removeClips(asset);
    body.moving = std::move(asset);
  } catch (const Error& error) {
    throw error.within(character.name);
  }
  return body;
}

void lengthenClips(BodyMotion& body, Index frames, double framesPerSecond) {
  const Skeleton& skeleton = body.skeleton.skeleton;
  std::vector<Clip> lengthened;
  for (const BodyClip& one : body.clips) {
    const PoseSequence once = sampleFrames(skeleton, one.clip, framesPerSecond);
    PoseSequence all;
    all.frameSeconds = once.frameSeconds;
    for (std::size_t f = 0; f < std::size_t{frames} + one.cycle; ++f) all.poses.push_back(once.poses[f % one.cycle]);
    Clip clip = clipOf(skeleton, all, one.clip.name);
    keepOneKeyOfStill(clip.translations);
    keepOneKeyOfStill(clip.rotations);
    lengthened.push_back(std::move(clip));
  }
  addClips(body.moving, body.skeleton, lengthened);
}

}  // namespace limber
