// Motions in and out of files.
#pragma once

#include <filesystem>
#include <string_view>

#include "limber/document/bvh/bvh_read.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/smpl/smpl_motion.h"
#include "limber/skeleton/motion.h"

namespace limber {

// What files leave open.
struct MotionOptions {
  BvhOptions bvh;
  SmplOptions smpl;
};

// The motion in a file: BVH (bvh_read.h), arrays in SMPL's form (smpl_motion.h), glTF, or any other model with
// animations that readAsset reads (FBX, DAE). Throws Error as those do, and kBadData where the file has neither a
// skeleton nor nodes that move. A skeleton without clips is a motion too.
Motion readMotion(const std::filesystem::path& path, const MotionOptions& options = {});
Motion readMotion(ByteSpan bytes, std::string_view name, const MotionOptions& options = {},
                  const Resolver& resolver = {});

// The motion in a document: its skeleton (animatedSkeleton, or the one given) and all its clips (readClips).
Motion motionOf(const Asset& asset);
Motion motionOf(const Asset& asset, const AssetSkeleton& skeleton);

// The skeleton of what moves in the document. For a VRM motion (VRMC_vrm_animation), its humanoid bones, called by
// VRM's names, with the nodes between them (its expressions and its gaze are not read); else readSkeleton where it has
// a skin; else one joint for each node that is animated, lies between animated nodes, or is a child of one without
// showing anything itself (the end of a bone). The rest pose is then that of the nodes. Throws Error kBadData where
// nothing is animated either, as in a model that moves by blend shapes alone.
AssetSkeleton animatedSkeleton(const Asset& asset);

// The same, without joints there.
AssetSkeleton movingSkeleton(const Asset& asset);

// Is that readSkeleton's: has the document a skin, and is it no VRM motion?
bool isMovedBySkin(const Asset& asset);

// The clip of that name, in full or behind the last '|' (Blender's exporters put the armature's name before); the first
// where none is named, and where the document has none an empty one (the rest pose). Over the movingSkeleton of the
// asset: without tracks where it moves blend shapes alone. Throws Error kBadArgument that lists the names, and as
// animatedSkeleton does where there are no clips.
Clip findClip(const Asset& asset, std::string_view name);

// Is there no mesh, but a skeleton: a skin's, animated nodes, or several nodes?
bool isSkeletonAlone(const Asset& asset);

// A glTF document that holds the motion alone: a node for each joint, a skin that says that they are joints, and the
// clips. Several roots get a node above them.
Asset motionAsset(const Motion& motion);

}  // namespace limber
