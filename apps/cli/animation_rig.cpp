#include "animation_rig.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/actions/export/write_model.h"
#include "limber/actions/obj_series.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_from_animation.h"
#include "limber/core/counted.h"
#include "limber/core/text/names.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

namespace fs = std::filesystem;

ObjSeries readFrames(const AnimationRigArguments& arguments, Progress& progress) {
  std::vector<fs::path> files(arguments.frames.begin(), arguments.frames.end());
  if (files.size() == 1 && fs::is_directory(files.front())) files = objFilesIn(files.front());
  const bool isSeries = files.size() > 1 || lowerExtension(files.front()) == ".obj";
  for (const fs::path& file : files) {
    if (!isSeries || lowerExtension(file) == ".obj") continue;
    throw Error(ErrorCode::kBadArgument, "is no .obj file", file.string(),
                "give one file with an animation, or one OBJ file for each frame");
  }
  if (isSeries) {
    if (!arguments.clip.empty()) throw CLI::ValidationError("--clip", "OBJ files are one clip");
    return readObjSeries(files, arguments.fps.value_or(30), progress);
  }
  ObjSeries result;
  result.asset = readAsset(files.front());
  result.animation = readVertexAnimation(result.asset, {arguments.clip, arguments.fps}, progress);
  return result;
}

void printAnimationRig(const Account& account, const AnimationRigReport& report, const std::string& output) {
  account.line(fmt::format("{}, {}, {} of {}", counted(report.sourceVertices, "vertex", "vertices"),
                           counted(report.points, "distinct trajectory", "distinct trajectories"),
                           counted(report.frames, "frame"), counted(report.clips, "clip")));
  for (const StageTime& stage : report.stages) account.line(fmt::format("{:<12}{:>9.3f} s", stage.name, stage.seconds));
  account.line(fmt::format("{}, at most {} a vertex; root mean square error {:.4f} % of the diagonal",
                           counted(report.joints, "bone"), report.maxInfluences, 100 * report.error));
  if (output != "-") account.line(fmt::format("written: {}", output));
}

}  // namespace

CLI::Option* addAnimationRigOptions(CLI::App& command, AnimationRigArguments& arguments) {
  CLI::Option* from =
      command
          .add_option("--from-animation", arguments.frames,
                      "find the bones of a mesh that moves: a file with clips or animated morph targets, a folder of "
                      "OBJ files, or OBJ files, one for each frame")
          ->type_name("FILE...");
  command.add_option("--clip", arguments.clip, "with --from-animation: only this clip (default: all)")
      ->needs(from)
      ->type_name("NAME");
  command
      .add_option("--bones", arguments.bones,
                  "with --from-animation: bones wanted (default: enough for an error of 0.2 % of the diagonal)")
      ->needs(from)
      ->check(CLI::Range(Index{1}, kMaxBones).description(""))
      ->type_name("N");
  command
      .add_option("--fps", arguments.fps,
                  "with --from-animation: frames a second (default: that of each clip's keys; of OBJ files 30)")
      ->needs(from)
      ->check(numberIn(0.01, 10000))
      ->type_name("RATE");
  return from;
}

void runAnimationRig(const AnimationRigArguments& arguments, const AnimationRigOutput& output, const Common& common) {
  std::vector<std::string> others = arguments.frames;
  others.push_back(output.output);
  checkBeside("--json", output.report, others);
  TerminalProgress progress(common.quiet);
  progress->stage("read");
  ObjSeries model = readFrames(arguments, *progress);
  DecompositionOptions options;
  options.bones = arguments.bones;
  options.maxInfluences = output.maxInfluences;
  const std::string format = model.asset.format;
  AnimationRigReport report = rigFromAnimation(model.asset, std::move(model.animation), options, *progress);
  if (output.strict) refuseWarnings(report.warnings);
  progress->stage("write");
  std::string text;
  std::vector<OutputFile> companions;
  if (!output.report.empty()) {
    Json json;
    json["limber"] = LIMBER_VERSION;
    json["command"] = "rig";
    json["input"] = {{"file", arguments.frames.front()}, {"format", format}};
    json["output"] = output.output;
    json.update(toJson(report));
    text = dumpReport(json) + "\n";
    companions.push_back({output.report, asBytes(text)});
  }
  WriteModelOptions write;
  write.target = output.target;
  write.companions = companions;
  report.warnings.append(writeModel(model.asset, output.output, write));
  progress.finish();
  const bool busy = output.output == "-" || output.report == "-";
  printAnimationRig(Account(common.quiet, busy ? "-" : ""), report, output.output);
  printWarnings(report.warnings, common.quiet);
}

}  // namespace limber::cli
