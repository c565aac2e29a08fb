#include "limber/evaluate/rig/decomposition_table.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "limber/character/character.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/evaluate/median.h"
#include "limber/evaluate/model_files.h"

namespace limber {

namespace {

constexpr double kComesBack = 0.3;  // percent of the diagonal

Index weightedJoints(const Character& character) {
  const SkinWeights& weights = character.weights();
  std::vector<bool> isUsed(character.binding().skeleton.jointCount(), false);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    if (weights.weights[i] > 0) isUsed[weights.joints[i]] = true;
  }
  return static_cast<Index>(std::count(isUsed.begin(), isUsed.end(), true));
}

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
  row.artistJoints = weightedJoints(character);
  decompose(asset, row.clip, row.artistJoints, row);
  return row;
}

std::string folderLine(std::span<const DecompositionRow> rows) {
  std::vector<double> errors, seconds;
  double joints = 0, bones = 0, sum = 0, time = 0;
  for (const DecompositionRow& row : rows) {
    errors.push_back(row.error);
    seconds.push_back(row.seconds);
    joints += row.artistJoints;
    bones += row.bones;
    sum += row.error;
    time += row.seconds;
  }
  const auto count = static_cast<double>(rows.size());
  const auto within = std::count_if(errors.begin(), errors.end(), [](double e) { return e <= kComesBack; });
  return fmt::format("| {} | {} | {:.1f} | {:.1f} | {:.3f} | {:.3f} | {:.3f} | {} | {:.1f} | {:.1f} |\n",
                     rows.front().folder, rows.size(), joints / count, bones / count, sum / count, median(errors),
                     *std::max_element(errors.begin(), errors.end()), within, time / count,
                     *std::max_element(seconds.begin(), seconds.end()));
}

}  // namespace

std::vector<DecompositionRow> decomposeFolder(const std::filesystem::path& folder, const Decomposer& decompose,
                                              Progress& progress, Warnings& skipped) {
  const std::vector<std::filesystem::path> files = modelsBelow(folder);
  std::vector<DecompositionRow> rows;
  progress.stage("decompose");
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(files.size()));
    try {
      if (std::optional<DecompositionRow> row = decomposeFile(files[i], decompose)) {
        row->folder = lastName(folder);
        rows.push_back(std::move(*row));
      } else {
        skipped.add("without-clip", "files without a rig or a clip left out", files[i].filename().string());
      }
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add("unreadable", "files that cannot be compared left out", error.what());
    }
  }
  progress.finish();
  return rows;
}

std::string decompositionTable(std::span<const DecompositionRow> rows) {
  std::string table =
      "| characters | files | artist's joints | bones | error % | median | most | within 0.3 % | s | most s |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].folder == rows[begin].folder) ++end;
    table += folderLine(rows.subspan(begin, end - begin));
    begin = end;
  }
  return table;
}

std::string eachDecomposition(std::span<const DecompositionRow> rows) {
  std::string text = "folder\tfile\tclip\tpoints\tframes\tjoints\tbones\terror\tseconds\n";
  for (const DecompositionRow& row : rows) {
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:.2f}\n", row.folder, row.file, row.clip, row.points,
                        row.frames, row.artistJoints, row.bones, row.error, row.seconds);
  }
  return text;
}

}  // namespace limber
