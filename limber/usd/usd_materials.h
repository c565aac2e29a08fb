// A document's materials as UsdPreviewSurface.
#pragma once

#include <string>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/usd/usd_text.h"
#include "limber/usd/usd_write.h"

namespace limber {

// Writes a scope with one prim for each of the document's materials, none where it has none; returns their paths. The
// images that they use, and what cannot be said of them, are added to `files`.
std::vector<std::string> writeUsdMaterials(const Asset& asset, const std::string& imageStem, UsdText& text,
                                           UsdFiles& files);

}  // namespace limber
