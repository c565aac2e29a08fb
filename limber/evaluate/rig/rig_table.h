// Comparisons of skeletons as JSON, as text, and over a folder of rigged characters as a table.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/document/clip/clip_moment.h"
#include "limber/evaluate/rig/rig_metrics.h"
#include "limber/report/table.h"

namespace limber {

// Every field of the comparison by its name.
Json toJson(const RigComparison& comparison);

// A few lines for a terminal.
std::string toText(const RigComparison& comparison);

// What a rigger said of its fit.
struct RigFit {
  bool isAbstained = false;  // handles instead of a template
  std::string likeliest;     // of the templates
  double confidence = 0;     // in it, 0 to 1
};

struct RigTableRow {
  std::filesystem::path path;
  std::string name;  // the file's, without folder and extension; with the moment of a clip
  RigFit fit;
  RigComparison comparison;
  double seconds = 0;  // to make the rig, reading and writing files left out
};

// Replaces the asset's rig.
using Rerig = std::function<RigFit(Asset&)>;
// Is shown the asset of each row with its new rig.
using RiggedSeen = std::function<void(const Asset&)>;

// One row for each of the files that has a rig and triangles, in their order. The others are counted in `skipped`:
// "without-rig", "unreadable", and "not-rigged" where `rerig`, or the comparison of what it made, fails. Given a
// time, each is put in its pose then (standAt) before it is rigged and compared.
std::vector<RigTableRow> compareRigsOf(std::span<const std::filesystem::path> files, const Rerig& rerig,
                                       Progress& progress, Warnings& skipped,
                                       const std::optional<ClipMoment>& moment = std::nullopt,
                                       const RiggedSeen& seen = {});

// A line for each row and one of means.
Table rigTable(std::span<const RigTableRow> rows);

}  // namespace limber
