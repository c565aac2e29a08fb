// Which nodes play the bones of a person, as VRM's extensions of a document say.
#pragma once

#include <string_view>
#include <vector>

#include "limber/document/gltf/gltf.h"

namespace limber {

inline constexpr const char* kVrmName = "VRMC_vrm";                     // VRM 1.0
inline constexpr const char* kVrm0Name = "VRM";                         // VRM 0.x
inline constexpr const char* kVrmAnimationName = "VRMC_vrm_animation";  // a motion for VRMs

struct HumanoidNode {
  std::string_view bone;  // VRM 1.0 name, lives forever
  Index node = 0;
};

// What that extension (one of the three above) says, in the order of humanoidBones(); VRM 0.x under the names of 1.0.
// Unknown bones, numbers that are no node's, and nodes and bones that were named before are passed over. Empty where
// the document does not have the extension.
std::vector<HumanoidNode> humanoidNodes(const gltf::Document& document, const char* extension);

// What the first of VRM 1.0, VRM 0.x and a motion for VRMs says that names any bone.
std::vector<HumanoidNode> declaredBones(const gltf::Document& document);
// #nodes: the same by node, empty where a node is declared to be no bone.
std::vector<std::string_view> declaredBoneOfNode(const gltf::Document& document);

// The name in VRM 1.0 of a bone of VRM 0.x, which counts a thumb's joints otherwise ("leftThumbProximal" is
// "leftThumbMetacarpal"); any other as it is.
std::string_view boneOfVrm0(std::string_view name);

}  // namespace limber
