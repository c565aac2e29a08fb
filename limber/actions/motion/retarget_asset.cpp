#include "limber/actions/motion/retarget_asset.h"

#include <fmt/format.h>

#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/motion_bodies.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/rig/rig_io.h"
#include "limber/motion/mix/planted_feet.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/clip/moving_scales.h"

namespace limber {

namespace {

std::string namesOf(const std::vector<Index>& joints, const Skeleton& skeleton) {
  std::string names;
  for (const Index joint : joints) names += (names.empty() ? "" : " + ") + skeleton.joints[joint].name;
  return names;
}

std::vector<std::string> doubtfulMatches(const SkeletonMap& map, const Skeleton& source, const Skeleton& target) {
  std::vector<std::string> lines;
  for (const JointMatch& match : map.matches) {
    if (match.confidence >= kDoubtful || match.by == MatchedBy::kFile) continue;
    lines.push_back(fmt::format("{}: {} -> {}", nameOf(match, target), namesOf(match.source, source),
                                namesOf(match.target, target)));
  }
  return lines;
}

// A map names its joints itself.
Motion bodyOf(const Motion& motion, const RetargetAssetOptions& options) {
  return options.mapJson && options.body.empty() ? motion : motionOfBody(motion, options.body);
}

SkeletonMap mapFor(const Motion& motion, const SkeletonReading& source, const SkeletonReading& target,
                   const RetargetAssetOptions& options) {
  if (options.mapJson) return skeletonMapFromJson(*options.mapJson, motion.skeleton, target.skeleton());
  if (!options.matches) return matchMotion(motion, source, target, options.unlikeBodies);
  const std::optional<Pose> pose = poseWithForm(motion);
  return options.matches->match(source, target, options.unlikeBodies, pose ? &*pose : nullptr);
}

void warnOfDoubts(const SkeletonMap& map, const Motion& motion, const Skeleton& target, Warnings& warnings) {
  const std::vector<std::string> doubtful = doubtfulMatches(map, motion.skeleton, target);
  if (doubtful.empty()) return;
  warnings.add(
      "doubtful-matches",
      fmt::format("joints are matched with a confidence below {:g}: look at them, and correct the map", kDoubtful),
      fmt::format("{}: {}", motion.name, doubtful.front()), doubtful.size());
}

// A clip for another body has no scales.
void warnOfScales(const Motion& motion, const Clip& clip, Warnings& warnings) {
  const std::vector<Index> joints = jointsWithScales(motion.skeleton, clip);
  if (joints.empty()) return;
  warnings.add("motion-scales", "scales of joints that the motion changes are left out",
               fmt::format("{}: {}", motion.name, motion.skeleton.joints[joints.front()].name), joints.size());
}

// Null, with a warning, where the character has a skin whose surface cannot be read: it moves all the same.
std::shared_ptr<const BodySkin> bodySkinOf(const Character& character, Warnings& warnings) {
  try {
    return character.skin();
  } catch (const Error& error) {
    warnings.add("no-surface", fmt::format("arms are not kept out of the body: {}", error.what()),
                 character.document().name);
    return nullptr;
  }
}

}  // namespace

bool canMove(const Asset& asset) {
  return hasRig(asset) || isSkeletonAlone(asset);
}

CharacterClips retargetedClips(const Character& character, const Motion& given, const RetargetAssetOptions& options,
                               bool withFeet, Warnings& warnings) {
  const Asset& asset = character.document();
  const RetargetMethod& method = findRetargetMethod(options.method);
  if (!canMove(asset)) throw Error(ErrorCode::kUnsupported, "the model has no rig to move", asset.name);
  if (given.clips.empty()) throw Error(ErrorCode::kUnsupported, "holds no motion", given.name);
  Motion body = bodyOf(given, options);
  const SkeletonReading source =
      options.matches ? options.matches->reading(body.skeleton) : SkeletonReading(body.skeleton);
  const Motion motion = asItRests(std::move(body), source);
  const Skeleton& target = character.skeleton();
  const SkeletonMap map = mapFor(motion, source, character.reading(), options);
  warnOfDoubts(map, motion, target, warnings);
  RetargetOptions retarget = options.retarget;
  retarget.characterOnGround = !isSkeletonAlone(asset);
  if (character.hasRig()) retarget.skin = bodySkinOf(character, warnings);
  if (isSizedByTrunk(motion.skeleton, target, map, retarget.skin.get())) {
    warnings.add("legs-without-length",
                 "legs of one joint each do not tell how long they are: the trunks say how far the character goes",
                 motion.name);
  }
  CharacterClips result;
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    const Clip& clip = motion.clips[c];
    const double rate = options.frameRate.value_or(frameRateOf(motion, c));
    warnOfScales(motion, clip, warnings);
    ClipWithContacts& made = result.clips.emplace_back();
    made.clip = retargetClip(method, motion.skeleton, clip, target, map, retarget, rate);
    made.clip.name = motion.clips.size() == 1 ? motion.name : clip.name;
    if (withFeet) made.feet = plantedFeet(motion.skeleton, clip, target, map, retarget, rate);
    result.reports.push_back({made.clip.name, frameCount(clip, rate), rate, map,
                              doubtfulMatches(map, motion.skeleton, target),
                              skeletonMapToJson(map, motion.skeleton, target)});
  }
  return result;
}

std::vector<RetargetedClip> retargetOnto(Asset& asset, const Character& character, const Motion& motion,
                                         const RetargetAssetOptions& options) {
  CharacterClips made = retargetedClips(character, motion, options, false, asset.warnings);
  std::vector<Clip> clips;
  for (ClipWithContacts& one : made.clips) {
    clips.push_back(turnClip(std::move(one.clip), character.skeleton(), options.turn));
  }
  const std::vector<std::string> written = addClips(asset, character.moving(), clips);
  for (std::size_t c = 0; c < written.size(); ++c) made.reports[c].name = written[c];
  return made.reports;
}

}  // namespace limber
