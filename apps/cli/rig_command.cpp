// limber rig: a static model goes in, a skinned one comes out.
#include <algorithm>
#include <filesystem>
#include <locale>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "adapter_arguments.h"
#include "animation_rig.h"
#include "command.h"
#include "limber/adapters/rig_by_program.h"
#include "limber/asset/json_text.h"
#include "limber/asset/read.h"
#include "limber/asset/write.h"
#include "limber/core/counted.h"
#include "limber/pipeline/report_json.h"
#include "limber/pipeline/template_file.h"
#include "limber/rigging/template_rigger.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct RigArguments {
  std::string input, output, report;
  AutoRigOptions rig;
  std::string templateName, up, front, pieces = "auto";
  std::vector<std::string> pins;
  bool replaceRig = false, keepSkeleton = false, strict = false;
  AnimationRigArguments animation;
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
    fmt::print(stderr, "  bridged in {}: {} of {}\n", node.name, node.bridged,
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

// "+y", "-z", "x": an axis of the file's space after conversion to glTF's.
std::optional<Vec3> parseAxis(const std::string& text, std::string_view option) {
  if (text.empty()) return std::nullopt;
  const std::size_t at = text[0] == '+' || text[0] == '-' ? 1 : 0;
  if (text.size() == at + 1) {
    const char axis = static_cast<char>(text[at] | 0x20);  // lower case
    if (axis >= 'x' && axis <= 'z') return Vec3((text[0] == '-' ? -1.0 : 1.0) * Vec3::Unit(axis - 'x'));
  }
  throw CLI::ValidationError(std::string(option), "takes +x, -x, +y, -y, +z or -z, not " + text);
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
    if (numbers >> pin.place.x() >> comma >> pin.place.y() >> second >> pin.place.z() && comma == ',' &&
        second == ',' && !(numbers >> rest) && pin.place.allFinite()) {
      return pin;
    }
  }
  throw CLI::ValidationError("--pin", "takes JOINT=x,y,z, not " + text);
}

// A template's name, or a file whose skeleton becomes the template.
void chooseTemplate(const std::string& name, AutoRigOptions& rig) {
  if (name.empty()) return;
  rig.rigger = "template";
  rig.rig.templateName = name;
  if (std::filesystem::path(name).extension().empty()) {
    checkTemplateName(name);
    return;
  }
  rig.rig.templateSkeleton = readTemplateFile(name);
}

template <class Method>
std::vector<std::string> namesOf(std::span<const Method> methods) {
  std::vector<std::string> names;
  for (const Method& method : methods) names.emplace_back(method.name);
  return names;
}

// Programs of the user's in place of methods of limber's.
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
AutoRigReport rigAsTold(Asset& asset, AutoRigOptions rig, const RigPrograms& programs, Progress& progress) {
  if (programs.weights) rig.skinning = programs.weights->takesWeights ? AutoRigOptions().skinning : "nearest-bone";
  const bool isKept = rig.existingRig == ExistingRig::kKeepSkeleton;
  AutoRigReport report =
      programs.rigger && !isKept ? rigByProgram(asset, *programs.rigger, rig, progress) : autoRig(asset, rig, progress);
  if (programs.weights) {
    report.warnings.append(weightsByProgram(asset, *programs.weights, rig.weights, progress));
    report.skinning = programs.weights->name;
    progress.finish();
    report.stages = progress.stages();
  }
  return report;
}

// What only some riggers take is refused with others.
void checkRigger(const RigArguments& options, const RigPrograms& programs) {
  const bool isTemplate = !options.keepSkeleton && options.rig.rigger == "template";
  if (programs.rigger && options.rig.rig.handles) {
    throw CLI::ValidationError("--handles", "a program of yours makes as many joints as it does");
  }
  if (isTemplate && options.rig.rig.handles) {
    throw CLI::ValidationError("--handles", "a template has the joints that it has");
  }
  if (isTemplate) return;
  for (const auto& [option, isGiven] : {std::pair{"--pin", !options.pins.empty()},
                                        {"--up", !options.up.empty()},
                                        {"--front", !options.front.empty()},
                                        {"--upright", options.rig.standUpright},
                                        {"--chains", options.rig.chains}}) {
    if (isGiven) throw CLI::ValidationError(option, "takes a template to fit: --template NAME");
  }
}

void run(RigArguments options) {
  options.common.apply();
  checkOutput(options.output, {".glb", ".gltf"});
  if (!options.animation.frames.empty()) {
    return runAnimationRig(options.animation,
                           {options.output, options.report, options.rig.weights.maxInfluences, options.strict},
                           options.common);
  }
  if (options.input.empty()) throw CLI::RequiredError("IN");
  checkBeside("--json", options.report, {options.input, options.output, options.templateName});
  if (options.replaceRig) options.rig.existingRig = ExistingRig::kReplace;
  if (options.keepSkeleton) options.rig.existingRig = ExistingRig::kKeepSkeleton;
  chooseTemplate(options.templateName, options.rig);
  options.rig.rig.up = parseAxis(options.up, "--up");
  options.rig.rig.front = parseAxis(options.front, "--front");
  if (options.rig.rig.up && options.rig.rig.front && std::abs(options.rig.rig.up->dot(*options.rig.rig.front)) > 0.5) {
    throw CLI::ValidationError("--front", "must be square to --up");
  }
  for (const std::string& pin : options.pins) options.rig.rig.pins.push_back(parsePin(pin));
  const RigPrograms programs = findPrograms(options);
  checkRigger(options, programs);
  options.adapters.refuseUnused({options.rig.rigger, options.rig.skinning}, programs.rigger || programs.weights);
  options.rig.weights.pieces = findPieceMode(options.pieces);

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.input);
  AutoRigReport report = rigAsTold(asset, options.rig, programs, *progress);
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
  return listMethods("Riggers", riggerMethods()) + listNamed("Templates", namedTemplates()) +
         listMethods("Skinning methods", weightMethods()) + listNamed("Pieces", pieceModes()) +
         "\nPrograms of yours rig (--rigger NAME) and make weights (--skinning NAME), too: docs/adapters.md.\n"
         "\nReads GLB, glTF, OBJ, PLY, STL, OFF, FBX and DAE. The result appears under its name only when it is\n"
         "complete; a file of that name is replaced, also where it is the input.\n"
         "\nExamples:\n"
         "  limber rig dragon.glb --handles 20 -o rigged.glb\n"
         "  limber rig scan.obj --template humanoid --pin leftHand=0.71,1.43,0.02 -o character.glb\n"
         "  limber rig person.glb --keep-skeleton --max-influences 8 -o weighted.glb --json report.json\n"
         "  limber rig scan.obj --rigger unirig --seed 7 -o character.glb\n"
         "  limber rig --from-animation baked.glb --bones 30 -o rigged.glb\n"
         "  limber rig --from-animation frames/ --fps 24 -o rigged.glb\n"
         "  curl -s https://example.org/dragon.glb | limber rig - -o - > rigged.glb";
}

}  // namespace

void addRigCommand(CLI::App& program) {
  auto options = std::make_shared<RigArguments>();
  CLI::App* command = program.add_subcommand("rig", "Give a model handles and skin weights");
  command->add_option("IN", options->input, "the model; - is standard input");
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
  command
      ->add_option("--template", options->templateName,
                   "fit this named skeleton: auto, a name below, or a file with a skeleton (.glb, .bvh, .json, ...)")
      ->type_name("NAME");
  command
      ->add_option("--pin", options->pins,
                   "where a joint of the template must be, as JOINT=x,y,z in the file's space; several tell a pose")
      ->type_name("PIN")
      ->allow_extra_args(false);
  command->add_option("--up", options->up, "the model's up, for a template, as +y (default: found)")->type_name("AXIS");
  command->add_option("--front", options->front, "where the model looks, for a template, as +z (default: found)")
      ->type_name("AXIS");
  command->add_flag("--upright", options->rig.standUpright,
                    "turn a model that surely stands along another axis to stand along +Y");
  command->add_flag("--chains", options->rig.chains,
                    "give capes, scarves, braids and tails joints that swing (VRMC_springBone)");
  command->add_option("--skinning", options->rig.skinning, "how weights are made, see below")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--pieces", options->pieces, "how pieces that are joined to no other are bound, see below")
      ->type_name("NAME")
      ->capture_default_str();
  CLI::Option* animation = addAnimationRigOptions(*command, options->animation);
  for (const char* other : {"IN", "--handles", "--rigger", "--template", "--pin", "--up", "--front", "--upright",
                            "--chains", "--skinning", "--pieces"}) {
    animation->excludes(command->get_option(other));
  }
  CLI::Option* replace = command->add_flag("--replace-rig", options->replaceRig,
                                           "take the model's own rig and its joint animation out first");
  replace->excludes(animation);
  command->add_flag("--keep-skeleton", options->keepSkeleton, "keep the model's own skeleton, make its weights anew")
      ->excludes(replace)
      ->excludes(animation)
      ->excludes("--handles")
      ->excludes("--template");
  command
      ->add_option("--json", options->report,
                   "write a report: stages, seconds, counts, suggestions, warnings; - is standard output")
      ->type_name("FILE");
  command->add_flag("--strict", options->strict, "take warnings as errors");
  options->adapters.addTo(*command);
  options->common.addTo(*command);
  command->footer(rigHelp());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
