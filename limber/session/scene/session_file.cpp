#include "limber/session/scene/session_file.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "limber/deform/linear_blend.h"
#include "limber/document/gltf/json_access.h"
#include "limber/session/drag/limb_pull.h"

namespace limber {

namespace {

constexpr const char* kKey = "limber_session";
constexpr int kSessionVersion = 1;

template <int N>
Json numbersJson(const double* values) {
  Json json = Json::array();
  for (int i = 0; i < N; ++i) json.push_back(values[i]);
  return json;
}

template <int N>
void readNumbers(const JsonView& object, std::string_view key, double* values) {
  const JsonView array = object.array(key);
  if (array.size() != N) array.fail("holds another number of numbers than it should");
  for (int i = 0; i < N; ++i) values[i] = array[static_cast<std::size_t>(i)].asNumber();
}

std::string requireText(const JsonView& object, std::string_view key) {
  const std::string text(object.text(key));
  if (text.empty()) object.member(key).fail("is missing");
  return text;
}

Quat readRotation(const JsonView& entry) {
  Quat rotation;
  readNumbers<4>(entry, "rotation", rotation.coeffs().data());
  if (!(std::abs(rotation.norm() - 1) < 1e-3)) entry.member("rotation").fail("is not of unit length");
  return rotation;
}

SavedJoint readJoint(const JsonView& entry) {
  SavedJoint joint{requireText(entry, "joint"), {}};
  readNumbers<3>(entry, "translation", joint.local.translation.data());
  joint.local.rotation = readRotation(entry);
  readNumbers<3>(entry, "scale", joint.local.scale.data());
  return joint;
}

std::vector<SavedTarget> readTargets(const JsonView& list) {
  std::vector<SavedTarget> targets;
  for (std::size_t i = 0; i < list.size(); ++i) {
    SavedTarget target{requireText(list[i], "joint"), {}};
    readNumbers<3>(list[i], "position", target.position.data());
    if (list[i].member("rotation").exists()) target.rotation = readRotation(list[i]);
    targets.push_back(std::move(target));
  }
  return targets;
}

Json targetsJson(const std::vector<SavedTarget>& targets) {
  Json list = Json::array();
  for (const SavedTarget& target : targets) {
    list.push_back({{"joint", target.joint}, {"position", numbersJson<3>(target.position.data())}});
    if (target.rotation) list.back()["rotation"] = numbersJson<4>(target.rotation->coeffs().data());
  }
  return list;
}

LayerKey readLayerKey(const JsonView& entry) {
  LayerKey key;
  key.seconds = entry.number("seconds", 0);
  key.span = entry.number("span", 0);
  if (!(key.seconds >= 0) || !(key.span >= 0)) entry.fail("lies before the clip begins");
  readNumbers<3>(entry, "translation", key.translation.data());
  readNumbers<4>(entry, "rotation", key.rotation.coeffs().data());
  if (!(std::abs(key.rotation.norm() - 1) < 1e-3)) entry.member("rotation").fail("is not of unit length");
  return key;
}

SavedLayerTrack readLayerTrack(const JsonView& entry) {
  SavedLayerTrack track{requireText(entry, "joint"), {}};
  const JsonView keys = entry.array("keys");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    track.keys.push_back(readLayerKey(keys[i]));
    if (i > 0 && !(track.keys[i].seconds > track.keys[i - 1].seconds)) keys[i].fail("does not come after the last");
  }
  if (track.keys.empty()) entry.fail("has no keys");
  return track;
}

std::vector<SavedLayer> readLayers(const JsonView& list) {
  std::vector<SavedLayer> layers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    SavedLayer layer{requireText(list[i], "clip"), {}};
    const JsonView tracks = list[i].array("tracks");
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      layer.tracks.push_back(readLayerTrack(tracks[t]));
      for (std::size_t other = 0; other < t; ++other) {
        if (layer.tracks[other].joint == layer.tracks[t].joint) tracks[t].fail("is of the same joint as another");
      }
    }
    layers.push_back(std::move(layer));
  }
  return layers;
}

Json layersJson(const std::vector<SavedLayer>& layers) {
  Json list = Json::array();
  for (const SavedLayer& layer : layers) {
    Json tracks = Json::array();
    for (const SavedLayerTrack& track : layer.tracks) {
      Json keys = Json::array();
      for (const LayerKey& key : track.keys) {
        keys.push_back({{"seconds", key.seconds},
                        {"span", key.span},
                        {"translation", numbersJson<3>(key.translation.data())},
                        {"rotation", numbersJson<4>(key.rotation.coeffs().data())}});
      }
      tracks.push_back({{"joint", track.joint}, {"keys", std::move(keys)}});
    }
    list.push_back({{"clip", layer.clip}, {"tracks", std::move(tracks)}});
  }
  return list;
}

SavedSession readSession(const JsonView& json) {
  if (json.number("version", 0) != kSessionVersion) json.fail("was written by another version of limber");
  SavedSession session;
  session.ownRig = json.flag("own_rig", false);
  if (!session.ownRig) {
    session.rigger = requireText(json, "rigger");
    session.skinning = requireText(json, "skinning");
    session.handles = json.requireIndex("handles", kNoIndex);
    session.pins = readTargets(json.array("pins"));
    if (!session.pins.empty()) session.templateName = requireText(json, "template");
  }
  session.ik = json.flag("ik", false);
  session.limbsFollow = json.flag("limbs_follow", false);
  session.solver = json.member("solver").exists() ? requireText(json, "solver") : std::string(kLimbSolver);
  session.deformer =
      json.member("deformer").exists() ? requireText(json, "deformer") : std::string(kLinearBlendDeformer.name);
  session.limits = json.text("limits");
  const JsonView locked = json.array("locked");
  for (std::size_t i = 0; i < locked.size(); ++i) {
    if (!locked[i].json().is_string()) locked[i].fail("is not a joint's name");
    session.locked.push_back(locked[i].json().get<std::string>());
  }
  session.clip = json.text("clip");
  session.seconds = json.number("seconds", 0);
  session.layers = readLayers(json.array("layers"));
  session.targets = readTargets(json.array("targets"));
  const JsonView pose = json.array("pose");
  for (std::size_t i = 0; i < pose.size(); ++i) session.pose.push_back(readJoint(pose[i]));
  return session;
}

}  // namespace

void putSession(Asset& asset, const SavedSession& session) {
  Json json = {
      {"version", kSessionVersion}, {"own_rig", session.ownRig}, {"ik", session.ik}, {"solver", session.solver}};
  if (!session.ownRig) {
    json["rigger"] = session.rigger;
    json["skinning"] = session.skinning;
    json["handles"] = session.handles;
    if (!session.pins.empty()) {
      json["template"] = session.templateName;
      json["pins"] = targetsJson(session.pins);
    }
  }
  if (session.limbsFollow) json["limbs_follow"] = true;
  if (session.deformer != kLinearBlendDeformer.name) json["deformer"] = session.deformer;
  if (!session.limits.empty()) json["limits"] = session.limits;
  if (!session.locked.empty()) json["locked"] = session.locked;
  if (!session.clip.empty()) {
    json["clip"] = session.clip;
    json["seconds"] = session.seconds;
  }
  if (!session.layers.empty()) json["layers"] = layersJson(session.layers);
  json["targets"] = targetsJson(session.targets);
  json["pose"] = Json::array();
  for (const SavedJoint& joint : session.pose) {
    json["pose"].push_back({{"joint", joint.joint},
                            {"translation", numbersJson<3>(joint.local.translation.data())},
                            {"rotation", numbersJson<4>(joint.local.rotation.coeffs().data())},
                            {"scale", numbersJson<3>(joint.local.scale.data())}});
  }
  gltf::KeptJson& extras = asset.document.extras;
  if (extras.exists() && !extras->is_null() && !extras->is_object()) {
    throw Error(ErrorCode::kUnsupported, "the document's extras are no object, so a session has no place there",
                asset.name);
  }
  extras.change()[kKey] = std::move(json);
}

std::optional<SavedSession> takeSession(Asset& asset) {
  gltf::KeptJson& extras = asset.document.extras;
  if (!extras.exists() || !extras->contains(kKey)) return std::nullopt;
  SavedSession session = readSession(JsonView(&*extras, "extras").object(kKey));
  extras.change().erase(kKey);
  if (extras->empty()) extras.reset();
  return session;
}

}  // namespace limber
