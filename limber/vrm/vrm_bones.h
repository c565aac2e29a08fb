// The humanoid bones of a VRM, among the joints of a model.
#pragma once

#include <string_view>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/asset/rig_io.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// As a VRM says (1.0, else 0.x), as far as its nodes are joints of `rig`; of a model that is none, or that has lost
// required bones, as the body is read (humanoidJoints). What VRM 1.0 does not allow is left out, with a warning
// "vrm-bones": a bone that does not hang below the one that it needs (an upper chest without a chest among them). Of
// those that a VRM must have some may still hang elsewhere: hangBones.
//
// Throws Error kUnsupported that names the required bones that are missing.
std::vector<HumanoidJoint> vrmBones(const Asset& asset, const AssetSkeleton& rig, Warnings& warnings);
// The same of a skeleton alone.
std::vector<HumanoidJoint> vrmBones(const Skeleton& skeleton, std::string_view name, Warnings& warnings);

// Does that extension of VRM (humanoid_nodes.h) name a node for each of the 15 bones that every VRM has?
bool hasAllBones(const gltf::Document& document, const char* extension);

}  // namespace limber
