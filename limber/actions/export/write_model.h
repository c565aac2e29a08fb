// The formats that a model is written in, all known here alone.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/actions/export/engine_target.h"
#include "limber/core/file/file.h"
#include "limber/document/asset.h"
#include "limber/document/vrm/vrm_meta.h"

namespace limber {

struct WriteModelOptions {
  std::string target = std::string(kPlainTarget);  // a name of engineTargets()
  SkeletonReading reading = Skeleton();            // of the model's skeleton, if there is one
  std::optional<std::string> clip;                 // of formats that hold one; none: the document's first
  bool isStill = false;                            // formats that hold one clip get none
  std::optional<FbxUnit> fbxUnit;                  // none: the target's
  FbxUpAxis fbxUp = FbxUpAxis::kY;
  VrmMeta vrm;                                  // of a VRM
  std::span<const OutputFile> companions = {};  // written with the model, and moved to their paths before it
};

// ".glb", ".gltf", ...
std::vector<std::string_view> modelExtensions();
// "the .glb, .gltf, ... to write; - is standard output (GLB)": the help of options that name an output.
std::string modelOutputHelp();
// Does the format hold one clip a file?
bool holdsOneClip(const std::filesystem::path& path);

// The model for the target, in the format that the extension says ("-": GLB on standard output), with the files that
// belong beside it. All files or none. Returns what the target and the format cannot keep. Throws Error kBadArgument
// for another extension or target, kFile, and as toTarget and the format's writer do.
Warnings writeModel(const Asset& asset, const std::filesystem::path& path, const WriteModelOptions& options = {});

// The same as bytes. Formats of several files (".gltf", ".usda", ".usdc") come as a stored ZIP archive, the model
// first, then what it refers to.
struct EncodedModel {
  Bytes bytes;
  Warnings warnings;
};
EncodedModel encodeModel(const Asset& asset, std::string_view extension, const WriteModelOptions& options = {});

}  // namespace limber
