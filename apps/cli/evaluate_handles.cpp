// limber evaluate handles: how well handles suit models, at several counts.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "command.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/evaluate/rig/handle_quality.h"
#include "limber/preview/render.h"
#include "limber/skeleton/pose.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

constexpr int kPictureSize = 240;  // pixels

struct HandleArguments {
  std::vector<std::string> files;
  std::vector<Index> counts = {4, 8, 12, 20, 40};
  std::string rigger = "sphere-mesh", sheet, moves, output = "-";
  Common common;
};

PreviewOptions handlesOnSheet() {
  PreviewOptions options;
  options.show = PreviewShow::kHandles;
  options.width = options.height = kPictureSize;
  return options;
}

// The model with one handle after another, but the root, moved upwards by a tenth of its size.
std::vector<Image> movedHandles(const Asset& asset) {
  constexpr double kMove = 0.1;
  const Character character(asset);
  const SceneMaker scenes(character);
  PreviewOptions options;
  options.width = options.height = kPictureSize;
  Box box;
  for (const Vec3f& p : scenes.still().positions) box.add(p.cast<double>());
  const double distance = kMove * box.longestSide();
  options.frame = Box{box.min - Vec3::Constant(distance), box.max + Vec3::Constant(distance)};
  const Skeleton& skeleton = character.skeleton();
  std::vector<Image> pictures;
  for (const Joint& joint : skeleton.joints) {
    if (!joint.parent) continue;
    Pose pose = restPose(skeleton);
    editPose(skeleton, pose,
             {.turns = {}, .scales = {}, .moves = {{joint.name, distance * Vec3::UnitY()}}, .reaches = {}});
    pictures.push_back(render(scenes.at(pose), options));
  }
  return pictures;
}

// Rows of unequal length.
Bytes sheetOfRows(const std::vector<std::vector<Image>>& rows, const Image& empty) {
  std::size_t columns = 1;
  for (const std::vector<Image>& row : rows) columns = std::max(columns, row.size());
  std::vector<Image> pictures;
  for (const std::vector<Image>& row : rows) {
    pictures.insert(pictures.end(), row.begin(), row.end());
    pictures.insert(pictures.end(), columns - row.size(), empty);
  }
  return encodePng(contactSheet(pictures, static_cast<int>(columns), empty));
}

void runHandles(const HandleArguments& arguments) {
  arguments.common.apply();
  checkOutput(arguments.output, {".md"});
  for (const std::string& sheet : {arguments.sheet, arguments.moves}) {
    if (!sheet.empty()) checkOutput(sheet, {".png"});
  }
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
  std::vector<std::vector<Image>> moves;
  const auto seen = [&](const Asset& asset) {
    if (!arguments.sheet.empty()) pictures.push_back(render(makeScene(asset), handlesOnSheet()));
    if (!arguments.moves.empty()) moves.push_back(movedHandles(asset));
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
  if (!arguments.moves.empty()) writeFile(arguments.moves, sheetOfRows(moves, renderBackdrop(handlesOnSheet())));
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
  command->add_option("--moves", arguments->moves, "write pictures of each handle moved by a tenth of the size (.png)")
      ->check(notForPlans())
      ->type_name("FILE");
  addMarkdownOutput(*command, arguments->output, "the table");
  arguments->common.addTo(*command);
  command->footer(
      "For each model and count: handles inside the surface; those that no vertex follows by a tenth (idle); ends of\n"
      "limbs, found by paths through the inside, and how many of them follow a handle of their own; ends that do not\n"
      "though an equal one does (equals without); handles whose part of the surface touches no part of their parent's\n"
      "(stray parents); weight that a handle has beyond a gap (over air); area that a handle drags though it is "
      "neither\n"
      "its part nor beside it (moved beside).\n"
      "\nExample:\n  limber evaluate handles stool.glb horse.glb --counts 8,16 --sheet handles.png");
  command->callback([arguments] { runHandles(*arguments); });
}

}  // namespace limber::cli
