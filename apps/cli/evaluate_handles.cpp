// limber evaluate handles: how well handles suit models, at several counts.
#include <filesystem>
#include <memory>

#include "command.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/evaluate/rig/handle_quality.h"
#include "limber/preview/render.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct HandleArguments {
  std::vector<std::string> files;
  std::vector<Index> counts = {4, 8, 12, 20, 40};
  std::string rigger = "sphere-mesh", sheet, output = "-";
  Common common;
};

PreviewOptions handlesOnSheet() {
  PreviewOptions options;
  options.show = PreviewShow::kHandles;
  options.width = options.height = 240;
  return options;
}

void runHandles(const HandleArguments& arguments) {
  arguments.common.apply();
  checkOutput(arguments.output, {".md"});
  if (!arguments.sheet.empty()) checkOutput(arguments.sheet, {".png"});
  findRigger(arguments.rigger);
  AutoRigOptions options;
  options.rigger = arguments.rigger;
  options.existingRig = ExistingRig::kReplace;
  const auto rig = [&](Asset& asset, Index count) {
    options.rig.handles = count;
    Progress unheard;
    autoRig(asset, options, unheard);
  };
  std::vector<Image> pictures;
  const auto seen = [&](const Asset& asset) {
    if (!arguments.sheet.empty()) pictures.push_back(render(makeScene(asset), handlesOnSheet()));
  };
  TerminalProgress progress(arguments.common.quiet);
  Warnings skipped;
  const std::vector<std::filesystem::path> files(arguments.files.begin(), arguments.files.end());
  const std::vector<HandleTableRow> rows = evaluateHandles(files, arguments.counts, rig, seen, *progress, skipped);
  refuseNothing(rows.empty(), skipped);
  if (!arguments.sheet.empty()) {
    const int columns = static_cast<int>(arguments.counts.size());
    writeFile(arguments.sheet, encodePng(contactSheet(pictures, columns, renderBackdrop(handlesOnSheet()))));
  }
  writeText(arguments.output, toMarkdown(handleTable(rows)));
  printWarnings(skipped, arguments.common.quiet);
}

}  // namespace

void addHandleEvaluation(CLI::App& evaluate) {
  auto arguments = std::make_shared<HandleArguments>();
  CLI::App* command =
      evaluate.add_subcommand("handles", "Give models handles, several counts of them, and measure how well they suit");
  command->add_option("FILE", arguments->files, "models")->required();
  command->add_option("--counts", arguments->counts, "how many handles, separated by commas")
      ->delimiter(',')
      ->type_name("N,N,...")
      ->capture_default_str();
  command->add_option("--rigger", arguments->rigger, "sphere-mesh, curve-skeleton or another of limber rig")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--sheet", arguments->sheet, "write pictures of the handles, a row for each model (.png)")
      ->check(notForPlans())
      ->type_name("FILE");
  addMarkdownOutput(*command, arguments->output, "the table");
  arguments->common.addTo(*command);
  command->footer(
      "For each model and count: handles inside the surface; those that no vertex follows by a tenth (idle); ends of\n"
      "limbs, found by paths through the inside, and how many of them follow a handle of their own; handles whose\n"
      "part of the surface touches no part of their parent's (stray parents); weight that a handle has beyond a gap\n"
      "(over air).\n"
      "\nExample:\n  limber evaluate handles stool.glb horse.glb --counts 8,16 --sheet handles.png");
  command->callback([arguments] { runHandles(*arguments); });
}

}  // namespace limber::cli
