// The clips in an Asset: its animations as values over time of its joints, and back.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// One clip for each animation of the document (in order, with its name, possibly empty and not unique), over the rest
// pose of `skeleton`, in the world of the default scene. Each has passed checkClip.
//
// A joint without a channel has the transform of its node: where that is not its rest pose, the clip has a track of one
// key. Movement of nodes above a root joint is part of that joint's tracks; it is then sampled at all keys and 60 times
// a second between, with the warning "moving-parents" unless their channels repeat their own transforms. Keys that are
// not finite or not later than the one before, and rotations of length 0, are left out (warning "invalid-keys"). Morph
// weights and movement of other nodes are not part of a clip. Where a node's scale mirrors, tracks have rotations and
// scales as decompose() finds them, which the rest pose has, too.
//
// Throws Error kLimit, which names the animation, where joints below moving nodes would have more than 2 million
// samples together or these take more than 2^26 transforms of the nodes above; and, before anything is read, where
// channels that share keys would have more than 4 million numbers and more than 16 times what the document's buffers
// hold.
std::vector<Clip> readClips(const Asset& asset, const AssetSkeleton& skeleton, Warnings& warnings);

// The same of the animations with these numbers alone, in their order.
std::vector<Clip> readClips(const Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations,
                            Warnings& warnings);

// Does the channel say nothing but what its node's own transform does, as exporters write that key every node? False of
// what is no transform.
bool repeatsItsNode(const Asset& asset, const gltf::Animation& animation, const gltf::AnimationChannel& channel);

// Channels may share a sampler, and a reader then has its keys once for each: throws the second kLimit error of
// readClips, so that a few kilobytes of channels do not ask for gigabytes.
void checkKeySharing(const Asset& asset, std::span<const Index> animations);

struct ClipWriteOptions {
  // Fewer bytes: the numbers of a clip share a buffer view, and rotations whose values are all 16-bit fractions
  // (n / 32767) are written as such, without loss. Readers of glTF 2.0 take both; others may not.
  bool compact = false;
};

// Adds one animation for each clip; nothing else of the document changes, but that a joint that gets a channel has its
// transform as translation, rotation and scale. Clips without a name become "clip"; names that are there already get a
// number behind them. `skeleton` is readSkeleton(asset). Returns the names as they are written.
//
// A joint without a track is kept in its rest pose, even where its node has another transform. Values are written as
// they are, interpolation too; tracks of one value have one key, and none where the node has that value. Tracks of
// equal times share one accessor. For a skeleton without joints the animations have no channel. Throws Error
// kBadArgument where the skeleton is not of that asset, kBadData as checkClip does, with the clip's name, and where a
// root is below a node without an inverse (a scale of 0).
std::vector<std::string> addClips(Asset& asset, const AssetSkeleton& skeleton, std::span<const Clip> clips,
                                  const ClipWriteOptions& options = {});

}  // namespace limber
