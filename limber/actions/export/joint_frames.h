// Nodes that get other axes or hang elsewhere while everything looks as it did.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// A node's transform L becomes before * L * turn * scale.
struct FrameChange {
  Affine before = Affine::Identity();  // moves, turns and scales evenly
  Quat turn = Quat::Identity();
  double scale = 1;

  bool isNone() const;
};

// Changes transforms, keys of all animations (tangents of cubic ones too) and the inverse bind matrices of all skins by
// the frames of their nodes; keys are written as floats. A node whose scale is uneven, or becomes so in a clip, may be
// turned by quarters alone: `turn` takes each axis to an axis.
//
// changes  #nodes; what hangs on a changed node has its inverse in `before`
void changeFrames(Asset& asset, std::span<const FrameChange> changes);

// #nodes: is the node's scale uneven or mirrored, at rest or at a key of a clip?
std::vector<bool> unevenlyScaled(const Asset& asset);

}  // namespace limber
