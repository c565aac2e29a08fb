// limber rig: a static model goes in, a skinned one comes out.
#include <algorithm>
#include <locale>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "adapter_arguments.h"
#include "animation_rig.h"
#include "command.h"
#include "limber/actions/export/write_model.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_check_report.h"
#include "limber/actions/rig/rig_request.h"
#include "limber/adapters/rig_by_program.h"
#include "limber/core/counted.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "limber/rigging/roles/body_kinds.h"
#include "progress_line.h"
#include "target_arguments.h"

namespace limber::cli {

namespace {

struct RigArguments {
  std::string input, output, report;
  RigRequest request;
  AutoRigOptions rig;  // as the request says, once it is complete
  std::optional<std::string> templateName, reading;
  std::vector<std::string> pins;
  bool replaceRig = false, keepSkeleton = false, strict = false;
  AnimationRigArguments animation;
  TargetArguments target;
  AdapterArguments adapters;
  Common common;
};

constexpr double kWorthPrinting = 0.0005;  // seconds; shorter steps are left out of the account
constexpr std::size_t kNodesListed = 8;

Json reportJson(const RigArguments& options, const std::string& format, const AutoRigReport& report) {
  Json json;
  json["limber"] = LIMBER_VERSION;
  json["command"] = "rig";
  json["input"] = {{"file", options.input}, {"format", format}};
  json["output"] = options.output;
  json.update(toJson(report));
  return json;
}

// What a stage did, beside its time.
std::string outcome(const std::string& stage, const AutoRigReport& report) {
  if (stage == "read geometry") {
    std::string text = counted(report.sourceVertices, "vertex", "vertices");
    if (report.removedJoints == 0) return text;
    return text + fmt::format("; taken out: {}, {}", counted(report.removedJoints, "joint"),
                              counted(report.removedClips, "clip"));
  }
  if (stage == "weld") {
    return fmt::format("{}, {}, {}", counted(report.weldedVertices, "vertex", "vertices"),
                       counted(report.triangles, "triangle"), counted(report.pieces, "piece"));
  }
  if (stage == "rig") {
    const std::string joints = counted(report.joints, "joint");
    return report.rigger.empty() ? joints + ", kept" : fmt::format("{} ({})", joints, report.rigger);
  }
  if (stage == "skin") return fmt::format("at most {} a vertex ({})", report.maxInfluences, report.skinning);
  return "";
}

void printStages(const Account& account, const AutoRigReport& report) {
  constexpr std::string_view kIndent = "  ";
  std::size_t width = 0;
  for (const StageTime& stage : report.stages) {
    width = std::max(width, stage.name.size());
    for (const StageTime& step : stage.steps) width = std::max(width, kIndent.size() + step.name.size());
  }
  const auto print = [&](std::string_view name, double seconds, const std::string& what) {
    account.line(fmt::format("{:<{}}{:>9.3f} s{}{}", name, width, seconds, what.empty() ? "" : "   ", what));
  };
  for (const StageTime& stage : report.stages) {
    print(stage.name, stage.seconds, outcome(stage.name, report));
    for (const StageTime& step : stage.steps) {
      if (step.seconds >= kWorthPrinting) print(fmt::format("{}{}", kIndent, step.name), step.seconds, "");
    }
  }
  print("total", totalSeconds(report.stages), "");
}

void printBridged(const AutoRigReport& report) {
  for (std::size_t i = 0; i < std::min(report.bridged.size(), kNodesListed); ++i) {
    const BridgedNode& node = report.bridged[i];
    fmt::print(stderr, "  bridged in {}: {} of {}\n", printable(node.name), node.bridged,
               counted(node.vertices, "vertex", "vertices"));
  }
  if (report.bridged.size() > kNodesListed) {
    fmt::print(stderr, "  and in {} more\n", counted(report.bridged.size() - kNodesListed, "node"));
  }
}

void printAccount(const Account& account, const RigArguments& options, const AutoRigReport& report) {
  printStages(account, report);
  if (!report.suggestions.empty()) {
    std::vector<Index> counts;
    for (const HandleSuggestion& suggestion : report.suggestions) counts.push_back(suggestion.handles);
    std::sort(counts.begin(), counts.end());
    account.line(fmt::format("counts of handles that suit this model: {}", fmt::join(counts, ", ")));
  }
  if (!report.matches.empty()) {
    std::vector<std::string> matches;
    for (const TemplateMatch& match : report.matches) {
      matches.push_back(fmt::format("{} ({:.0f} % sure)", match.name, 100 * match.confidence));
    }
    account.line(fmt::format("template: {}{}", report.isAbstained ? "none; " : "", fmt::join(matches, ", else ")));
    if (report.isAbstained) {
      account.line(fmt::format("--template {} fits that one all the same", report.matches.front().name));
    }
    if (!report.chains.empty()) account.line(fmt::format("swinging: {}", fmt::join(report.chains, ", ")));
    if (!report.doubts.empty()) {
      account.line(
          fmt::format("most in doubt: {}; --pin JOINT=x,y,z tells where one is", fmt::join(report.doubts, ", ")));
    }
  }
  printWarnings(report.warnings, options.common.quiet);
  if (!options.common.quiet) printBridged(report);
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

// "leftHand=0.71,1.43,0.02"
JointPin parsePin(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  JointPin pin;
  if (equals != std::string::npos && equals > 0) {
    pin.joint = text.substr(0, equals);
    std::istringstream numbers(text.substr(equals + 1));
    numbers.imbue(std::locale::classic());
    char comma = ',', second = ',', rest = 0;
    if (numbers >> pin.position.x() >> comma >> pin.position.y() >> second >> pin.position.z() && comma == ',' &&
        second == ',' && !(numbers >> rest) && pin.position.allFinite()) {
      return pin;
    }
  }
  throw CLI::ValidationError("--pin", "takes JOINT=x,y,z, not " + text);
}

template <class Method>
std::vector<std::string> namesOf(std::span<const Method> methods) {
  std::vector<std::string> names;
  for (const Method& method : methods) names.emplace_back(method.name);
  return names;
}

// Programs of the user's instead of methods of limber's.
struct RigPrograms {
  std::optional<Adapter> rigger, weights;
};

RigPrograms findPrograms(const RigArguments& options) {
  const AdapterArguments& adapters = options.adapters;
  return {
      adapters.programFor(options.rig.rigger, "rigger", AdapterKind::kRig, namesOf(riggerMethods())),
      adapters.programFor(options.rig.skinning, "skinning method", AdapterKind::kWeights, namesOf(weightMethods()))};
}

// A program that weighs gets a rig, with weights of limber's: the usual ones, or those that cost next to nothing.
AutoRigReport rigAsRequested(Asset& asset, AutoRigOptions rig, const RigPrograms& programs, Progress& progress) {
  if (programs.weights) rig.skinning = programs.weights->takesWeights ? AutoRigOptions().skinning : "nearest-bone";
  AutoRigReport report =
      programs.rigger ? rigByProgram(asset, *programs.rigger, rig, progress) : autoRig(asset, rig, progress);
  if (programs.weights) {
    report.warnings.append(weightsByProgram(asset, *programs.weights, rig.weights, progress));
    report.skinning = programs.weights->name;
    progress.finish();
    report.stages = progress.stages();
  }
  return report;
}

void completeRequest(RigArguments& options) {
  RigRequest& request = options.request;
  if (options.replaceRig) request.existingRig = "replace";
  if (options.keepSkeleton) request.existingRig = "keep-skeleton";
  request.reading = options.reading;
  for (const std::string& pin : options.pins) request.pins.push_back(parsePin(pin));
  request.target = options.target.target;
  options.rig = checkedOptions(
      [&] { return options.templateName ? optionsWithTemplate(request, *options.templateName) : optionsOf(request); });
}

// The first line of the account comes before the work: what the model is taken for, and what is in the way.
void announceCheck(AutoRigOptions& rig, const Account& account, TerminalProgress& progress) {
  if (rig.rig.templateName != "auto" || rig.rig.templateSkeleton) return;
  rig.onCheck = [&](const RigCheck& check) {
    progress.clear();
    account.line(summaryOf(check));
  };
}

void run(RigArguments options) {
  options.common.apply();
  checkOutput(options.output, modelExtensions());
  if (options.animation.frames.empty()) {
    if (options.input.empty()) throw CLI::RequiredError("IN");
    checkBeside("--json", options.report,
                {options.input, options.output, options.templateName.value_or(""), options.reading.value_or("")});
  }
  completeRequest(options);
  if (!options.animation.frames.empty()) {
    return runAnimationRig(
        options.animation,
        {options.output, options.report, options.request.maxInfluences, options.strict, options.request.target},
        options.common);
  }
  const RigPrograms programs = findPrograms(options);
  if (programs.rigger && options.request.handles) {
    throw CLI::ValidationError("--handles", "a program of yours makes as many joints as it does");
  }
  options.adapters.refuseUnused({options.rig.rigger, options.rig.skinning}, programs.rigger || programs.weights);

  // Whatever goes to standard output goes there alone.
  const bool busy = options.output == "-" || options.report == "-";
  const Account account(options.common.quiet, busy ? "-" : "");
  TerminalProgress progress(options.common.quiet);
  if (!options.common.quiet) announceCheck(options.rig, account, progress);
  progress->stage("read");
  Asset asset = readAsset(options.input);
  AutoRigReport report = rigAsRequested(asset, options.rig, programs, *progress);
  finishRig(asset, options.request, report);
  if (options.strict) refuseWarnings(report.warnings);
  progress->stage("write");
  // The report is written with the model, so it cannot tell how long that took.
  std::string text;
  std::vector<OutputFile> companions;
  if (!options.report.empty()) {
    report.stages = progress->stages();
    text = dumpReport(reportJson(options, asset.format, report)) + "\n";
    companions.push_back({options.report, asBytes(text)});
  }
  WriteModelOptions write;
  write.companions = companions;
  report.warnings.append(writeModel(asset, options.output, write));
  progress.finish();
  report.stages = progress->stages();
  printAccount(account, options, report);
}

// CLI11 takes an optional value that is empty for one that is not there.
void refuseEmptyValues(CLI::App& command) {
  for (CLI::Option* option :
       command.get_options([](const CLI::Option* one) { return one->get_items_expected_max() > 0; })) {
    option->check(CLI::Validator([](const std::string& value) { return value.empty() ? "is empty" : ""; }, ""));
  }
}

template <class Method>
std::string listMethods(std::string_view title, std::span<const Method> methods) {
  std::string text = fmt::format("{}:\n", title);
  for (const Method& method : methods) {
    text += fmt::format("  {:<20}{}", method.name, method.summary);
    text += method.paper.empty() ? "\n" : fmt::format(" ({})\n", method.paper);
  }
  return text;
}

template <class Table>
std::string listNamed(std::string_view title, const Table& table) {
  std::string text = fmt::format("{}:\n", title);
  for (const auto& named : table) text += fmt::format("  {:<20}{}\n", named.name, named.summary);
  return text;
}

std::string rigHelp() {
  return listMethods("Riggers", riggerMethods()) + listNamed("Templates", bodyKinds()) +
         listMethods("Skinning methods", weightMethods()) + listNamed("Pieces", pieceModes()) +
         TargetArguments::list() +
         "\nPrograms of yours rig (--rigger NAME) and make weights (--skinning NAME), too: docs/adapters.md.\n"
         "\nReads GLB, glTF, OBJ, PLY, STL, OFF, FBX and DAE. The result appears under its name only when it is\n"
         "complete; a file of that name is replaced, also where it is the input.\n"
         "\nExamples:\n"
         "  limber rig dragon.glb --handles 20 -o rigged.glb\n"
         "  limber rig person.glb --template humanoid -o hero.glb\n"
         "  limber rig person.glb --template humanoid --pin leftHand=0.55,1.04,0 -o character.glb\n"
         "  limber rig hero.glb --keep-skeleton --max-influences 8 -o weighted.glb --json report.json\n"
         "  limber rig person.glb --template humanoid --target unreal -o character.glb\n"
         "  limber rig person.glb --rigger unirig --seed 7 -o character.glb\n"
         "  limber rig --from-animation walking.glb --bones 30 -o bones.glb\n"
         "  mkdir frames\n"
         "  for t in 1 2 3 4; do limber pose walking.glb --time 0.$t --bake -o frames/$t.obj -q; done\n"
         "  limber rig --from-animation frames/ --fps 24 -o bones.glb\n"
         "  limber rig - -o - < dragon.glb > rigged.glb";
}

}  // namespace

void addRigCommand(CLI::App& program) {
  auto options = std::make_shared<RigArguments>();
  CLI::App* command = program.add_subcommand("rig", "Give a model handles and skin weights");
  command->add_option("IN", options->input, "the model; - is standard input");
  command->add_option("-o,--output", options->output, modelOutputHelp())->required()->type_name("FILE");
  RigRequest& request = options->request;
  command->add_option("--handles", request.handles, "handles wanted (default: the best suggested count)")
      ->type_name("N");
  command->add_option("--max-influences", request.maxInfluences, "joints that may move one vertex, 1 to 8")
      ->type_name("K")
      ->capture_default_str();
  command
      ->add_option("--rigger", request.rigger,
                   "how joints are found, see below (default: sphere-mesh, or template where one is named)")
      ->type_name("NAME");
  command
      ->add_option("--template", options->templateName,
                   "fit this named skeleton: auto, a name below, or a file with a skeleton (.glb, .bvh, .json, ...)")
      ->type_name("NAME");
  command
      ->add_option("--pin", options->pins,
                   "where a joint of the template must be, as JOINT=x,y,z in the file's space; others follow")
      ->type_name("PIN")
      ->allow_extra_args(false);
  command->add_option("--up", request.up, "the model's up, for a template, as +y (default: found)")->type_name("AXIS");
  command->add_option("--front", request.front, "where the model looks, for a template, as +z (default: found)")
      ->type_name("AXIS");
  command->add_flag("--upright", request.upright,
                    "turn a model that surely stands along another axis to stand along +Y");
  command->add_flag("--chains", request.chains,
                    "give capes, scarves, braids and tails joints that swing (VRMC_springBone)");
  command
      ->add_option("--reading", options->reading,
                   "networks of your own that read the shape: a file of ./dev learn export")
      ->type_name("FILE");
  command->add_option("--skinning", request.skinning, "how weights are made, see below")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--pieces", request.pieces, "how pieces that are joined to no other are bound, see below")
      ->type_name("NAME")
      ->capture_default_str();
  options->target.addTo(*command);
  CLI::Option* animation = addAnimationRigOptions(*command, options->animation);
  for (const char* other : {"IN", "--handles", "--rigger", "--template", "--pin", "--up", "--front", "--upright",
                            "--chains", "--reading", "--skinning", "--pieces"}) {
    animation->excludes(command->get_option(other));
  }
  CLI::Option* replace = command->add_flag("--replace-rig", options->replaceRig,
                                           "take the model's own rig and its joint animation out first");
  replace->excludes(animation);
  command->add_flag("--keep-skeleton", options->keepSkeleton, "keep the model's own skeleton, make its weights anew")
      ->excludes(replace)
      ->excludes(animation);
  command
      ->add_option("--json", options->report,
                   "write a report: stages, seconds, counts, suggestions, warnings; - is standard output")
      ->check(notForPlans())
      ->type_name("FILE");
  command->add_flag("--strict", options->strict, "take warnings as errors");
  options->adapters.addTo(*command);
  options->common.addTo(*command);
  refuseEmptyValues(*command);
  command->footer(rigHelp());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
