// limber crowd: many bodies of differing builds in one file, each with its own clip, time offset and position.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "command.h"
#include "limber/actions/export/write_model.h"
#include "limber/core/counted.h"
#include "limber/core/file/folder.h"
#include "limber/crowd/crowd.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "motion_arguments.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct CrowdArguments {
  std::vector<std::string> characters, motions;
  std::string output, builds;
  double spacing = 0;
  CrowdOptions crowd;
  MotionArguments motionFiles;
  Common common;
};

void writeBuilds(const Crowd& crowd, const std::filesystem::path& folder) {
  makeFolder(folder);
  for (std::size_t b = 0; b < crowd.builds.size(); ++b) {
    writeModel(crowd.builds[b], folder / fmt::format("build_{}.glb", b + 1));
  }
}

void runCrowd(CrowdArguments arguments) {
  arguments.common.apply();
  checkOutput(arguments.output, {".glb", ".gltf"});
  if (arguments.spacing > 0) arguments.crowd.spacing = arguments.spacing;
  TerminalProgress progress(arguments.common.quiet);
  progress->stage("read");
  std::vector<Asset> characters;
  for (const std::string& file : arguments.characters) characters.push_back(readAsset(file));
  const MotionOptions reading = arguments.motionFiles.options();
  std::vector<Motion> motions;
  Warnings warnings;
  for (const std::string& file : arguments.motions) {
    motions.push_back(readMotion(file, reading));
    warnings.append(motions.back().warnings);
  }
  Crowd crowd = makeCrowd(characters, motions, arguments.crowd, *progress);
  progress->stage("write");
  warnings.append(crowd.asset.warnings);
  if (!arguments.builds.empty()) writeBuilds(crowd, arguments.builds);
  warnings.append(writeModel(crowd.asset, arguments.output));
  progress.finish();
  const Account account(arguments.common.quiet, arguments.output);
  account.line(fmt::format("{} of {}, {}, {:g} s", counted(crowd.bodies.size(), "body", "bodies"),
                           counted(crowd.builds.size(), "build"), counted(crowd.clips.size(), "clip"), crowd.seconds));
  printWarnings(warnings, arguments.common.quiet);
  if (arguments.output != "-") account.line(fmt::format("written: {}", arguments.output));
}

void addCrowdOptions(CLI::App& command, const std::shared_ptr<CrowdArguments>& arguments) {
  CrowdOptions& crowd = arguments->crowd;
  command.add_option("--count", crowd.bodies, "how many bodies")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--builds", crowd.builds, "how many builds they have, of all characters; no more than bodies")
      ->check(CLI::Range(1, 10000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--variety", crowd.variety, "how much builds differ: 0 not at all, 1 as adults do")
      ->check(numberIn(0, 1))
      ->type_name("D")
      ->capture_default_str();
  command.add_option("--offsets", crowd.offsets, "at how many moments of its cycle a body may begin")
      ->check(CLI::Range(1, 10000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", crowd.seed, "of builds, clips, offsets and places")
      ->check(seedNumber())
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--fps", crowd.framesPerSecond, "keys a second")
      ->check(numberIn(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--spacing", arguments->spacing, "metres from body to body (default: 1.25 times the widest of them)")
      ->check(numberIn(1e-3, 1e6))
      ->type_name("M");
  command.add_option("--turn", crowd.heading, "degrees by which a body may face aside, to either side")
      ->check(numberIn(0, 180))
      ->type_name("DEG")
      ->capture_default_str();
  command
      .add_option("--skeleton", crowd.retarget.body,
                  "which body of a motion of several: the name of its root joint, or its number from 1")
      ->type_name("JOINT");
  command.add_flag("--unlike-bodies", crowd.retarget.unlikeBodies,
                   "let limbs without a partner follow others from front to back: forelegs or wings follow arms");
  command.add_flag("--loop", crowd.edits.loop, "cut each clip to its best loop, where it has one, and join the ends");
  command.add_flag("--in-place", crowd.edits.inPlace, "walk on the spot: without the body's travel");
}

}  // namespace

void addCrowdCommand(CLI::App& program) {
  auto arguments = std::make_shared<CrowdArguments>();
  CLI::App* command = program.add_subcommand("crowd", "One file with many bodies of differing builds, all in motion");
  command->add_option("CHARACTERS", arguments->characters, "rigged models, each for a body before one has two")
      ->required();
  command->add_option("--motions", arguments->motions, "files with motions, each for a body before one has two")
      ->required()
      ->type_name("FILE...");
  command->add_option("-o,--output", arguments->output, "the .glb or .gltf to write; - is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  addCrowdOptions(*command, arguments);
  command->add_option("--save-builds", arguments->builds, "write the builds one by one, too: build_1.glb, ...")
      ->type_name("FOLDER");
  arguments->motionFiles.addTo(*command);
  arguments->common.addTo(*command);
  command->footer(
      "Where there are fewer bodies than characters or clips, some are left out, and a warning names them.\n"
      "Clips are repeated from the moment at which each body begins, so they should be loops (--loop).\n"
      "docs/crowds.md tells more.\n"
      "\nExamples:\n"
      "  limber crowd hero.glb --motions walk.bvh --count 100 --in-place -o crowd.glb\n"
      "  limber rig person.glb --template humanoid-fingers -o person_rigged.glb\n"
      "  limber crowd hero.glb person_rigged.glb --motions walk.bvh run.bvh --count 40 --turn 60 -o crowd.glb");
  command->callback([arguments] { runCrowd(*arguments); });
}

}  // namespace limber::cli
