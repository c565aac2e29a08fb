// Weights made anew for a folder of rigged characters, measured against their artists', as a page for the docs.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/evaluate/skin/weight_metrics.h"
#include "limber/report/table.h"

namespace limber {

struct WeightTableRow {
  std::string file;    // without folder and extension
  std::string folder;  // last name of the folder that was asked for
  WeightComparison comparison;
  double seconds = 0;  // to make the weights, reading and writing files left out
};

// Gives the asset's skeleton new weights (autoRig with kKeepSkeleton).
using Reweight = std::function<void(Asset&)>;

// One row for each .glb and .gltf below `folder` that has a rig and triangles, ordered by name; what cannot be read or
// has no weights is counted in `skipped`. Throws Error kFile where the folder cannot be read.
std::vector<WeightTableRow> compareFolder(const std::filesystem::path& folder, const Reweight& reweight,
                                          Progress& progress, Warnings& skipped);

// What another program reaches on the same files.
struct WeightReference {
  std::string file;
  bool manyPieces = false;  // robots, clothed people
  bool madeByHeat = false;  // the artist's weights are most likely that program's own
  double l1 = 0, l1Nearest = 0, deform = 0, deformNearest = 0;
};

// From tab-separated lines: file, group ("pieces" or other), made ("heat" or artist), and the four numbers; the first
// line that is no comment (#) names the columns. Throws Error kBadData naming the line.
std::vector<WeightReference> parseWeightReferences(std::string_view text);

// Means over the groups, and a line for each row with the reference's figures beside; files without a reference are a
// group for each folder. References may be empty.
std::vector<Table> weightTables(std::span<const WeightTableRow> rows, std::span<const WeightReference> references);

// Means, a line for each folder and method: the methods side by side over the same files.
struct MethodRows {
  std::string method;
  std::vector<WeightTableRow> rows;
};
Table weightMethodTable(std::span<const MethodRows> methods);

// docs/weights.md: what was measured and how, then weightTables, in Markdown.
std::string weightPage(std::span<const WeightTableRow> rows, std::span<const WeightReference> references);

}  // namespace limber
