#include "limber/session/scene/scene_state.h"

#include <algorithm>

#include "limber/session/scene/scene_layout.h"
#include "limber/session/scene/state_json.h"
#include "limber/session/session_state.h"

namespace limber {

namespace {

Json attachmentJson(const SessionScene& scene, const SceneMember& member) {
  if (!member.attachment) return nullptr;
  const std::span<const SceneMember> members = scene.members();
  const auto to = std::find_if(members.begin(), members.end(),
                               [&](const SceneMember& other) { return other.session == member.attachment->to; });
  return {{"to", to - members.begin()}, {"joint", member.attachment->joint}};
}

Json jointsOfMember(const RiggedModel& rig) {
  Json joints = Json::array();
  for (Index j = 0; j < rig.skeleton().jointCount(); ++j) {
    joints.push_back({{"name", rig.skeleton().joints[j].name}, {"part", textOrNull(sureLabel(rig, j))}});
  }
  return joints;
}

Json memberJson(const SessionScene& scene, std::size_t m) {
  const SceneMember& member = scene.members()[m];
  const SessionState& state = member.session->state();
  const Placement placement = placementOf(scene.toScene(m));
  const Clip* clip = state.movement.clip();
  const Box box = boxOf(*member.session, Affine::Identity());
  return {{"name", member.name},
          {"source", member.session->source().name},
          {"joints", jointsOfMember(*state.rig)},
          {"placement",
           {{"position", vectorJson(placement.position)},
            {"turn", vectorJson(placement.turn)},
            {"scale", placement.scale}}},
          {"attached", attachmentJson(scene, member)},
          {"clip", clip ? Json(clip->name) : Json(nullptr)},
          {"duration", clip ? clip->duration() : 0.0},
          {"box", {{"min", vectorJson(box.min)}, {"max", vectorJson(box.max)}}}};
}

}  // namespace

Json sceneState(const SessionScene& scene) {
  Json json = sessionState(scene.session());
  json["undo"] = textOrNull(scene.undoName());
  json["redo"] = textOrNull(scene.redoName());
  json["member"] = scene.chosen();
  json["members"] = Json::array();
  for (std::size_t m = 0; m < scene.members().size(); ++m) json["members"].push_back(memberJson(scene, m));
  return json;
}

}  // namespace limber
