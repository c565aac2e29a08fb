// The JSON of a glTF document to types and back.
#pragma once

#include <cstddef>
#include <limits>

#include "limber/document/gltf/gltf.h"

namespace limber::gltf {

// Throws Error kBadData with the path of the member ("meshes[0].primitives[2].indices") where something that limber
// relies on is missing or of the wrong type. Whether indices are in range is for checkAsset to say. What is wrong in
// members that only drawing needs is left as it is, unread. Throws kUnsupported on another version than 2.0,
// and kLimit where its lists have more objects than a text of this length has reason to: an object takes hundreds of
// bytes here and three ("{},") there.
// textSize  bytes of the text that the JSON was parsed from; by default the objects are not counted
Document documentOf(Json json, std::size_t textSize = std::numeric_limits<std::size_t>::max());

// A document that came from JSON and was not changed gives that JSON again, with the order of its keys and the form of
// its numbers. A list that became empty, as glTF forbids, is left out
// unless glTF asks for it.
Json jsonOf(const Document& document);

}  // namespace limber::gltf
