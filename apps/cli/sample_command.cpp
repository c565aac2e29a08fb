// limber sample: writes a model or a motion that the project makes itself.
#include <fmt/format.h>

#include "command.h"
#include "limber/asset/bvh_write.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/write.h"
#include "limber/core/names.h"
#include "limber/samples/sample_motions.h"
#include "limber/samples/samples.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct SampleArguments {
  std::string name, output;
  Common common;
};

struct Sample {
  std::string_view name, summary;
  bool moves;
};

std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const SampleModel& sample : sampleModels()) all.push_back({sample.name, sample.summary, false});
  for (const SampleMotion& sample : sampleMotions()) all.push_back({sample.name, sample.summary, true});
  return all;
}

void writeMotion(const Motion& motion, const std::string& output) {
  if (lowerExtension(output) == ".bvh") return writeFile(output, writeBvh(motion));
  writeAsset(motionAsset(motion), output);
}

void run(const SampleArguments& options) {
  options.common.apply();
  const std::vector<Sample> all = samples();
  const bool moves = findByName(all, "sample", options.name).moves;
  if (moves) {
    checkOutput(options.output, {".bvh", ".glb", ".gltf"});
  } else {
    checkOutput(options.output, {".glb", ".gltf"});
  }
  TerminalProgress progress(options.common.quiet);
  progress->stage("make");
  if (moves) {
    writeMotion(makeSampleMotion(options.name), options.output);
  } else {
    const Asset asset = makeSample(options.name);
    progress->stage("write");
    writeAsset(asset, options.output);
  }
  progress.finish();
  Account(options.common.quiet, options.output).line(fmt::format("{} -> {}", options.name, options.output));
}

std::string sampleHelp() {
  std::string models = "Models:\n", motions = "\nMotions:\n";
  for (const Sample& sample : samples()) {
    (sample.moves ? motions : models) += fmt::format("  {:<16}{}\n", sample.name, sample.summary);
  }
  return models + motions +
         "\nExamples:\n"
         "  limber sample quadruped -o fox.glb\n"
         "  limber sample biped -o person.glb\n"
         "  limber sample walk -o walk.bvh\n"
         "  limber animate person.glb walk.bvh -o walking.glb";
}

}  // namespace

void addSampleCommand(CLI::App& program) {
  auto options = std::make_shared<SampleArguments>();
  CLI::App* command = program.add_subcommand("sample", "Write a model or a motion that limber makes itself");
  command->add_option("NAME", options->name, "which one, see below")->required();
  command
      ->add_option("-o,--output", options->output,
                   "the .glb or .gltf to write, of a motion the .bvh, too; - is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  options->common.addTo(*command);
  command->footer(sampleHelp());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
