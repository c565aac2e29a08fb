// glTF extensions: what a document says of them.
#pragma once

#include "limber/asset/json_access.h"

namespace limber {

// Of VRM 1.0: chains of nodes that swing.
inline constexpr const char* kSpringBoneName = "VRMC_springBone";

// The extension of that name of a node, a primitive, ...; absent where there is none.
JsonView extensionOf(const JsonView& owner, const char* name);

// Takes an extension out of an object, and "extensions" where nothing else is in it. True if it was there.
bool eraseExtension(Json& owner, const char* name);

// Takes a name out of the lists of extensions that a document uses and requires.
void undeclareExtension(Json& document, const char* name);

// Counts the required extensions that may change how the model looks or moves in a way that limber knows nothing of:
// warning "unknown-extensions". They stay as they are. Extensions of materials, textures and lights do not count:
// nothing that limber does depends on them.
void warnOfUnknownExtensions(Asset& asset);

}  // namespace limber
