// Artists' rigged characters baked to moving vertices and decomposed again, as a table.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/report/table.h"

namespace limber {

struct DecompositionRow {
  std::string file;    // without folder and extension
  std::string folder;  // last name of the folder that was asked for
  std::string clip;    // the longest
  Index points = 0, frames = 0;
  Index artistJoints = 0;  // of the file, that have weights
  Index bones = 0;         // that were found; never more than were asked for
  double error = 0;        // root mean square over points and frames, percent of the rest pose's diagonal
  double seconds = 0;      // to find bones and joints, reading and baking left out
};

// Decomposes the clip of that name with at most that many bones; fills in the row from `points` on.
using Decomposer = std::function<void(const Asset& asset, const std::string& clip, Index bones, DecompositionRow& row)>;

// One row for each .glb and .gltf below `folder` that has a rig and a clip, ordered by name: its longest clip, with as
// many bones as its artist gave weights to. What cannot be compared is counted in `skipped`. Throws Error kFile where
// the folder cannot be read.
std::vector<DecompositionRow> decomposeFolder(const std::filesystem::path& folder, const Decomposer& decompose,
                                              Progress& progress, Warnings& skipped);

// A line for each folder: means, and how many files come back within 0.3 % of the diagonal.
Table decompositionTable(std::span<const DecompositionRow> rows);
// A line for each row.
Table eachDecomposition(std::span<const DecompositionRow> rows);

}  // namespace limber
