#include "limber/session/scene/session_io.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/usd/usd_write.h"
#include "limber/document/write.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/limits/limits_json.h"

namespace limber {

namespace {

// Methods would make the rig again, but not what was done to it since.
bool keepsRig(const SessionState& state) {
  return !state.rig->report || state.rig->renamed || state.rig->edited || !state.movement.clips.empty();
}

SavedLayer savedLayer(const SessionClip& clip, const Skeleton& skeleton) {
  SavedLayer saved{clip.clip->name, {}};
  for (const LayerTrack& track : clip.layer.tracks) {
    saved.tracks.push_back({skeleton.joints[track.joint].name, track.keys});
  }
  return saved;
}

SavedSession savedOf(const SessionState& state) {
  const Skeleton& skeleton = state.rig->skeleton();
  SavedSession saved;
  saved.ownRig = keepsRig(state);
  saved.rigger = state.rigger;
  saved.skinning = state.skinning;
  saved.handles = skeleton.jointCount();
  if (!state.pins.empty()) saved.templateName = state.templateName;
  for (const JointPin& pin : state.pins) saved.pins.push_back({pin.joint, pin.position});
  saved.ik = state.ik;
  saved.limbsFollow = state.limbsFollow;
  saved.solver = state.solver;
  saved.deformer = state.deformer;
  saved.limits = state.limitsText;
  saved.locked.assign(state.locked.begin(), state.locked.end());
  for (const PinnedTarget& target : state.targets) {
    saved.targets.push_back({skeleton.joints[target.joint].name, target.position, target.rotation});
  }
  if (const Clip* clip = state.movement.clip()) {
    saved.clip = clip->name;
    saved.seconds = state.movement.seconds;
  }
  for (const SessionClip& clip : state.movement.clips) {
    if (!clip.layer.empty()) saved.layers.push_back(savedLayer(clip, skeleton));
  }
  // Where it will stand when it is opened without this.
  const Pose home = saved.ownRig ? restPose(skeleton) : state.rig->home;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (sameTransform(state.pose.locals[j], home.locals[j])) continue;
    saved.pose.push_back({skeleton.joints[j].name, state.pose.locals[j]});
  }
  return saved;
}

// Runs `work`; its errors are said of that entry of the document.
template <typename Work>
auto saidOf(const std::string& entry, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throwWithin(error, entry);
  }
}

void restore(SessionState& state, const SavedSession& saved) {
  const auto jointOf = [&](const std::string& name, const char* list, std::size_t entry) {
    return saidOf(fmt::format("extras.limber_session.{}[{}]", list, entry), [&] { return requireJoint(state, name); });
  };
  for (std::size_t i = 0; i < saved.pose.size(); ++i) {
    state.pose.locals[jointOf(saved.pose[i].joint, "pose", i)] = saved.pose[i].local;
  }
  for (std::size_t i = 0; i < saved.targets.size(); ++i) {
    state.targets.push_back(
        {jointOf(saved.targets[i].joint, "targets", i), saved.targets[i].position, saved.targets[i].rotation});
  }
  saidOf("extras.limber_session.limits", [&] { setLimits(state, saved.limits); });
  for (std::size_t i = 0; i < saved.locked.size(); ++i) {
    jointOf(saved.locked[i], "locked", i);
    state.locked.insert(saved.locked[i]);
  }
  state.ik = saved.ik;
  state.limbsFollow = saved.limbsFollow;
  state.solver = findIkMethod(saved.solver).name;
  state.deformer = findDeformer(saved.deformer).name;
  for (std::size_t i = 0; i < saved.layers.size(); ++i) {
    ClipLayer layer;
    for (const SavedLayerTrack& track : saved.layers[i].tracks) {
      layer.tracks.push_back({jointOf(track.joint, "layers", i), track.keys});
    }
    std::sort(layer.tracks.begin(), layer.tracks.end(),
              [](const LayerTrack& a, const LayerTrack& b) { return a.joint < b.joint; });
    saidOf(fmt::format("extras.limber_session.layers[{}]", i),
           [&] { putLayer(state.movement, state.rig->skeleton(), saved.layers[i].clip, std::move(layer)); });
  }
  if (!saved.clip.empty()) {
    chooseClip(state.movement, saved.clip);
    setTime(state.movement, saved.seconds);
  }
}

}  // namespace

Index requireJoint(const SessionState& state, const std::string& name) {
  const std::optional<Index> joint = state.rig->skeleton().find(name);
  if (!joint) throw Error(ErrorCode::kBadArgument, fmt::format("no joint is called '{}'", name));
  return *joint;
}

void setLimits(SessionState& state, const std::string& text) {
  state.limits =
      text.empty() ? nullptr : std::make_shared<const JointLimits>(limitsFromJson(text, state.rig->skeleton()));
  state.limitsText = text;
}

void authored(SessionState& state) {
  state.tasks.clear();
  state.authoredRig = state.rig;
  state.authoredPose = state.pose;
}

SessionState startState(std::shared_ptr<const Asset> asset, const std::optional<SavedSession>& saved, bool asProp,
                        Progress& progress) {
  const Asset& source = *asset;
  AutoRigOptions options;
  options.rig.mayAbstain = false;  // as Session has it
  if (asProp) options.rigger = kPropRigger;
  const bool own = saved ? saved->ownRig : hasRig(source);
  if (saved && !own) {
    options.rigger = saved->rigger;
    options.skinning = saved->skinning;
    options.rig.handles = saved->handles;
    if (!saved->pins.empty()) options.rig.templateName = saved->templateName;
    for (const SavedTarget& pin : saved->pins) options.rig.pins.push_back({pin.joint, pin.position});
    options.existingRig = hasRig(source) ? ExistingRig::kReplace : ExistingRig::kRefuse;
  }
  SessionState state;
  state.base = asset;
  state.memory = std::make_shared<RigMemory>();
  options.rig.memory = state.memory;
  state.rig = own ? openRiggedModel(source) : makeRiggedModel(source, options, progress);
  state.rigger = options.rigger;
  state.skinning = options.skinning;
  state.pins = options.rig.pins;
  state.templateName = options.rig.templateName;
  state.pose = saved || !own ? state.rig->home : readNodePose(state.rig->asset(), state.rig->binding());
  state.movement = movementOf(state.rig->clips);
  if (saved) restore(state, *saved);
  authored(state);
  return state;
}

Asset posedDocument(const SessionState& state) {
  return assetWithClips(*state.rig, state.pose, clipsOf(state.movement));
}

ExportMesh posedMesh(const SessionState& state) {
  Geometry geometry = state.rig->geometry();
  geometry.positions = posedPositions(*state.rig, state.pose, findDeformer(state.deformer));
  return exportMesh(state.rig->asset(), geometry);
}

Bytes encodeMesh(const ExportMesh& mesh, const Asset& asset, ExportFormat format) {
  if (format == ExportFormat::kObj) return encodeObj(mesh, {});
  if (format == ExportFormat::kUsdz) return encodeUsdz(stillUsdFiles(asset, {mesh.positions, mesh.normals}));
  return format == ExportFormat::kStl ? encodeStl(mesh) : encodePly(mesh);
}

Bytes exportState(const SessionState& state, ExportFormat format) {
  if (format == ExportFormat::kGlb) return writeGlb(posedDocument(state));
  return encodeMesh(posedMesh(state), state.rig->asset(), format);
}

Bytes savedState(const SessionState& state) {
  const RiggedModel& rig = *state.rig;
  Asset asset = keepsRig(state) ? assetWithClips(rig, readNodePose(rig.asset(), rig.binding()), basesOf(state.movement))
                                : state.base->clone();
  putSession(asset, savedOf(state));
  return writeGlb(asset);
}

}  // namespace limber
