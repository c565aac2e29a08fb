// limber rig: a static model goes in, a skinned one comes out.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.h"
#include "limber/asset/read.h"
#include "limber/asset/write.h"
#include "limber/pipeline/auto_rig.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct Options {
  std::string input, output, report;
  AutoRigOptions rig;
  bool replaceRig = false, keepSkeleton = false, strict = false;
  Common common;
};

constexpr double kWorthPrinting = 0.0005;  // seconds

double totalSeconds(const std::vector<StageTime>& stages) {
  double sum = 0;
  for (const StageTime& stage : stages) sum += stage.seconds;
  return sum;
}

Json reportJson(const Options& options, const std::string& format, const AutoRigReport& report) {
  Json json;
  json["limber"] = LIMBER_VERSION;
  json["command"] = "rig";
  json["input"] = {{"file", options.input}, {"format", format}};
  json["output"] = options.output;
  json["methods"] = {{"rigger", options.rig.rigger}, {"skinning", options.rig.skinning}};
  json["counts"] = {{"vertices", report.sourceVertices}, {"welded_vertices", report.weldedVertices},
                    {"triangles", report.triangles},     {"pieces", report.pieces},
                    {"joints", report.joints},           {"max_influences", options.rig.weights.maxInfluences}};
  json["seconds"] = totalSeconds(report.stages);
  json["stages"] = Json::array();
  for (const StageTime& stage : report.stages) {
    json["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  json["suggestions"] = Json::array();
  for (const HandleSuggestion& suggestion : report.suggestions) {
    json["suggestions"].push_back({{"handles", suggestion.handles}, {"score", suggestion.score}});
  }
  json["warnings"] = Json::array();
  for (const Warning& warning : report.warnings.items()) {
    json["warnings"].push_back(
        {{"kind", warning.kind}, {"message", warning.message}, {"where", warning.where}, {"count", warning.count}});
  }
  return json;
}

// What a stage did, beside its time.
std::string outcome(const std::string& stage, const AutoRigReport& report) {
  if (stage == "read geometry") return fmt::format("{} vertices", report.sourceVertices);
  if (stage == "weld") {
    return fmt::format("{} vertices, {} triangles, {} {}", report.weldedVertices, report.triangles, report.pieces,
                       report.pieces == 1 ? "piece" : "pieces");
  }
  if (stage == "rig") return fmt::format("{} joints", report.joints);
  return "";
}

void printAccount(const Account& account, const Options& options, const AutoRigReport& report) {
  std::size_t width = 5;
  for (const StageTime& stage : report.stages) width = std::max(width, stage.name.size());
  const auto printStage = [&](std::string_view name, double seconds, const std::string& what) {
    account.line(fmt::format("{:<{}}{:>9.3f} s{}{}", name, width, seconds, what.empty() ? "" : "   ", what));
  };
  std::string what;
  for (const StageTime& stage : report.stages) {
    const std::string own = outcome(stage.name, report);
    if (!own.empty()) what = own;
    // A stage that at once gave way to the method's own stages leaves what it has to say to these.
    if (stage.seconds < kWorthPrinting && (own.empty() || stage.name == "rig")) continue;
    printStage(stage.name, stage.seconds, what);
    what.clear();
  }
  printStage("total", totalSeconds(report.stages), "");
  if (!report.suggestions.empty()) {
    std::vector<Index> counts;
    for (const HandleSuggestion& suggestion : report.suggestions) counts.push_back(suggestion.handles);
    std::sort(counts.begin(), counts.end());
    account.line(fmt::format("counts of handles that suit this model: {}", fmt::join(counts, ", ")));
  }
  printWarnings(account, report.warnings);
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

void run(Options options) {
  options.common.apply();
  if (options.report == options.output) {
    throw CLI::ValidationError("--json", "the report cannot go where the model goes");
  }
  checkOutput(options.output, {".glb", ".gltf"});
  if (options.replaceRig) options.rig.existingRig = ExistingRig::kReplace;
  if (options.keepSkeleton) options.rig.existingRig = ExistingRig::kKeepSkeleton;
  findRigger(options.rig.rigger);
  findWeightMethod(options.rig.skinning);

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.input);
  AutoRigReport report = autoRig(asset, options.rig, *progress);
  if (options.strict) refuseWarnings(report.warnings);
  progress->stage("write");
  // The report is written with the model, so it cannot tell how long that took.
  std::string text;
  std::vector<OutputFile> companions;
  if (!options.report.empty()) {
    report.stages = progress->stages();
    text = reportJson(options, asset.format, report).dump(2) + "\n";
    companions.push_back({options.report, asBytes(text)});
  }
  writeAsset(asset, options.output, companions);
  progress.finish();
  report.stages = progress->stages();

  // Whatever goes to standard output goes there alone.
  const bool busy = options.output == "-" || options.report == "-";
  printAccount(Account(options.common.quiet, busy ? "-" : ""), options, report);
}

template <class Method>
std::string listMethods(std::string_view title, std::span<const Method> methods) {
  std::string text = fmt::format("{}:\n", title);
  for (const Method& method : methods) {
    text += fmt::format("  {:<14}{} ({})\n", method.name, method.summary, method.paper);
  }
  return text;
}

std::string help() {
  return listMethods("Riggers", riggerMethods()) + listMethods("Skinning methods", weightMethods()) +
         "\nReads GLB, glTF, OBJ, PLY, STL, OFF, FBX and DAE. The result appears under its name only when it is\n"
         "complete; a file of that name is replaced, also where it is the input.\n"
         "\nExamples:\n"
         "  limber rig dragon.glb --handles 20 -o rigged.glb\n"
         "  limber rig person.glb --keep-skeleton --max-influences 8 -o weighted.glb --json report.json\n"
         "  curl -s https://example.org/dragon.glb | limber rig - -o - > rigged.glb";
}

}  // namespace

void addRigCommand(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("rig", "Give a model handles and skin weights");
  command->add_option("IN", options->input, "the model; - is standard input")->required();
  command->add_option("-o,--output", options->output, "the .glb or .gltf to write; - is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  command->add_option("--handles", options->rig.rig.handles, "handles wanted (default: the best suggested count)")
      ->check(CLI::Range(Index{1}, kNoIndex - 1).description(""))
      ->type_name("N");
  command->add_option("--max-influences", options->rig.weights.maxInfluences, "joints that may move one vertex, 1 to 8")
      ->check(CLI::Range(1, 8).description(""))
      ->type_name("K")
      ->capture_default_str();
  command->add_option("--rigger", options->rig.rigger, "how joints are found, see below")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--skinning", options->rig.skinning, "how weights are made, see below")
      ->type_name("NAME")
      ->capture_default_str();
  CLI::Option* replace = command->add_flag("--replace-rig", options->replaceRig,
                                           "take the model's own rig and its joint animation out first");
  command->add_flag("--keep-skeleton", options->keepSkeleton, "keep the model's own skeleton, make its weights anew")
      ->excludes(replace)
      ->excludes("--handles");
  command
      ->add_option("--json", options->report,
                   "write a report: stages, seconds, counts, suggestions, warnings; - is standard output")
      ->type_name("FILE");
  command->add_flag("--strict", options->strict, "take warnings as errors");
  options->common.addTo(*command);
  command->footer(help());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
