// A model as USD, rigged and moving: for AR Quick Look, and for programs that read UsdSkel.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "limber/core/file/file.h"
#include "limber/document/asset.h"

namespace limber {

enum class UsdForm { kText, kCrate };

struct UsdOptions {
  std::optional<std::string> clip;  // a file holds one; none: the document's first, where it has any
  std::string imageStem = "image";  // images are called image_0.png, image_1.jpg, ...
  UsdForm form = UsdForm::kCrate;
};

// A surface that is not animated: points and unit normals in the world, as many as collectGeometry(asset) has
// positions.
struct UsdStillSurface {
  std::span<const Vec3f> points, normals;
};

// A stage ("model.usda", "model.usdc"), and the images that it names by their paths.
struct UsdFiles {
  struct Image {
    std::string path;  // "image_0.png"
    Bytes bytes;
  };
  UsdForm form = UsdForm::kCrate;
  Bytes stage;
  std::vector<Image> images;
  Warnings warnings;  // what USD cannot say, or limber does not write
};

// +Y up, metres, one SkelRoot: a Skeleton with bind and rest transforms; a Mesh for each primitive that the default
// scene shows, in the world of the bind pose, with the weights as they are (up to 8 a vertex) and its blend shapes; the
// clip as a SkelAnimation, sampled at its own keys (cubic tracks 60 times a second between); materials as
// UsdPreviewSurface. Without a clip the joints stand as the document's nodes do. A model without a rig is meshes alone.
//
// Names are made of letters, digits and underscores, and unique. Throws Error kBadData as collectGeometry does,
// kBadArgument that lists the clips there are. Cost: O(#vertices + #keys * #joints).
UsdFiles usdFiles(const Asset& asset, const UsdOptions& options = {});
// That surface with the asset's materials: meshes alone, without joints, blend shapes and clip. Errors as above;
// kBadArgument where the counts do not match.
UsdFiles stillUsdFiles(const Asset& asset, const UsdStillSurface& surface);

// The same in one file: a stored ZIP archive with every file at a multiple of 64 bytes (USDZ 1.3).
Bytes encodeUsdz(const UsdFiles& files);

// A .usdz, or a .usda or .usdc with its images beside, called after it: all files or none, `companions` (a report)
// among them. Throws Error kFile.
Warnings writeUsd(const Asset& asset, const std::filesystem::path& path, UsdOptions options = {},
                  std::span<const OutputFile> companions = {});

}  // namespace limber
