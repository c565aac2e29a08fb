// glTF extensions: what a document says of them.
#pragma once

#include <string>
#include <string_view>

#include "limber/document/asset.h"

namespace limber {

// Of VRM 1.0: chains of nodes that swing.
inline constexpr const char* kSpringBoneName = "VRMC_springBone";
// Channels of animations that name what they change by a JSON pointer.
inline constexpr const char* kPointerName = "KHR_animation_pointer";
// Many copies of a node's mesh, each with a transform of its own.
inline constexpr const char* kInstancingName = "EXT_mesh_gpu_instancing";

// The content of an extension of a node, a primitive, ...; null where there is none.
const Json* extensionOf(const gltf::Object& owner, const char* name);

// The same to change it, made where there is none.
Json& changeExtension(gltf::Object& owner, const char* name);

// Takes an extension out of an object, and "extensions" where nothing else is in it. True if it was there.
bool eraseExtension(gltf::Object& owner, const char* name);

// Puts a name into the list of extensions that a document uses; takes it out of all lists.
void declareExtension(gltf::Document& document, std::string_view name);
void undeclareExtension(gltf::Document& document, std::string_view name);

// The accessors of a node's EXT_mesh_gpu_instancing ("TRANSLATION", "ROTATION", "SCALE"); none where it does not use
// it. Throws Error kBadData below `location` ("nodes[3]") where they are no numbers.
gltf::Attributes instancingOf(const gltf::Node& node, std::string_view location);

// The pointer of a target with KHR_animation_pointer ("/nodes/12/rotation"); null where it has none.
const std::string* animationPointer(const gltf::AnimationChannel::Target& target);
void setAnimationPointer(gltf::AnimationChannel::Target& target, std::string_view pointer);

// Counts the required extensions that may change how the model looks or moves and that limber does not know: warning
// "unknown-extensions". They stay as they are. Extensions of materials, textures and lights do not count: nothing that
// limber does depends on them.
void warnOfUnknownExtensions(Asset& asset);

}  // namespace limber
