// limber sample: lists and writes models, motions and scenes that the project makes itself.
#include <fmt/format.h>

#include "command.h"
#include "limber/core/counted.h"
#include "limber/core/text/names.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/samples.h"
#include "limber/session/scene/scene.h"
#include "progress_line.h"
#include "sample_scenes.h"

namespace limber::cli {

namespace {

struct SampleArguments {
  std::string name, output;
  Common common;
};

enum class Kind { kModel, kMotion, kScene };

struct Sample {
  std::string_view name;
  std::string summary;
  Kind kind;
  std::string_view commands = {};  // of a scene
};

std::string summaryOf(const std::vector<Command>& scene) {
  const auto* first = scene.empty() ? nullptr : std::get_if<OpenSample>(&scene.front());
  return fmt::format("{}{}", first ? fmt::format("the model {}, ", first->name) : "", counted(scene.size(), "command"));
}

std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const SampleModel& sample : sampleModels())
    all.push_back({sample.name, std::string(sample.summary), Kind::kModel});
  for (const SampleMotion& sample : sampleMotions())
    all.push_back({sample.name, std::string(sample.summary), Kind::kMotion});
  for (const SampleScene& sample : sampleScenes()) {
    all.push_back({sample.name, summaryOf(commandsFromJson(sample.commands)), Kind::kScene, sample.commands});
  }
  return all;
}

std::string sampleList() {
  const std::vector<Sample> all = samples();
  std::string list;
  for (const auto& [kind, title] :
       {std::pair{Kind::kModel, "Models:\n"}, {Kind::kMotion, "\nMotions:\n"}, {Kind::kScene, "\nScenes:\n"}}) {
    list += title;
    for (const Sample& sample : all) {
      if (sample.kind == kind) list += fmt::format("  {:<18}{}\n", sample.name, sample.summary);
    }
  }
  return list;
}

void writeMotion(const Motion& motion, const std::string& output) {
  if (lowerExtension(output) == ".bvh") return writeFile(output, writeBvh(motion));
  writeAsset(motionAsset(motion), output);
}

// The final scene, or the recording of how it was made.
void writeScene(std::string_view commands, const std::string& output, Progress& progress) {
  if (lowerExtension(output) == ".json") return writeFile(output, asBytes(commands));
  SessionScene scene;
  for (const Command& command : commandsFromJson(commands)) scene.run(command, progress);
  progress.stage("write");
  writeFile(output, scene.exportModel(ExportFormat::kGlb));
}

void run(const SampleArguments& options) {
  options.common.apply();
  if (options.name.empty()) {
    fmt::print("{}", sampleList());
    return flushOutput();
  }
  const std::vector<Sample> all = samples();
  const Sample& sample = findByName(all, "sample", options.name);
  if (options.output.empty()) {
    throw CLI::ValidationError("--output", fmt::format("is missing: limber sample {} -o FILE", options.name));
  }
  switch (sample.kind) {
    case Kind::kModel:
      checkOutput(options.output, {".glb", ".gltf"});
      break;
    case Kind::kMotion:
      checkOutput(options.output, {".bvh", ".glb", ".gltf"});
      break;
    case Kind::kScene:
      checkOutput(options.output, {".glb", ".json"});
      break;
  }
  TerminalProgress progress(options.common.quiet);
  progress->stage("make");
  switch (sample.kind) {
    case Kind::kModel: {
      const Asset asset = makeSample(options.name);
      progress->stage("write");
      writeAsset(asset, options.output);
      break;
    }
    case Kind::kMotion:
      writeMotion(makeSampleMotion(options.name), options.output);
      break;
    case Kind::kScene:
      writeScene(sample.commands, options.output, *progress);
      break;
  }
  progress.finish();
  Account(options.common.quiet, options.output).line(fmt::format("{} -> {}", options.name, options.output));
}

std::string sampleHelp() {
  return sampleList() +
         "\nExamples:\n"
         "  limber sample quadruped -o fox.glb\n"
         "  limber sample biped -o person.glb\n"
         "  limber rig person.glb --template humanoid -o hero.glb\n"
         "  limber sample winged -o dragon.glb\n"
         "  limber rig dragon.glb --handles 20 -o rigged.glb\n"
         "  limber sample walk -o walk.bvh\n"
         "  limber sample run -o run.bvh\n"
         "  limber animate person.glb walk.bvh -o walking.glb\n"
         "  limber sample dancing-stool -o dancing.glb\n"
         "  limber sample stool -o stool.glb\n"
         "  limber sample quadruped-walk -o stool.bvh\n"
         "  limber animate stool.glb stool.bvh --template quadruped -o walking_stool.glb";
}

}  // namespace

void addSampleCommand(CLI::App& program) {
  auto options = std::make_shared<SampleArguments>();
  CLI::App* command =
      program.add_subcommand("sample", "List models, motions and scenes that limber makes itself, or write one");
  command->add_option("NAME", options->name, "which one; without a name they are listed");
  command
      ->add_option(
          "-o,--output", options->output,
          "the .glb or .gltf to write; of a motion the .bvh, too; of a scene the .glb, or the .json with its commands; "
          "- is standard output (GLB)")
      ->type_name("FILE");
  options->common.addTo(*command);
  command->footer(std::function(sampleHelp));  // made when it is read: it goes through the commands of all scenes
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
