#include "limber/session/session_state.h"

#include <algorithm>

#include "limber/actions/transfer/transfer_asset.h"
#include "limber/character/anatomy/body_part.h"
#include "limber/character/anatomy/part_color.h"
#include "limber/document/gltf/json_text.h"
#include "limber/session/scene/state_json.h"
#include "limber/skeleton/clip/keys/keyframes.h"
#include "limber/skeleton/ik/limits/limit_outline.h"
#include "limber/skeleton/ik/limits/limits_json.h"

namespace limber {

namespace {

constexpr Index kRimSteps = 32;

// What a joint is of the body, where that is sure enough to be said.
const Part* surePart(const Anatomy& anatomy, Index joint) {
  const std::optional<std::size_t> part = anatomy.partOf[joint];
  return part && anatomy.parts[*part].confidence >= kDoubtful ? &anatomy.parts[*part] : nullptr;
}

Json colorJson(const Part* part) {
  const Hsv color = part ? partColor(part->kind, part->side) : partColor(PartKind::kOther, Side::kCenter);
  return Json::array({color.hue, color.saturation, color.value});
}

Json jointsJson(const RiggedModel& rig) {
  const std::vector<Affine> rest = restGlobals(rig.skeleton());
  Json joints = Json::array();
  for (Index j = 0; j < rest.size(); ++j) {
    const Joint& joint = rig.skeleton().joints[j];
    const Part* part = surePart(rig.anatomy(), j);
    joints.push_back({{"name", joint.name},
                      {"parent", joint.parent ? static_cast<int>(*joint.parent) : -1},
                      {"part", textOrNull(sureLabel(rig, j))},
                      {"color", colorJson(part)},
                      {"radius", rig.radii[j]},
                      {"rest", vectorJson(rest[j].translation())}});
  }
  return joints;
}

Json motionsJson(const Movement& movement) {
  Json motions = Json::array();
  for (const std::shared_ptr<const Motion>& motion : movement.motions) {
    Json joints = Json::array(), clips = Json::array();
    for (const Joint& joint : motion->skeleton.joints) {
      joints.push_back({{"name", joint.name}, {"parent", joint.parent ? static_cast<int>(*joint.parent) : -1}});
    }
    for (const Clip& clip : motion->clips) clips.push_back({{"name", clip.name}, {"duration", clip.duration()}});
    motions.push_back({{"name", motion->name}, {"joints", std::move(joints)}, {"clips", std::move(clips)}});
  }
  return motions;
}

const char* interpolationName(Interpolation interpolation) {
  if (interpolation == Interpolation::kCubic) return "cubic";
  return interpolation == Interpolation::kStep ? "step" : "linear";
}

Json jointKeysJson(const ClipContent& clip) {
  Json list = Json::array();
  for (const JointKeyTimes& of : editableKeys(clip)) list.push_back({{"joint", of.joint}, {"seconds", of.seconds}});
  return list;
}

// What the foot is in the model's map, where that names it.
std::string partOfFoot(const ClipSource& source, const FootSpans& feet) {
  for (const JointMatch& match : source.map.matches) {
    if (std::count(match.source.begin(), match.source.end(), feet.foot) > 0) return nameOf(match.part);
  }
  return {};
}

Json feetJson(const ClipSource& source) {
  Json list = Json::array();
  for (const FootSpans& feet : source.feet) {
    const std::string& name = source.motion->skeleton.joints[feet.foot].name;
    Json planted = Json::array();
    for (const TimeSpan& span : feet.planted) planted.push_back({span.from, span.to});
    const bool edited = std::any_of(source.contactEdits.begin(), source.contactEdits.end(),
                                    [&](const ContactEdit& edit) { return edit.foot == name; });
    list.push_back({{"foot", name},
                    {"part", textOrNull(partOfFoot(source, feet))},
                    {"planted", std::move(planted)},
                    {"edited", edited}});
  }
  return list;
}

Json sequenceJson(const std::optional<ClipSequence>& sequence) {
  if (!sequence) return nullptr;
  Json clips = Json::array();
  for (std::size_t i = 0; i < sequence->clips.size(); ++i) {
    clips.push_back({{"clip", sequence->clips[i]}, {"from", sequence->spans[i].from}, {"to", sequence->spans[i].to}});
  }
  return {{"seconds", sequence->seconds}, {"clips", std::move(clips)}};
}

Json clipsJson(const Movement& movement) {
  Json clips = Json::array();
  for (const SessionClip& entry : movement.clips) {
    const Clip& clip = *entry.clip;
    Json source = nullptr;
    if (entry.source) {
      const RetargetMotion& made = entry.source->command;
      source = {{"motion", entry.source->motion->name},
                {"clip", entry.source->motion->clips[entry.source->clip].name},
                {"method", made.method},
                {"reach", made.reach},
                {"contacts", made.contacts}};
    }
    clips.push_back({{"name", clip.name},
                     {"duration", clip.duration()},
                     {"recorded", entry.base != nullptr},
                     {"keys", entry.base ? keyTimes(entry.layer) : keyTimes(clip)},
                     {"joint_keys", jointKeysJson(entry)},
                     {"interpolation", interpolationName(interpolationOf(clip))},
                     {"source", std::move(source)},
                     {"sequence", sequenceJson(entry.sequence)},
                     {"feet", entry.source ? feetJson(*entry.source) : Json::array()}});
  }
  return clips;
}

// Where a joint's bone lies in the world: towards the middle of what hangs on it; a leaf goes on as its parent's does.
Vec3 boneOf(const Skeleton& skeleton, const std::vector<Affine>& rest, Index joint) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent != joint) continue;
    sum += rest[j].translation();
    ++count;
  }
  if (count > 0) return sum / count - rest[joint].translation();
  const std::optional<Index> parent = skeleton.joints[joint].parent;
  return parent ? Vec3(rest[joint].translation() - rest[*parent].translation()) : Vec3(Vec3::UnitY());
}

Json limitOutlinesJson(const SessionState& state) {
  Json outlines = Json::array();
  if (!state.limits) return outlines;
  const Skeleton& skeleton = state.rig->skeleton();
  const std::vector<Affine> rest = restGlobals(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Vec3 bone = boneOf(skeleton, rest, j);
    if (!(bone.norm() > 0)) continue;
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const Quat above = parent ? decompose(rest[*parent]).rotation : Quat::Identity();
    const Vec3 own = decompose(rest[j]).rotation.conjugate() * bone;
    const LimitOutline outline = limitOutline(state.limits->joints[j], own, kRimSteps);
    if (outline.rim.empty()) continue;
    Json rim = Json::array();
    for (const Vec3& direction : outline.rim) rim.push_back(vectorJson(above * direction));
    outlines.push_back({{"joint", j}, {"length", bone.norm()}, {"closed", outline.closed}, {"rim", std::move(rim)}});
  }
  return outlines;
}

// Of the chosen clip.
Json matchJson(const SessionState& state) {
  if (!state.movement.chosen || !state.movement.clips[*state.movement.chosen].source) return Json::array();
  const ClipSource& source = *state.movement.clips[*state.movement.chosen].source;
  return Json::parse(skeletonMapToJson(source.map, source.motion->skeleton, state.rig->skeleton()))["matches"];
}

// The same for all joints.
Json snapJson(const RiggedModel& rig) {
  const DragSnap snap = snapOf(rig, 0);
  return {{"degrees", snap.degrees}, {"step", snap.step}};
}

}  // namespace

std::string sureLabel(const RiggedModel& rig, Index joint) {
  return surePart(rig.anatomy(), joint) ? std::string(labelOf(rig.anatomy(), joint)) : std::string();
}

Json sessionState(const Session& session) {
  const SessionState& state = session.state();
  const RiggedModel& rig = *state.rig;
  Box box;
  for (const Vec3f& position : rig.geometry().positions) box.add(position.cast<double>());
  Warnings warnings = rig.report ? rig.report->warnings : rig.asset().warnings;
  warnings.append(state.movement.warnings);
  Json json = {
      {"name", session.source().name},
      {"vertices", rig.geometry().positions.size()},
      {"triangles", rig.geometry().triangles.size()},
      {"box", {{"min", vectorJson(box.min)}, {"max", vectorJson(box.max)}}},
      {"own_rig", !rig.report},
      {"rigger", state.rigger},
      {"skinning", state.skinning},
      {"most_handles", rig.report ? rig.report->weldedVertices : static_cast<Index>(rig.geometry().positions.size())},
      {"suggestions", Json::array()},
      {"joints", jointsJson(rig)},
      {"ik", state.ik},
      {"solver", state.solver},
      {"deformer", state.deformer},
      {"limited", state.limits != nullptr},
      {"limits", state.limits ? Json::parse(limitsToJson(*state.limits, rig.skeleton()))["joints"] : Json::object()},
      {"limit_outlines", limitOutlinesJson(state)},
      {"motions", motionsJson(state.movement)},
      {"clips", clipsJson(state.movement)},
      {"clip", state.movement.chosen ? Json(*state.movement.chosen) : Json(nullptr)},
      {"seconds", state.movement.seconds},
      {"snap", snapJson(rig)},
      {"match", matchJson(state)},
      {"targets", Json::array()},
      {"tasks", Json::array()},
      {"pins", Json::array()},
      {"doubts", Json::array()},
      {"locked", Json::array()},
      {"edited_rig", rig.edited},
      {"gaps", rig.transfer ? toJson(rig.transfer->gaps) : Json(nullptr)},
      {"animated", !state.base->document.animations.empty()},
      {"dragged", nullptr},
      {"posed", !samePose(state.pose, rig.home)},
      {"undo", textOrNull(session.undoName())},
      {"redo", textOrNull(session.redoName())},
      {"warnings", toJson(warnings)}};
  if (rig.report) {
    for (const HandleSuggestion& suggestion : rig.report->suggestions)
      json["suggestions"].push_back(suggestion.handles);
  }
  for (const PinnedTarget& target : state.targets) {
    json["targets"].push_back({{"joint", target.joint}, {"position", vectorJson(target.position)}});
  }
  for (const TaskOutcome& task : state.tasks) {
    json["tasks"].push_back({{"task", task.task}, {"outcome", task.outcome}, {"met", task.met}});
  }
  for (const JointPin& pin : state.pins) {
    json["pins"].push_back({{"joint", pin.joint}, {"position", vectorJson(pin.position)}});
  }
  if (rig.report && !rig.edited) {
    for (const std::string& doubt : rig.report->doubts) {
      if (const std::optional<Index> joint = rig.skeleton().find(doubt)) json["doubts"].push_back(*joint);
    }
  }
  for (Index j = 0; j < rig.skeleton().jointCount(); ++j) {
    if (state.locked.count(rig.skeleton().joints[j].name) > 0) json["locked"].push_back(j);
  }
  if (const std::optional<Index> joint = session.draggedJoint()) json["dragged"] = *joint;
  return json;
}

}  // namespace limber
