#include "limber/evaluate/rig/decomposition_table.h"

#include <algorithm>
#include <optional>

#include "limber/character/character.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/evaluate/group_summary.h"
#include "limber/evaluate/model_files.h"
#include "limber/evaluate/skin/weight_metrics.h"

namespace limber {

namespace {

constexpr double kComesBack = 0.3;  // percent of the diagonal

std::optional<DecompositionRow> decomposeFile(const std::filesystem::path& path, const Decomposer& decompose) {
  const Asset asset = readAsset(path);
  if (!hasRig(asset)) return std::nullopt;
  const Character character(asset);
  Warnings ignored;
  const std::vector<Clip> clips = readClips(asset, character.binding(), ignored);
  const auto longest = std::max_element(clips.begin(), clips.end(),
                                        [](const Clip& a, const Clip& b) { return a.duration() < b.duration(); });
  if (longest == clips.end() || longest->duration() == 0) return std::nullopt;
  DecompositionRow row;
  row.file = path.stem().string();
  row.clip = longest->name;
  row.artistJoints = countWeightedJoints(character.weights(), character.binding().skeleton.jointCount());
  decompose(asset, row.clip, row.artistJoints, row);
  return row;
}

}  // namespace

std::vector<DecompositionRow> decomposeFolder(const std::filesystem::path& folder, const Decomposer& decompose,
                                              Progress& progress, Warnings& skipped) {
  const std::vector<std::filesystem::path> files = modelsBelow(folder);
  std::vector<DecompositionRow> rows;
  forEachFile(files.size(), "decompose", kNotCompared, progress, skipped, [&](std::size_t i) {
    if (std::optional<DecompositionRow> row = decomposeFile(files[i], decompose)) {
      row->folder = lastName(folder);
      rows.push_back(std::move(*row));
    } else {
      skipped.add("without-clip", "files without a rig or a clip left out", files[i].filename().string());
    }
  });
  return rows;
}

Table decompositionTable(std::span<const DecompositionRow> rows) {
  using Row = DecompositionRow;
  const std::vector<RowMeasure<Row>> measures = {
      {"artist's joints", decimals(1), Statistic::kMean, &Row::artistJoints},
      {"bones", decimals(1), Statistic::kMean, &Row::bones},
      {"error %", decimals(3), Statistic::kMean, &Row::error},
      {"median", decimals(3), Statistic::kMedian, &Row::error},
      {"most", decimals(3), Statistic::kWorst, &Row::error},
      {"within 0.3 %", decimals(0), Statistic::kSum, [](const Row& row) { return row.error <= kComesBack ? 1 : 0; }},
      {"s", decimals(1), Statistic::kMean, &Row::seconds},
      {"most s", decimals(1), Statistic::kWorst, &Row::seconds}};
  Table table = summaryTable({words("characters"), number("files", 0)}, measures);
  for (const std::string& folder : namesIn(rows, &Row::folder)) {
    const RowGroup<Row> group = rowsWhere(rows, [&](const Row& row) { return row.folder == folder; });
    addSummary({folder, group.size()}, group, measures, table);
  }
  return table;
}

Table eachDecomposition(std::span<const DecompositionRow> rows) {
  Table table{{words("folder"), words("file"), words("clip"), number("points", 0), number("frames", 0),
               number("joints", 0), number("bones", 0), number("error", 4), number("seconds", 2)}};
  for (const DecompositionRow& row : rows) {
    table.add(
        {row.folder, row.file, row.clip, row.points, row.frames, row.artistJoints, row.bones, row.error, row.seconds});
  }
  return table;
}

}  // namespace limber
