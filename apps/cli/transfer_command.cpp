// limber transfer: the rig of one model on another.
#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.h"
#include "limber/actions/export/write_model.h"
#include "limber/actions/transfer/transfer_asset.h"
#include "limber/core/counted.h"
#include "limber/core/text/names.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_body.h"
#include "limber/preview/surface_colors.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct TransferArguments {
  std::string source, target, output, report;
  TransferAssetOptions transfer;
  bool noShapes = false, colors = false, ignoreRig = false, strict = false;
  Common common;
};

constexpr std::size_t kPartsListed = 4;

std::string reportText(const TransferArguments& options, const TransferReport& report) {
  Json json;
  json["limber"] = LIMBER_VERSION;
  json["command"] = "transfer";
  json["source"] = options.source;
  json["target"] = options.target;
  json["output"] = options.output;
  json.update(toJson(report));
  return dumpReport(json) + "\n";
}

void printGaps(const Account& account, const SurfaceGaps& gaps) {
  account.line(fmt::format("surfaces apart   {:.2f} % of the height (RMS), 95 % within {:.2f} %, worst {:.2f} %",
                           gaps.rms, gaps.p95, gaps.worst));
  account.line(fmt::format("beyond {} %       {:.1f} % of the surface", kGap, 100 * gaps.beyond));
  for (std::size_t i = 0; i < std::min(kPartsListed, gaps.parts.size()) && gaps.parts[i].beyond > 0; ++i) {
    const PartGap& part = gaps.parts[i];
    account.line(fmt::format("  {:<16}{:.0f} % of it", part.part, 100 * part.beyond));
  }
}

void printAccount(const TransferArguments& options, const TransferReport& report) {
  const Account account(options.common.quiet, options.output);
  account.line(fmt::format("source           {}", counted(report.sourceVertices, "vertex", "vertices")));
  std::string target = counted(report.targetVertices, "vertex", "vertices");
  if (report.removedJoints > 0) {
    target += fmt::format("; taken out: {}, {}", counted(report.removedJoints, "joint"),
                          counted(report.removedClips, "clip"));
  }
  account.line(fmt::format("target           {}", target));
  account.line(fmt::format("landmarks        {}, by {} ({:.0f} % sure)", report.landmarks, report.landmarksBy,
                           100 * report.confidence));
  account.line(fmt::format("joints           {}", report.joints));
  if (!report.blendShapes.empty()) {
    account.line(fmt::format("blend shapes     {}", joinNames(report.blendShapes)));
  }
  printGaps(account, report.gaps);
  account.line(fmt::format("seconds          {:.2f}", totalSeconds(report.stages)));
  printWarnings(report.warnings, options.common.quiet);
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

Asset readSource(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return lowerExtension(name) == ".npz" ? smplBody(readSmplArrays(readFile(path), name), name) : readAsset(path);
}

void runTransferCommand(TransferArguments options) {
  options.common.apply();
  checkOutput(options.output, modelExtensions());
  checkBeside("--report", options.report, {options.source, options.target, options.output});
  options.transfer.blendShapes = !options.noShapes;
  options.transfer.ownSkeleton = !options.ignoreRig;
  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  const Character character(readSource(options.source));
  const Asset& source = character.document();
  Asset target = readAsset(options.target);
  std::optional<SurfaceColors> colors;
  if (options.colors) {
    if (!hasColors(source)) {
      throw Error(ErrorCode::kUnsupported, "has no colours: no texture, no base colour, none at its vertices",
                  options.source, "leave out --colors");
    }
    colors.emplace(character);
    options.transfer.colors.at = [&](Index triangle, const Vec3& weights) { return colors->at(triangle, weights); };
    if (options.transfer.colors.pictureSize > 0) options.transfer.colors.picture = pngOfColors;
  }
  TransferReport report = transferOnto(character, target, options.transfer, *progress);
  if (colors) report.warnings.append(colors->warnings());
  report.warnings.append(source.warnings);
  if (options.strict) refuseWarnings(report.warnings);
  const std::string text = reportText(options, report);
  std::vector<OutputFile> companions;
  if (!options.report.empty()) companions.push_back({options.report, asBytes(text)});
  WriteModelOptions write;
  write.companions = companions;
  report.warnings.append(writeModel(target, options.output, write));
  progress.finish();
  printAccount(options, report);
}

}  // namespace

void addTransferCommand(CLI::App& program) {
  auto options = std::make_shared<TransferArguments>();
  CLI::App* command = program.add_subcommand("transfer", "Put the rig of one model onto another model");
  command
      ->add_option("SOURCE", options->source,
                   "the model whose joints, weights and blend shapes are taken; or a body in SMPL's layout, .npz")
      ->required();
  command->add_option("TARGET", options->target, "the model that gets them: a scan, a sculpture, another character")
      ->required();
  command->add_option("-o,--output", options->output, modelOutputHelp())->required()->type_name("FILE");
  command->add_option("--max-influences", options->transfer.rig.maxInfluences, "joints that move a vertex, at most")
      ->check(CLI::Range(1, 8).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--report", options->report, "write what was done, and where the surfaces stay apart, as JSON")
      ->check(notForPlans())
      ->type_name("FILE");
  command->add_flag("--no-blend-shapes", options->noShapes, "leave the source's blend shapes out");
  command->add_flag("--colors", options->colors,
                    "give the target the source's colours in place of its own: as a texture where its texture "
                    "coordinates take one, else at its vertices");
  command
      ->add_option("--texture-size", options->transfer.colors.pictureSize,
                   "with --colors: width and height of a texture, in pixels; 0: colours at vertices alone")
      ->check(CLI::Range(0, 8192).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--ignore-target-rig", options->ignoreRig,
                    "find the target's limbs by its surface alone, even if it has a rig that tells");
  command->add_flag("--strict", options->strict, "take warnings as errors: write nothing");
  options->common.addTo(*command);
  command->footer(
      "The source is laid along the limbs of the target, which a template fitted to both, or the target's own rig,\n"
      "tells; then its surface is bent onto the target's, and joints, weights and blend shapes go along. Joints keep\n"
      "their names, their tree and their axes. Both bodies should be of one kind, such as people; the poses in which\n"
      "they stand may differ. docs/methods.md tells more.\n"
      "\nExamples:\n"
      "  limber transfer hero.glb person.glb -o person_rigged.glb\n"
      "  limber transfer hero.glb person.glb -o person_rigged.glb --report gaps.json\n"
      "  limber transfer hero.glb person.glb --colors -o person_as_hero.glb\n"
      "  limber retarget person_rigged.glb walk.bvh -o person_walks.glb");
  command->callback([options] { runTransferCommand(*options); });
}

}  // namespace limber::cli
