// An Asset to files and bytes.
#pragma once

#include <filesystem>
#include <span>

#include "limber/core/file/file.h"
#include "limber/document/asset.h"

namespace limber {

// GLB or glTF by the extension of `path` ("-": GLB on standard output). All files or none (see writeFiles).
//
// A .gltf comes with its buffers and images beside it: those that were read from files keep their names and folders
// (folders are made), the others become <stem>.bin, data URIs stay such. A file that is there already, under such a
// name and with other bytes, is left alone; ours then gets the stem in front.
//
// Files of `companions` (a report) are written with the model and are complete before it is.
//
// Throws Error kBadArgument for another extension, kFile.
void writeAsset(const Asset& asset, const std::filesystem::path& path, std::span<const OutputFile> companions = {});

// The bytes of a GLB: all buffers in the one binary chunk (which cannot keep names and extras of the second and further
// buffers), images of side files embedded. Equal assets give equal bytes.
Bytes writeGlb(const Asset& asset);

}  // namespace limber
