// Changes to the node tree that keep everything that refers to it right.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// A single-precision value as the double that prints shortest: 0.1, not 0.10000000149011612. Throws Error kBadData
// beyond what single precision can hold.
double shortDouble(double value);

// Writes a local transform into a node: translation, rotation, scale, each only where it says something; "matrix" where
// the transform has shear and `mayHaveMatrix` (an animated node may not). What the node's scale mirrored it mirrors
// still, so that the node's animations fit it as they did.
void setNodeTransform(gltf::Node& node, const Affine& local, bool mayHaveMatrix);

// What the target of an animation's channel names, by KHR_animation_pointer too: a node, and what of it
// ("translation").
struct ChannelTarget {
  std::optional<Index> node;
  std::string path;
};
ChannelTarget channelTarget(const gltf::AnimationChannel& channel);

// Takes animation channels out for which `drop` is true, with the samplers that nothing uses then, and animations that
// are left empty. `drop` sees the node, if the channel has one, and the path ("translation", ...).
void removeChannels(Asset& asset, const std::function<bool(Index node, std::string_view path)>& drop);

// The same of one animation, which may be left empty. True if a channel went.
bool removeChannels(gltf::Animation& animation, const std::function<bool(Index node, std::string_view path)>& drop);

// Puts the channels of one animation behind those of another.
void appendChannels(gltf::Animation& to, gltf::Animation& from);

// Moves the document's last animations, as many as there are numbers, into those with these numbers.
void moveLastAnimations(gltf::Document& document, std::span<const Index> into);

// Takes the samplers out that no channel of the animation names, and renumbers the others.
void removeUnusedSamplers(gltf::Animation& animation);

// Lets the animation of morph weights of one node, and the expressions of a VRM, drive another.
void retargetMorphChannels(Asset& asset, Index from, Index to);

// Deletes the nodes for which `keep` is false (#nodes) and renumbers every reference to a node: children, scenes,
// skins, animation channels (KHR_animation_pointer too), MSFT_lod, those of VRM. Channels and springs of deleted
// nodes go. Where other extensions seem to name nodes, a warning "node-references" is added to the asset's.
void deleteNodes(Asset& asset, const std::vector<bool>& keep);

}  // namespace limber
