// limber preview: a picture of a model or its rig.
#include <fmt/format.h>

#include "command.h"
#include "limber/asset/read.h"
#include "limber/core/file.h"
#include "limber/preview/render.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct Options {
  std::string input, output, show = "model", size = "1024x768", view = "three-quarter", joint;
  Common common;
};

void parseSize(const std::string& text, PreviewOptions& options) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &options.width, &options.height, &rest) != 2) {
    throw Error(ErrorCode::kBadArgument, "\"" + text + "\" is no size of a picture", "",
                "write it as width x height in pixels, such as 1024x768");
  }
}

void run(const Options& options) {
  options.common.apply();
  checkOutput(options.output, {".png"});
  PreviewOptions preview;
  preview.show = parsePreviewShow(options.show);
  preview.view = parseView(options.view);
  preview.joint = options.joint;
  parseSize(options.size, preview);
  if (!options.joint.empty()) preview.show = PreviewShow::kWeights;

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  const Asset asset = readAsset(options.input);
  progress->stage("draw");
  const Scene scene = makeScene(asset);
  const Bytes png = encodePng(render(scene, preview));
  progress->stage("write");
  writeFile(options.output, png);
  progress.finish();
  printWarnings(scene.warnings, options.common.quiet);
  Account(options.common.quiet, options.output).line(fmt::format("written: {}", options.output));
}

}  // namespace

void addPreviewCommand(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("preview", "Draw a picture of a model, its handles, bones or weights");
  command->add_option("FILE", options->input, "the model; - is standard input")->required();
  command->add_option("-o,--output", options->output, "the .png to write; - is standard output")
      ->required()
      ->type_name("FILE");
  command->add_option("--show", options->show, "model, handles, weights or bones")
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_option("--view", options->view, "front, side, back, top, three-quarter, or azimuth,elevation in degrees")
      ->type_name("VIEW")
      ->capture_default_str();
  command->add_option("--size", options->size, "width and height in pixels")->type_name("WxH")->capture_default_str();
  command->add_option("--joint", options->joint, "the weight of this joint alone, from blue (none) to red (all)")
      ->type_name("NAME");
  options->common.addTo(*command);
  command->footer("Example:\n  limber preview rigged.glb --show handles --view 30,15 -o handles.png");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
