// limber evaluate decomposition: artists' characters baked to moving vertices, and their bones found again.
#include <filesystem>
#include <memory>

#include "command.h"
#include "limber/actions/motion/vertex_animation.h"
#include "limber/evaluate/rig/decomposition_table.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct DecompositionArguments {
  std::vector<std::string> folders;
  std::string each, output = "-";
  Common common;
};

void decomposeClip(const Asset& asset, const std::string& clip, Index bones, DecompositionRow& row) {
  Progress unheard;
  VertexAnimation animation = readVertexAnimation(asset, {clip, std::nullopt}, unheard);
  row.points = animation.sequence.pointCount();
  row.frames = animation.sequence.frameCount();
  const std::vector<Vec3f> rest = animation.sequence.rest;
  DecompositionOptions options;
  options.bones = bones;
  const double start = secondsNow();
  const Decomposition found = decomposeSkin(std::move(animation.sequence), options, unheard);
  row.bones = skeletonOfBones(rest, found).skeleton.jointCount();
  row.seconds = secondsNow() - start;
  row.error = 100 * found.error;
}

void runDecomposition(const DecompositionArguments& arguments) {
  arguments.common.apply();
  checkOutput(arguments.output, {".md"});
  if (!arguments.each.empty()) checkOutput(arguments.each, {".tsv"});
  checkBeside("--each", arguments.each, {arguments.output});
  TerminalProgress progress(arguments.common.quiet);
  Warnings skipped;
  std::vector<DecompositionRow> rows;
  for (const std::string& folder : arguments.folders) {
    const std::vector<DecompositionRow> more = decomposeFolder(folder, decomposeClip, *progress, skipped);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  refuseNothing(rows.empty(), skipped);
  writeTexts(arguments.each, toTsv(eachDecomposition(rows)), arguments.output, toMarkdown(decompositionTable(rows)));
  printWarnings(skipped, arguments.common.quiet);
}

}  // namespace

void addDecompositionEvaluation(CLI::App& evaluate) {
  auto arguments = std::make_shared<DecompositionArguments>();
  CLI::App* command = evaluate.add_subcommand(
      "decomposition", "Bake the clips of rigged characters to moving vertices and find their bones again");
  command->add_option("FOLDER", arguments->folders, "folders of rigged characters with clips")->required();
  command->add_option("--each", arguments->each, "write the figures of each file, tab separated (.tsv)")
      ->check(notForPlans())
      ->type_name("FILE");
  addMarkdownOutput(*command, arguments->output, "the table");
  arguments->common.addTo(*command);
  command->footer(
      "Of each file the longest clip, with as many bones as have weights in it. The error is the root mean square\n"
      "distance of vertices from where the clip had them, in percent of the bounding box's diagonal.\n"
      "\nExample:\n  limber evaluate decomposition characters creatures/tune --each figures.tsv");
  command->callback([arguments] { runDecomposition(*arguments); });
}

}  // namespace limber::cli
