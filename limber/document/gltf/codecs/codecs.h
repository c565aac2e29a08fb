// Compressed geometry inside glTF (meshopt, Draco) turned into plain buffer views and accessors.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Decodes every buffer view under EXT_meshopt_compression or KHR_meshopt_compression and every primitive under
// KHR_draco_mesh_compression, so that nothing behind here meets them: their extension objects go, the extensions'
// names go from extensionsUsed and extensionsRequired, compressed bytes that nothing else refers to go, and a warning
// "decompressed" says so. Data that the file also holds uncompressed are taken as they are.
//
// Throws Error kUnsupported where there is no decoder (a build without LIMBER_CODECS, a page that brings none),
// kBadData where data do not decode to what the accessors promise. Memory is bounded by the size of the compressed
// data.
void decompress(Asset& asset);

}  // namespace limber
