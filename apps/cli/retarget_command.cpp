// limber retarget and limber animate: motions onto a character.
#include <fmt/format.h>

#include "adapter_arguments.h"
#include "characters_arguments.h"
#include "clip_arguments.h"
#include "combine_arguments.h"
#include "command.h"
#include "limber/actions/export/write_model.h"
#include "limber/actions/motion/retarget_asset.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/actions/rig/stand_upright.h"
#include "limber/adapters/retarget_by_program.h"
#include "limber/core/counted.h"
#include "limber/core/file/file.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "limber/rigging/template_rigger.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "motion_arguments.h"
#include "progress_line.h"
#include "target_arguments.h"

namespace limber::cli {

namespace {

struct RetargetArguments {
  std::string model, output, mapFile, saveMapFile, rootScale = "hip-height", rigger = "template", templateName = "auto";
  std::vector<std::string> motions;
  RetargetAssetOptions retarget;
  double frameRate = 0, ground = 0;
  bool noContacts = false, noSmoothing = false, hasGround = false;
  const CLI::App* command = nullptr;
  AdapterArguments adapters;
  MotionArguments motionFiles;
  ClipArguments clipEdits;
  TargetArguments target;
  std::optional<Adapter> program;  // of the user's, instead of a method of limber's
  CharactersArguments characters;
  CombineArguments combineArguments;
  std::optional<CombineOptions> combine;
  Common common;
};

RootScale rootScaleOf(const std::string& name) {
  if (name == "leg-length") return RootScale::kLegLength;
  return name == "none" ? RootScale::kNone : RootScale::kHipHeight;
}

Bytes readMap(const RetargetArguments& options) {
  try {
    return readFile(options.mapFile);
  } catch (const Error& error) {
    if (options.mapFile != options.saveMapFile) throw;
    throw Error(error.code(), error.message(), error.where(), "leave --map out the first time: --save-map writes it");
  }
}

std::optional<Adapter> findProgram(const RetargetArguments& options) {
  std::vector<std::string> known;
  for (const RetargetMethod& method : retargetMethods()) known.emplace_back(method.name);
  std::optional<Adapter> program =
      options.adapters.programFor(options.retarget.method, "retargeting method", AdapterKind::kRetarget, known);
  for (const char* option : {"--map", "--save-map", "--unlike-bodies", "--root-scale", "--reach", "--solver",
                             "--no-contacts", "--no-smoothing", "--ground"}) {
    if (program && options.command->count(option) > 0) {
      throw CLI::ValidationError(option, "is for limber's own methods; a program of yours decides for itself");
    }
  }
  options.adapters.refuseUnused({options.retarget.method}, program.has_value());
  if (!program && options.command->count("--solver") > 0 && !findRetargetMethod(options.retarget.method).usesSolver) {
    throw CLI::ValidationError("--solver", fmt::format("has no effect with --method {}; it is for {}",
                                                       options.retarget.method, retargetMethodsWithSolver()));
  }
  return program;
}

void prepare(RetargetArguments& options) {
  options.common.apply();
  if (!options.characters.isGiven()) checkOutput(options.output, modelExtensions());
  options.clipEdits.check();
  options.target.check();
  std::vector<std::string> others = options.motions;
  others.insert(others.end(), {options.model, options.output});
  checkBeside("--save-map", options.saveMapFile, others);
  options.program = findProgram(options);
  options.combine = options.combineArguments.options(options.motions.size(), options.program.has_value());
  findIkMethod(options.retarget.retarget.solver);
  options.retarget.retarget.rootScale = rootScaleOf(options.rootScale);
  options.retarget.retarget.contacts = !options.noContacts;
  options.retarget.retarget.smoothMotion = !options.noSmoothing;
  if (options.frameRate > 0) options.retarget.frameRate = options.frameRate;
  if (options.hasGround) options.retarget.retarget.sourceGround = options.ground;
  if (!options.mapFile.empty()) {
    const Bytes text = readMap(options);
    options.retarget.mapJson.emplace(text.begin(), text.end());
  }
}

std::vector<RetargetedClip> addCombined(Asset& asset, const Character& character, const RetargetArguments& options,
                                        const RetargetAssetOptions& retarget, Progress& progress, Warnings& warnings) {
  progress.stage("retarget");
  const MotionOptions reading = options.motionFiles.options();
  std::vector<Motion> motions;
  for (const std::string& file : options.motions) {
    motions.push_back(readMotion(file, reading));
    warnings.append(motions.back().warnings);
  }
  asset.warnings = {};
  std::vector<RetargetedClip> clips = combineOnto(asset, character, motions, retarget, *options.combine);
  warnings.append(asset.warnings);
  return clips;
}

// Adds all motions' clips; the map that is saved is that of the first motion.
std::vector<RetargetedClip> addMotions(Asset& asset, const Character& character, const RetargetArguments& options,
                                       Progress& progress, Warnings& warnings) {
  SkeletonMatches matches;  // motions mostly have one skeleton
  RetargetAssetOptions retarget = options.retarget;
  retarget.matches = &matches;
  if (options.combine) return addCombined(asset, character, options, retarget, progress, warnings);
  std::vector<RetargetedClip> clips;
  const MotionOptions reading = options.motionFiles.options();
  for (std::size_t i = 0; i < options.motions.size(); ++i) {
    progress.stage("retarget");
    const std::string& file = options.motions[i];
    const Motion motion = readMotion(file, reading);
    warnings.append(motion.warnings);
    try {
      ProgramClips made;
      if (options.program) {
        made = retargetByProgram(asset, character, motion, *options.program, retarget, progress);
        warnings.append(made.warnings);
      } else {
        asset.warnings = {};
        made.clips = retargetOnto(asset, character, motion, retarget);
        warnings.append(asset.warnings);
      }
      for (RetargetedClip& clip : made.clips) clips.push_back(std::move(clip));
    } catch (const Error& error) {
      throw error.within(options.retarget.mapJson ? file + ": " + options.mapFile : file);
    }
  }
  return clips;
}

std::vector<ClipEditReport> edit(Asset& asset, const Character& character, const RetargetArguments& options,
                                 const std::vector<RetargetedClip>& clips, Warnings& warnings) {
  std::vector<std::string> names;
  for (const RetargetedClip& clip : clips) names.push_back(clip.name);
  asset.warnings = {};
  std::vector<ClipEditReport> reports = editClips(asset, names, options.clipEdits.edits, character.reading());
  warnings.append(asset.warnings);
  return reports;
}

void tell(const RetargetArguments& options, const std::vector<RetargetedClip>& clips,
          const std::vector<ClipEditReport>& edits, const Warnings& warnings) {
  const Account account(options.common.quiet, options.output);
  for (const RetargetedClip& clip : clips) {
    account.line(fmt::format(
        "{:<24} {} at {:g} a second, {}", clip.name, counted(clip.frames, "frame"), clip.framesPerSecond,
        options.program ? "by " + options.program->name : counted(clip.map.matches.size(), "part") + " matched"));
  }
  options.clipEdits.tell(edits, account);
  if (!clips.empty() && !clips.front().doubtful.empty()) {
    account.line("matches to look at (--save-map writes them all, --map reads them again):");
    for (const std::string& line : clips.front().doubtful) account.line("  " + line);
  }
  printWarnings(warnings, options.common.quiet);
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

void write(const Asset& asset, const Character& character, const RetargetArguments& options,
           const std::vector<RetargetedClip>& clips, Warnings& warnings) {
  std::vector<OutputFile> companions;
  if (!options.saveMapFile.empty()) companions.push_back({options.saveMapFile, asBytes(clips.front().mapJson)});
  WriteModelOptions write;
  write.reading = character.reading();
  write.target = options.target.target;
  if (holdsOneClip(options.output) && !clips.empty()) write.clip = clips.front().name;
  write.companions = companions;
  warnings.append(writeModel(asset, options.output, write));
}

// Then the first file is a motion, too.
void runCharacters(RetargetArguments options) {
  for (const char* option : {"--save-map", "--blend", "--crossfade", "--sequence"}) {
    if (options.command->count(option) > 0) throw CLI::ValidationError(option, "is for one character");
  }
  if (options.model.empty()) throw CLI::RequiredError("MOTIONS");
  options.motions.insert(options.motions.begin(), options.model);
  prepare(options);
  if (options.program) throw CLI::ValidationError("--method", "programs of yours retarget one character at a time");
  CharactersJob job = options.characters.job();
  const MotionOptions reading = options.motionFiles.options();
  for (const std::string& file : options.motions) job.motions.push_back(readMotion(file, reading));
  job.folder = options.output;
  job.retarget = options.retarget;
  job.edits = options.clipEdits.edits;
  job.write.target = options.target.target;
  options.characters.run(job, options.common.quiet);
}

void runRetarget(RetargetArguments options) {
  if (options.characters.isGiven()) return runCharacters(std::move(options));
  if (options.model.empty()) throw CLI::RequiredError("MODEL");
  if (options.motions.empty()) throw CLI::RequiredError("MOTIONS");
  prepare(options);
  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.model);
  if (!canMove(asset)) {
    throw Error(ErrorCode::kBadArgument, "the model has no rig to move", asset.name, "limber animate rigs it first");
  }
  Warnings warnings = asset.warnings;
  const UprightCharacter upright = standUpright(asset, warnings);
  options.retarget.turn = upright.turn;
  const std::vector<RetargetedClip> clips = addMotions(asset, upright.character, options, *progress, warnings);
  const std::vector<ClipEditReport> edits = edit(asset, upright.character, options, clips, warnings);
  progress->stage("write");
  write(asset, upright.character, options, clips, warnings);
  progress.finish();
  tell(options, clips, edits, warnings);
}

// What to do where a motion does not fit the rig that was made.
std::string remedyFor(const std::vector<TemplateMatch>& matches) {
  if (matches.empty()) return "--rigger template gives joints names that motions know; or match by --map";
  const TemplateMatch& best = matches.front();
  if (best.confidence > kLikelyTemplate) {
    return fmt::format("the model was rigged as {}, {:.0f} % sure: take a motion of such a body, or match by --map",
                       best.name, 100 * best.confidence);
  }
  return "the model hardly looks like any template: turn it to stand upright with its arms away from the body, or "
         "match by --map";
}

// Handles have no names that motions know.
[[noreturn]] void refuseAbstained(const Asset& asset, const AutoRigReport& report) {
  const TemplateMatch& likeliest = report.matches.front();
  throw Error(
      ErrorCode::kUnsupported,
      fmt::format("the model is like no template (the likeliest, {}, is {:.0f} % sure)", likeliest.name,
                  100 * likeliest.confidence),
      asset.name,
      fmt::format("--template {} takes that one all the same; limber rig --pin corrects joints", likeliest.name));
}

void runAnimate(RetargetArguments options) {
  prepare(options);
  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.model);
  Warnings warnings = asset.warnings;
  std::vector<TemplateMatch> matches;
  const bool rigged = canMove(asset);
  std::optional<Character> character;
  if (rigged) {
    UprightCharacter upright = standUpright(asset, warnings);
    options.retarget.turn = upright.turn;
    character = std::move(upright.character);
  } else {
    AutoRigOptions rig;
    rig.rigger = options.rigger;
    rig.standUpright = true;
    rig.rig.templateName = options.templateName;
    checkTemplateName(options.templateName);
    AutoRigReport report = autoRig(asset, rig, *progress);
    if (report.isAbstained) refuseAbstained(asset, report);
    warnings = std::move(report.warnings);
    matches = std::move(report.matches);
    character.emplace(asset);
  }
  std::vector<RetargetedClip> clips;
  try {
    clips = addMotions(asset, *character, options, *progress, warnings);
  } catch (const Error& error) {
    if (rigged || error.code() != ErrorCode::kUnsupported) throw;
    throw Error(error.code(), error.message(), error.where(), remedyFor(matches));
  }
  const std::vector<ClipEditReport> edits = edit(asset, *character, options, clips, warnings);
  progress->stage("write");
  write(asset, *character, options, clips, warnings);
  progress.finish();
  tell(options, clips, edits, warnings);
}

std::string retargetHelp(const char* examples) {
  std::string text = "Methods:\n";
  for (const RetargetMethod& method : retargetMethods())
    text += fmt::format("  {:<12}{}\n", method.name, method.summary);
  text += "\nPrograms of yours retarget (--method NAME), too: docs/adapters.md.\n";
  return text + TargetArguments::list() +
         "\nMotions: .bvh, .npz in SMPL's form (docs/motion-files.md), and .glb, .gltf, .vrma, .fbx and .dae with "
         "animations.\ndocs/retargeting.md tells more, docs/combining.md of --blend, --crossfade and --sequence.\n" +
         "\nExamples:\n" + examples;
}

void addOptions(CLI::App& command, const std::shared_ptr<RetargetArguments>& options) {
  RetargetOptions& retarget = options->retarget.retarget;
  command.add_option("MOTIONS", options->motions, "files with motions; each becomes a clip named after it")->required();
  command.add_option("-o,--output", options->output, modelOutputHelp())->required()->type_name("FILE");
  command.add_option("--method", options->retarget.method, "see below")->type_name("NAME")->capture_default_str();
  command.add_option("--map", options->mapFile, "which joints follow which, in JSON (docs/skeleton_map.schema.json)")
      ->type_name("FILE");
  command.add_option("--save-map", options->saveMapFile, "write that map, to correct and use again")
      ->check(notForPlans())
      ->type_name("FILE");
  command.add_flag("--unlike-bodies", options->retarget.unlikeBodies,
                   "let limbs without a partner follow others from front to back: forelegs or wings follow arms");
  command
      .add_option("--skeleton", options->retarget.body,
                  "which body of a motion of several: the name of its root joint, or its number from 1")
      ->type_name("JOINT");
  command.add_option("--fps", options->frameRate, "frames a second of the clips (default: each motion's own)")
      ->check(numberIn(1, 1000))
      ->type_name("N");
  command.add_option("--root-scale", options->rootScale, "how far the character goes for a metre of the motion")
      ->check(CLI::IsMember({"hip-height", "leg-length", "none"}))
      ->type_name("WHAT")
      ->capture_default_str();
  command
      .add_option("--reach", retarget.reach,
                  "positions of hands: 0 as the arms' rotations give them, 1 as in the motion, scaled to the body")
      ->check(numberIn(0, 1))
      ->type_name("D")
      ->capture_default_str();
  command
      .add_option(
          "--solver", retarget.solver,
          fmt::format("how limbs reach, with {}; limber pose --help lists the solvers", retargetMethodsWithSolver()))
      ->type_name("NAME")
      ->capture_default_str();
  command.add_flag("--no-contacts", options->noContacts,
                   "let feet slide, hands miss what they touched and arms enter the body");
  command.add_flag("--no-smoothing", options->noSmoothing, "do not smooth a result that is rougher than the motion");
  command
      .add_option_function<double>(
          "--ground",
          [options](double height) {
            options->ground = height;
            options->hasGround = true;
          },
          "height of the ground in the motion, in its unit (default: measured)")
      ->check(numberIn(-1e9, 1e9))
      ->type_name("Y");
  options->motionFiles.addTo(command);
  options->command = &command;
  options->clipEdits.addTo(command);
  options->combineArguments.addTo(command);
  options->target.addTo(command);
  options->adapters.addTo(command);
  options->common.addTo(command);
}

}  // namespace

void addRetargetCommand(CLI::App& program) {
  auto options = std::make_shared<RetargetArguments>();
  CLI::App* command = program.add_subcommand("retarget", "Put motions onto a rigged character");
  command->add_option("MODEL", options->model, "the rigged model, or a skeleton alone, such as a .bvh");
  addOptions(*command, options);
  command->get_option("MOTIONS")->required(false);  // MODEL is the first of them with --characters: looked at later
  options->characters.addTo(*command);
  command->footer(
      retargetHelp("  limber retarget hero.glb walk.bvh run.bvh -o hero_all.glb\n"
                   "  limber retarget hero.glb run.bvh -o running.glb --save-map map.json\n"
                   "  limber retarget hero.glb walk.bvh run.bvh --blend 0.4 -o jogging.glb\n"
                   "  echo hero.glb > heroes.txt\n"
                   "  limber retarget --characters heroes.txt walk.bvh run.bvh -o out"));
  command->callback([options] { runRetarget(*options); });
}

void addAnimateCommand(CLI::App& program) {
  auto options = std::make_shared<RetargetArguments>();
  CLI::App* command = program.add_subcommand("animate", "Let any model move: rig it if it has no rig, then retarget");
  command->add_option("MODEL", options->model, "the model, rigged or not")->required();
  addOptions(*command, options);
  command->add_option("--rigger", options->rigger, "how a model without a rig gets one; limber rig --help lists them")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--template", options->templateName, "which skeleton: auto, or one by name, however unsure")
      ->type_name("NAME")
      ->capture_default_str();
  command->footer(
      retargetHelp("  limber animate person.glb walk.bvh -o walking.glb\n"
                   "  limber animate person.glb walk.bvh --target unity -o walking.fbx"));
  command->callback([options] { runAnimate(*options); });
}

}  // namespace limber::cli
