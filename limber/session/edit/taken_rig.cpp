#include "limber/session/edit/taken_rig.h"

#include <algorithm>
#include <utility>

#include "limber/actions/rig/rig_from_animation.h"
#include "limber/actions/transfer/transfer_asset.h"
#include "limber/core/text/names.h"
#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_body.h"

namespace limber {

namespace {

Asset bodyIn(ByteSpan bytes, const std::string& file, const Resolver& files) {
  if (lowerExtension(file) == ".npz") return smplBody(readSmplArrays(bytes, file), file);
  return readAsset(bytes, file, files);
}

// Whether somebody saw to it that the joints are where the limbs are.
bool isTrusted(const SessionState& state) {
  return !state.rig->report || state.rig->edited || !state.pins.empty();
}

}  // namespace

std::shared_ptr<const RiggedModel> rigOfOther(const SessionState& state, ByteSpan bytes, const std::string& file,
                                              const Resolver& files, Progress& progress) {
  progress.stage("read");
  const Asset source = bodyIn(bytes, file, files);
  Asset target = isTrusted(state) ? documentOf(*state.rig) : state.base->clone();
  TransferReport report = transferOnto(source, target, {}, progress);
  target.warnings.append(source.warnings);
  std::shared_ptr<RiggedModel> model = readRiggedModel(std::move(target));
  model->transfer = std::make_shared<const TransferReport>(std::move(report));
  return model;
}

std::shared_ptr<const RiggedModel> rigOfAnimation(const Asset& base, const RigFromAnimation& command,
                                                  Progress& progress) {
  progress.stage("read");
  Asset asset = base.clone();
  VertexAnimation animation = readVertexAnimation(asset, {}, progress);
  DecompositionOptions options;
  if (command.bones > 0) options.bones = command.bones;
  rigFromAnimation(asset, std::move(animation), options, progress);
  return openRiggedModel(asset);
}

void takeOwnClips(Movement& movement, const RiggedModel& rig) {
  for (SessionClip& own : movementOf(rig.clips).clips) {
    const auto same = std::find_if(movement.clips.begin(), movement.clips.end(),
                                   [&](const SessionClip& clip) { return clip.clip->name == own.clip->name; });
    if (same != movement.clips.end()) {
      *same = std::move(own);
    } else {
      movement.clips.push_back(std::move(own));
    }
  }
  if (!movement.chosen && !rig.clips.empty()) chooseClip(movement, rig.clips.front()->name);
}

}  // namespace limber
