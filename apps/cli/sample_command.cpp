// limber sample: writes a model that the project makes itself.
#include <fmt/format.h>

#include "command.h"
#include "limber/asset/write.h"
#include "limber/samples/samples.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct Options {
  std::string name, output;
  Common common;
};

void run(const Options& options) {
  options.common.apply();
  checkOutput(options.output, {".glb", ".gltf"});
  TerminalProgress progress(options.common.quiet);
  progress->stage("make");
  const Asset asset = makeSample(options.name);
  progress->stage("write");
  writeAsset(asset, options.output);
  progress.finish();
  Account(options.common.quiet, options.output).line(fmt::format("{} -> {}", options.name, options.output));
}

std::string help() {
  std::string text = "Samples:\n";
  for (const SampleModel& sample : sampleModels()) text += fmt::format("  {:<12}{}\n", sample.name, sample.summary);
  return text + "\nExample:\n  limber sample quadruped -o fox.glb";
}

}  // namespace

void addSampleCommand(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("sample", "Write a model that limber makes itself");
  command->add_option("NAME", options->name, "which model, see below")->required();
  command->add_option("-o,--output", options->output, "the .glb or .gltf to write; - is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  options->common.addTo(*command);
  command->footer(help());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
