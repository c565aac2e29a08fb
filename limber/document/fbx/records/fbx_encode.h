// Records as the bytes of a binary FBX file, version 7.4.
#pragma once

#include <span>

#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

// What a record of the name "FileId", and the text of one called "CreationTime", have to be: Autodesk's readers compare
// them with the end of the file, which the encoder writes for these (as Blender's exporter, io_scene_fbx, found out).
ByteSpan fbxFileId();
inline constexpr std::string_view kFbxCreationTime = "1970-01-01 10:00:00:000";

// The file with these records at its top level: header, records, the empty record that ends them, and the footer that
// Autodesk's readers look for. A record without values is written with an end of its (empty) list. Arrays are deflated
// (encoding 1) where that makes them shorter. Little-endian, 32-bit offsets. Throws Error kLimit where the file would
// reach 4 GB. Cost: O(bytes).
Bytes encodeFbxFile(std::span<const FbxNode> records);

}  // namespace limber
