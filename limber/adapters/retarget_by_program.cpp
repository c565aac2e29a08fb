#include "limber/adapters/retarget_by_program.h"

#include <utility>

#include <fmt/format.h>

#include "limber/actions/rig/stand_upright.h"
#include "limber/adapters/handed_motion.h"
#include "limber/adapters/program_run.h"
#include "limber/adapters/returned_motion.h"
#include "limber/character/matching/motion_bodies.h"
#include "limber/character/matching/plain_skeleton.h"
#include "limber/core/error.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"

namespace limber {

namespace {

void checkCanRetarget(const Asset& asset, const Motion& motion, const Adapter& adapter) {
  if (adapter.kind != AdapterKind::kRetarget) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("is of kind {}, no retargeting method", adapterKindName(adapter.kind)), adapter.name);
  }
  if (!canMove(asset)) throw Error(ErrorCode::kUnsupported, "the model has no rig to move", asset.name);
  if (motion.clips.empty()) throw Error(ErrorCode::kUnsupported, "holds no motion", motion.name);
}

// Both stand in rest pose when they are handed over, also where one lies in its own file.
Motion standing(const Motion& motion) {
  const SkeletonReading skeleton(motion.skeleton);
  return turnedMotion(asItRests(motion, skeleton), turnToStand(skeleton));
}

Skeleton turnedSkeleton(const Skeleton& skeleton, const Quat& turn) {
  Motion still;
  still.skeleton = skeleton;
  return turnedMotion(std::move(still), turn).skeleton;
}

}  // namespace

ProgramClips retargetByProgram(Asset& asset, const Character& character, const Motion& given, const Adapter& adapter,
                               const RetargetAssetOptions& options, Progress& progress) {
  checkCanRetarget(asset, given, adapter);
  const Motion motion = standing(motionOfBody(given, options.body));
  const PlainSkeleton plain(character.skeleton());
  const Skeleton handed = plainlyNamed(turnedSkeleton(plain.skeleton(), options.turn));
  ProgramClips made;
  std::vector<Clip> clips;
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    const Clip& clip = motion.clips[c];
    HandedFrames frames;
    frames.framesPerSecond = options.frameRate.value_or(frameRateOf(motion, c));
    frames.count = frameCount(clip, frames.framesPerSecond);
    const Bytes motionFile = handedMotion(motion, c, frames.framesPerSecond, adapter);
    const Bytes skeletonFile = handedSkeleton(handed, frames.framesPerSecond, adapter);
    frames.isStill = frameCount(readBvh(motionFile, motion.name).clips.front(), frames.framesPerSecond) == 1;
    const ProgramOutput output = runProgram(adapter, {motionFile, skeletonFile}, progress);
    ReturnedMotion returned = readReturnedMotion(output, adapter, handed, frames);
    const std::string& name = motion.clips.size() == 1 ? motion.name : clip.name;
    clips.push_back(clipOf(character.skeleton(), plain.original(std::move(returned.frames)), name));
    made.clips.push_back({name, frames.count, frames.framesPerSecond, {}, {}, {}});
    made.warnings.append(returned.warnings);
  }
  const std::vector<std::string> written = addClips(asset, character.moving(), clips);
  for (std::size_t c = 0; c < written.size(); ++c) made.clips[c].name = written[c];
  return made;
}

}  // namespace limber
