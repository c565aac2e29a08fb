// A session kept in its model: the file is an ordinary GLB of the model as it was opened, and its extras have the
// commands performed on it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/core/transform.h"
#include "limber/document/asset.h"
#include "limber/skeleton/clip/clip_layer.h"

namespace limber {

struct SavedJoint {
  std::string joint;
  Transform local;
};
struct SavedTarget {
  std::string joint;
  Vec3 position = Vec3::Zero();
  std::optional<Quat> rotation = std::nullopt;
};

struct SavedLayerTrack {
  std::string joint;
  std::vector<LayerKey> keys;  // in time
};
struct SavedLayer {
  std::string clip;                     // which the document has without it
  std::vector<SavedLayerTrack> tracks;  // each of another joint
};

struct SavedSession {
  bool ownRig = false;  // the model's own; else made by these methods
  std::string rigger, skinning;
  Index handles = 0;
  std::string templateName;       // whose joints are pinned; empty: none are
  std::vector<SavedTarget> pins;  // where these joints have to be
  bool ik = false, limbsFollow = false;
  std::string solver;    // of ikMethods()
  std::string deformer;  // of deformers()
  std::vector<SavedTarget> targets;
  std::string limits;               // text of a limits file; empty: none
  std::vector<std::string> locked;  // joints whose weights are
  std::string clip;                 // the chosen one; empty: none
  double seconds = 0;               // the moment of it
  std::vector<SavedLayer> layers;
  std::vector<SavedJoint> pose;  // joints that do not stand as in RiggedModel::home
};

// Puts it into the document's extras. Throws Error kUnsupported where those are no object.
void putSession(Asset& asset, const SavedSession& session);
// Takes it out again. Throws Error kBadData naming the entry where it breaks the format; names of joints and methods
// are not checked.
std::optional<SavedSession> takeSession(Asset& asset);

}  // namespace limber
