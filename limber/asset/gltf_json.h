// The JSON of a glTF document to types and back.
#pragma once

#include "limber/asset/gltf.h"

namespace limber::gltf {

// Throws Error kBadData with the path of the member ("meshes[0].primitives[2].indices") where something that limber
// relies on is missing or of the wrong type. Whether indices are in range is for checkAsset to say. What is wrong in
// members that only drawing needs is left as it is, unread. Throws kUnsupported on another version than 2.0.
Document documentOf(Json json);

// A document that came from JSON and was not changed gives that JSON again, with the order of its keys and the form of
// its numbers. A list that became empty, as glTF forbids, is left out
// unless glTF asks for it.
Json jsonOf(const Document& document);

}  // namespace limber::gltf
