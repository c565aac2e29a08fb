// Animations of a file brought to what the rest of limber reads: channels of nodes, and times from 0 on.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Channels whose KHR_animation_pointer names a node's translation, rotation, scale or weights become channels of that
// node, which say the same, unless the animation has such a channel already. Pointers at anything else stay. The
// extension is undeclared where no channel uses it any more. Channels whose pointer names a node that is not there are
// left out (warning "missing-targets"), and animations that are empty then. The document need not have passed
// checkAsset.
void resolveNodePointers(gltf::Document& document, Warnings& warnings);

// Animations with keys before 0, which glTF does not allow, begin at 0 afterwards: all that they move is as much later
// (warning "negative-times"). The asset has passed checkAsset.
void startAtZero(Asset& asset);

}  // namespace limber
