// A new rest pose for a rigged Asset: its current pose becomes the bind pose.
#pragma once

#include <optional>
#include <span>

#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/pose.h"

namespace limber {

// Vertices go where linear blend skinning takes them in `pose`, normals, tangents and morph targets with them; the
// joint nodes get the pose, and the inverse bind matrices make it the bind pose of the skins. Clips move joints as they
// did: where an animation left a part of a joint's transform to its node and the node has changed, it gets a key that
// holds the old value.
//
// A vertex whose joints all moved alike from bind pose to `pose` (those of a single joint among them) looks the same at
// every moment of every clip. One that is shared by joints that moved against each other does in `pose` only; no
// inverse bind matrices can give more. Warning "shared-vertices" counts these.
//
// Mesh copies and skin copies are made where other nodes, not in the scene, show the same. Accessors that nothing uses
// any more leave the list. Throws Error kBadArgument where `pose` is not of that skeleton, kBadData naming a joint or
// skin that a scale of 0 makes flat. The asset is then half changed.
//
// skeleton  readSkeleton(asset) of the asset as it is
// pose      as of readNodePose
//
// stretch   #J maps in the joints' own frames, by which what is bound to each is deformed before it moves; the joint's
//           children, other joints among them, are not. Empty: none
void setRestPose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose, std::span<const Mat3> stretch = {});

// Brings the vertices of skins that were bound in another pose than the joints they share (skinsBoundElsewhere) to the
// bind pose of the whole, as setRestPose does for all, with inverse binds that say so. Nodes and clips stay. True if
// there was such a skin (warning "joined-binds"). Throws Error kLimit where copies of meshes that are shown with
// several skins would be of many millions of vertices.
bool joinBindPoses(Asset& asset);

// The same of a copy; none where there is nothing to do.
std::optional<Asset> withJoinedBinds(const Asset& asset);

// Gives only the joint nodes that pose: the surface follows by its weights, skins stay bound where they are, and clips
// show every vertex where they did, by added keys as above. Throws as writeNodePose does.
void setNodePose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose);

}  // namespace limber
