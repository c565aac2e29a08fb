#include "limber/actions/motion/combine_motions.h"

#include <utility>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/motion/mix/blend_motions.h"
#include "limber/motion/mix/crossfade_motions.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {

namespace {

void checkCount(std::size_t clips, bool blends) {
  if (blends ? clips == 2 : clips >= 2) return;
  throw Error(
      ErrorCode::kBadArgument,
      fmt::format("{} {}", blends ? "a blend takes two clips, not" : "a sequence takes two clips or more, not", clips),
      "", "a file with several clips counts as so many motions: limber convert --clip NAME takes one out of it");
}

std::string namesOfAll(const std::vector<ClipWithContacts>& clips) {
  std::string names;
  for (const ClipWithContacts& clip : clips) names += (names.empty() ? "" : "_") + clip.clip.name;
  return names;
}

std::vector<ClipWithContacts> combined(const Skeleton& skeleton, const std::vector<ClipWithContacts>& clips,
                                       const CombineOptions& options, Warnings& warnings) {
  const std::string names = namesOfAll(clips);
  std::vector<ClipWithContacts> made;
  if (options.blendWeights.empty()) {
    made.push_back(joinMotions(skeleton, clips, {options.crossfadeSeconds, std::nullopt}, &warnings).motion);
    made.back().clip.name = names;
  }
  for (const double weight : options.blendWeights) {
    made.push_back(blendMotions(skeleton, clips[0], clips[1], {weight, std::nullopt}, &warnings));
    made.back().clip.name = fmt::format("{}_{:.2f}", names, weight);
  }
  return made;
}

}  // namespace

std::vector<RetargetedClip> combineOnto(Asset& asset, const Character& character, std::span<const Motion> motions,
                                        const RetargetAssetOptions& options, const CombineOptions& combine) {
  std::vector<ClipWithContacts> clips;
  std::optional<RetargetedClip> first;
  for (const Motion& motion : motions) {
    try {
      CharacterClips onto = retargetedClips(character, motion, options, true, asset.warnings);
      if (!first) first = onto.reports.front();
      for (ClipWithContacts& clip : onto.clips) clips.push_back(std::move(clip));
    } catch (const Error& error) {
      throw error.within(motion.name);
    }
  }
  checkCount(clips.size(), !combine.blendWeights.empty());
  std::vector<Clip> added;
  std::vector<RetargetedClip> reports;
  for (ClipWithContacts& one : combined(character.skeleton(), clips, combine, asset.warnings)) {
    RetargetedClip& report = reports.emplace_back(*first);
    report.framesPerSecond = frameRateOf(one.clip);
    report.frames = frameCount(one.clip, report.framesPerSecond);
    added.push_back(turnClip(std::move(one.clip), character.skeleton(), options.turn));
  }
  const std::vector<std::string> written = addClips(asset, character.moving(), added);
  for (std::size_t c = 0; c < written.size(); ++c) reports[c].name = written[c];
  return reports;
}

}  // namespace limber
