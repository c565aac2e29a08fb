// A document's materials as UsdPreviewSurface.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/usd/usd_surface.h"
#include "limber/document/usd/usd_write.h"

namespace limber {

// The primvar that holds a set of texture coordinates: "st", "st1", ...
std::string uvPrimvar(Index uvSet);

// Adds a scope with one prim for each of the document's materials to `root`, none where it has none; returns their
// paths. The images that they use, and what cannot be said of them, are added to `files`. Those of `colored` have their
// colour from the vertices, where these have one.
std::vector<std::string> addUsdMaterials(const Asset& asset, const std::vector<UsdSurface>& surfaces,
                                         const std::set<Index>& colored, const std::string& imageStem, UsdPrim& root,
                                         UsdFiles& files);

}  // namespace limber
