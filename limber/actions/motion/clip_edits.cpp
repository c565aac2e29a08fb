#include "limber/actions/motion/clip_edits.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/character/character.h"
#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/clip/moving_parents.h"
#include "limber/document/clip/trim_animation.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/rig/root_joint.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/node_edit.h"
#include "limber/skeleton/clip/join_loop.h"
#include "limber/skeleton/clip/keys/key_reduction.h"
#include "limber/skeleton/clip/root_extraction.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

Clip looped(const Skeleton& skeleton, const Clip& clip, Index body, ClipEditReport& report) {
  LoopOptions options;
  options.body = body;
  report.loop = findLoop(skeleton, clip, options);
  if (!report.loop) return clip;
  JoinedLoop joined = joinLoop(skeleton, trimClip(clip, report.loop->begin, report.loop->end), body);
  report.gap = joined.gap;
  report.largestChange = joined.largestChange;
  return std::move(joined.clip);
}

// `root`: the joint that takes the travel, if one does.
Clip edited(const SkeletonReading& reading, Clip clip, std::optional<Index> root, const ClipEdits& edits,
            ClipEditReport& report) {
  const Skeleton& skeleton = reading.skeleton();
  const Index body = bodyJoint(reading);
  if (edits.loop) clip = looped(skeleton, clip, body, report);
  if (edits.inPlace || root) {
    RootMotionOptions options;
    options.body = body;
    options.height = edits.height;
    options.heading = edits.heading;
    options.smoothing = edits.smoothing;
    options.loops = report.loop.has_value();
    const RootTrajectory trajectory = rootTrajectory(skeleton, clip, options);
    clip = edits.inPlace ? clipInPlace(skeleton, clip, body, trajectory)
                         : extractRootMotion(skeleton, clip, *root, trajectory);
  }
  if (edits.frameRate) clip = resampleClip(clip, *edits.frameRate);
  return clip;
}

void renumberJoints(Clip& clip, const std::vector<Index>& number) {
  forEachTrack(clip, [&](auto& track) { track.joint = number[track.joint]; });
}

struct RootedCharacter {
  Character character;
  std::optional<Index> root;
};

void tellOfFollowers(Asset& asset, const Character& character, Index root) {
  if (!character.hasRig()) return;
  const SkinWeights& weights = character.weights();
  std::size_t followers = 0;
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    if (weights.joints[i] == root && weights.weights[i] > 0) ++followers;
  }
  asset.warnings.add("root-weights", "vertices follow the root joint in part, and its travel likewise",
                     character.skeleton().joints[root].name, followers);
}

// With the root joint that is asked for.
RootedCharacter withRootJoint(Asset& asset, const Character& character, const ClipEdits& edits) {
  if (!edits.rootJoint) return {character, std::nullopt};
  if (const std::optional<Index> root = findRootJoint(asset, character.moving())) {
    tellOfFollowers(asset, character, *root);
    return {character, root};
  }
  addRootJoint(asset, *edits.rootJoint);
  return {Character(asset), 0};
}

// Takes the animations of joints out; what else they move stays in them.
void removeJointChannels(Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations) {
  std::vector<bool> isJoint(asset.document.nodeCount(), false);
  for (const Index node : skeleton.jointNode) isJoint[node] = true;
  for (const Index a : animations) {
    removeChannels(asset.document.animations[a],
                   [&](Index node, std::string_view path) { return isJoint[node] && path.rfind("weights", 0) != 0; });
  }
}

CarriedPoints carriedBy(const Character& character) {
  if (!character.hasRig()) return carriedPoints(character.skeleton(), {}, {});
  return carriedPoints(character.skeleton(), character.surface().positions, character.weights());
}

}  // namespace

Index bodyJoint(const SkeletonReading& skeleton) {
  return skeleton.skeleton().joints.empty() ? 0 : skeleton.pieces().pelvis.value_or(0);
}

std::vector<ClipEditReport> editClips(Asset& asset, std::span<const std::string> names, const ClipEdits& edits,
                                      const SkeletonReading& known) {
  std::vector<ClipEditReport> reports;
  if (names.empty() || !edits.any()) return reports;
  std::vector<Index> animations;
  for (const std::string& name : names) {
    const std::vector<gltf::Animation>& all = asset.document.animations;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& animation) { return animation.name == name; });
    if (found == all.end()) {
      throw Error(ErrorCode::kBadArgument, fmt::format("there is no clip called '{}'", name), asset.name);
    }
    animations.push_back(static_cast<Index>(found - all.begin()));
  }
  const BufferViewSweep views(asset);
  const Character given(asset);
  settleMovingParents(asset, given.moving(), animations);
  const RootedCharacter rooted = withRootJoint(asset, given, edits);
  const AssetSkeleton& moving = rooted.character.moving();
  const AccessorSweep accessors(asset);  // after that: accessors have other numbers then
  std::vector<Clip> clips;
  {
    const std::vector<Clip> all = readClips(asset, moving, asset.warnings);
    for (const Index a : animations) clips.push_back(all[a]);
  }
  const Skeleton& skeleton = moving.skeleton;
  const SkeletonReading reading = known.of(skeleton);
  const CarriedPoints carried = edits.tolerance ? carriedBy(rooted.character) : CarriedPoints();
  for (Clip& clip : clips) {
    ClipEditReport report;
    report.clip = clip.name;
    clip = edited(reading, std::move(clip), rooted.root, edits, report);
    if (edits.tolerance) {
      ReducedClip reduced = reduceKeys(skeleton, clip, carried, {*edits.tolerance, true});
      report.keysBefore = reduced.keysBefore;
      report.keysAfter = reduced.keysAfter;
      report.largestError = reduced.largestError;
      clip = std::move(reduced.clip);
    }
    reports.push_back(std::move(report));
  }
  removeJointChannels(asset, moving, animations);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    const std::optional<ClipLoop>& loop = reports[c].loop;
    if (loop) loopAnimation(asset, asset.document.animations[animations[c]], {loop->begin, loop->end});
  }
  addClips(asset, moving, clips, {edits.tolerance.has_value()});
  moveLastAnimations(asset.document, animations);
  accessors.sweep(asset);
  views.sweep(asset);
  return reports;
}

std::vector<ClipEditReport> editClips(Motion& motion, const ClipEdits& edits) {
  std::vector<ClipEditReport> reports;
  std::optional<Index> root;
  if (edits.rootJoint) {
    Motion still = motion;
    still.clips.clear();
    still.warnings = {};
    Asset asset = motionAsset(still);
    const RootedCharacter rooted = withRootJoint(asset, Character(asset), edits);
    motion.warnings.append(asset.warnings);
    std::vector<Index> number;
    for (const Joint& joint : motion.skeleton.joints) number.push_back(*rooted.character.skeleton().find(joint.name));
    for (Clip& clip : motion.clips) renumberJoints(clip, number);
    motion.skeleton = rooted.character.skeleton();
    root = rooted.root;
  }
  const SkeletonReading reading(motion.skeleton);
  for (Clip& clip : motion.clips) {
    ClipEditReport report;
    report.clip = clip.name;
    clip = edited(reading, std::move(clip), root, edits, report);
    reports.push_back(std::move(report));
  }
  if (edits.frameRate) motion.framesPerSecond = *edits.frameRate;
  return reports;
}

}  // namespace limber
