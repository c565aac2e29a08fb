#include "vrma_files.h"

#include <algorithm>

#include <fmt/format.h>

#include "command.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/counted.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/vrm/hang_bones.h"
#include "limber/document/vrm/vrm_bones.h"
#include "limber/document/write.h"

namespace limber::cli {

namespace {

std::vector<ExpressionTrack> expressionsOf(const VrmaSource& source, const Clip& clip, Warnings& warnings) {
  if (!source.model) return {};
  const Asset& model = source.model->document();
  const std::vector<gltf::Animation>& animations = model.document.animations;
  const auto found = std::find_if(animations.begin(), animations.end(),
                                  [&](const gltf::Animation& animation) { return animation.name == clip.name; });
  if (found == animations.end()) return {};
  std::vector<ExpressionTrack> tracks = expressionTracks(model, static_cast<Index>(found - animations.begin()));
  if (!source.isEdited) return tracks;
  warnings.add("vrma-expressions", "expressions are left out of clips that are cut, mirrored or sampled anew", {},
               tracks.size());
  return {};
}

// What a file for VRMs says, over one skeleton.
struct VrmaMotion {
  Skeleton skeleton;
  std::vector<Clip> clips;
  std::vector<HumanoidJoint> bones;
  TPose rest;
};

VrmaMotion motionAlone(const Motion& motion, Warnings& warnings) {
  VrmaMotion read{motion.skeleton, motion.clips, vrmBones(skeletonWithForm(motion), motion.name, warnings), {}};
  read.rest = vrmRestPose(motion, read.bones);
  return read;
}

// As the model would move as a VRM: bones that hang elsewhere hang where VRM wants them.
VrmaMotion motionOfModel(const Character& model, const std::vector<Clip>& clips, Warnings& warnings) {
  Asset asset = model.document().clone();
  AssetSkeleton rig = model.moving();
  VrmaMotion read{{}, {}, vrmBones(asset, rig, warnings), {}};
  asset.document.animations.clear();
  addClips(asset, rig, clips);
  if (hasRig(asset)) rig = hangBones(asset, rig, read.bones);
  read.rest = vrmRestPose(asset, rig, read.bones);
  read.skeleton = rig.skeleton;
  Warnings reported;  // with the motion
  read.clips = readClips(asset, rig, reported);
  return read;
}

}  // namespace

void writeVrmaFiles(const VrmaSource& source, const std::vector<std::filesystem::path>& paths, bool quiet,
                    const Account& account) {
  const Motion& motion = *source.motion;
  if (paths.empty()) throw Error(ErrorCode::kBadArgument, "there is no clip to write", motion.name);
  Warnings warnings;
  const VrmaMotion read =
      source.model ? motionOfModel(*source.model, motion.clips, warnings) : motionAlone(motion, warnings);
  std::vector<Bytes> files;
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    const std::vector<ExpressionTrack> expressions = expressionsOf(source, motion.clips[c], warnings);
    const Asset made = vrmAnimation(read.skeleton, read.clips[c], read.rest, read.bones, expressions);
    warnings.append(made.warnings);
    files.push_back(writeGlb(made));
  }
  std::vector<OutputFile> outputs;
  for (std::size_t c = 0; c < files.size(); ++c) outputs.push_back({paths[c], files[c]});
  writeFiles(outputs);
  for (const std::filesystem::path& path : paths) account.line(fmt::format("written: {}", path.string()));
  printWarnings(warnings, quiet);
}

}  // namespace limber::cli
