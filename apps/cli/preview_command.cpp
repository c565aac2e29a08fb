// limber preview: a picture of a model, its rig or its movement.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "command.h"
#include "deformer_list.h"
#include "limber/character/character.h"
#include "limber/core/file/file.h"
#include "limber/deform/deformer.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "limber/evaluate/skin/range_of_motion.h"
#include "limber/evaluate/skin/surface_stretch.h"
#include "limber/preview/animation.h"
#include "limber/preview/image/apng.h"
#include "limber/preview/render.h"
#include "part_arguments.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct PreviewArguments {
  std::string input, output, show = "model", size, view = "three-quarter", joint, clip, deformer = "linear-blend";
  std::optional<double> time;  // seconds
  int frames = 0;              // of a contact sheet; 0: one picture
  int worst = 0;               // poses of a range of motion; 0: all
  bool animate = false, turntable = false, rest = false;
  std::optional<double> fps;  // of an animation or a turntable
  std::string background = "studio";
  PartArguments parts;
  Common common;
};

void parseSize(const std::string& text, PreviewOptions& options) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &options.width, &options.height, &rest) != 2) {
    throw Error(ErrorCode::kBadArgument, "\"" + text + "\" is no size of a picture", "",
                "write it as width x height in pixels, such as 1024x768");
  }
}

constexpr double kTurnSeconds = 4;  // of a turntable's full rotation
constexpr double kUsualFps = 20;

bool showsClip(const PreviewArguments& options) {
  return options.animate || options.frames > 0 || options.time || !options.clip.empty();
}

// A rigged file with clips, such as limber animate writes, begins with the first of them: the rest pose would show
// nothing of what was done. One in which limber pose has saved another pose shows that.
bool beginsWithClip(const Asset& asset, const SceneMaker& scenes) {
  return !asset.document.skins.empty() && !asset.document.animations.empty() && scenes.isAtRest();
}

std::vector<double> momentsOf(const PreviewArguments& options, double duration) {
  if (options.animate) {
    constexpr double kMaxFrames = 1000;
    const double count = std::round(duration * options.fps.value_or(kUsualFps));
    if (count > kMaxFrames) {
      throw Error(ErrorCode::kLimit, fmt::format("the animation would have {:.0f} pictures", count), "",
                  fmt::format("{:.0f} are the most: choose a smaller --fps, or cut the clip by limber convert --trim",
                              kMaxFrames));
    }
    return clipMoments(duration, std::max(1, static_cast<int>(count)), false);
  }
  if (options.frames > 0) return clipMoments(duration, options.frames, true);
  return {options.time.value_or(0)};
}

// About twice as many as rows, with as few cells left empty as that allows.
int sheetColumns(int count) {
  const int widest = static_cast<int>(std::ceil(std::sqrt(2.0 * count))), rows = (count + widest - 1) / widest;
  return (count + rows - 1) / rows;
}

// All pictures are in memory at once.
void checkPixels(std::size_t pictures, const PreviewOptions& preview) {
  constexpr double kMax = 134217728;  // 400 megabytes
  const double pixels = static_cast<double>(preview.width) * preview.height * static_cast<double>(pictures);
  if (pixels <= kMax) return;
  throw Error(ErrorCode::kLimit,
              fmt::format("{} pictures of {} x {} pixels are too many", pictures, preview.width, preview.height), "",
              fmt::format("{:.0f} megapixels are the most: choose a smaller --size, or fewer pictures", kMax / 1e6));
}

// A picture of a moment, a sheet of several, or an animation.
Bytes clipPicture(const Asset& asset, const SceneMaker& scenes, const PreviewArguments& options,
                  const PreviewOptions& preview, Progress& progress, Warnings& warnings) {
  const Clip clip = findClip(asset, options.clip);
  const std::vector<double> moments = momentsOf(options, scenes.duration(clip));
  checkPixels(moments.size(), preview);
  const std::vector<Image> images = renderClip(scenes, clip, moments, preview, progress, warnings);
  if (options.animate) return encodeApng(images, options.fps.value_or(kUsualFps));
  return encodePng(contactSheet(images, sheetColumns(static_cast<int>(images.size())), renderBackdrop(preview)));
}

Bytes turntable(const Asset& asset, const SceneMaker& scenes, const PreviewArguments& options,
                const PreviewOptions& preview, Progress& progress, Warnings& warnings) {
  const Scene scene =
      showsClip(options) ? scenes.at(findClip(asset, options.clip), options.time.value_or(0)) : scenes.still();
  warnings = scene.warnings;
  const double fps = options.fps.value_or(kUsualFps);
  const int count = std::max(1, static_cast<int>(std::lround(kTurnSeconds * fps)));
  checkPixels(static_cast<std::size_t>(count), preview);
  return encodeApng(renderTurn(scene, preview, count, progress), fps);
}

// In their order the `count` poses that stretch the surface the most by linear blending, so that deformers are shown in
// the same ones.
std::vector<RangeOfMotionPose> worstOf(std::vector<RangeOfMotionPose> range, std::size_t count,
                                       const Character& character) {
  if (range.size() <= count) return range;
  const SceneMaker scenes(character);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < range.size(); ++i) {
    const Scene scene = scenes.at(range[i].pose);
    order.emplace_back(-surfaceStretch(scene.boundPositions, scene.positions, scene.triangles).mean, i);
  }
  std::sort(order.begin(), order.end());
  order.resize(count);
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<RangeOfMotionPose> worst;
  for (const auto& [stretch, index] : order) worst.push_back(std::move(range[index]));
  return worst;
}

// A sheet of a range of motion test, whatever clips there are.
Bytes rangePicture(const Character& character, const SceneMaker& scenes, int worst, const PreviewOptions& preview,
                   Warnings& warnings) {
  const Asset& asset = character.document();
  if (!character.hasRig()) {
    throw Error(ErrorCode::kUnsupported, "has no rig by which it could be stretched", asset.name,
                "make one with limber rig");
  }
  std::vector<RangeOfMotionPose> range = rangeOfMotion(character.skeleton(), character.anatomy());
  if (range.empty()) {
    throw Error(ErrorCode::kUnsupported, "has no part of a body that could be bent", asset.name,
                "name a clip by --clip, and --time or --frames");
  }
  if (worst > 0) range = worstOf(std::move(range), static_cast<std::size_t>(worst), character);
  checkPixels(range.size(), preview);
  std::vector<Image> images;
  for (const RangeOfMotionPose& one : range) {
    const Scene scene = scenes.at(one.pose);
    if (images.empty()) warnings = scene.warnings;
    images.push_back(render(scene, preview));
  }
  return encodePng(contactSheet(images, sheetColumns(static_cast<int>(images.size())), renderBackdrop(preview)));
}

Bytes stillPicture(const SceneMaker& scenes, const PreviewOptions& preview, Warnings& warnings) {
  const Scene scene = scenes.still();
  warnings = scene.warnings;
  return encodePng(render(scene, preview));
}

void run(PreviewArguments options) {
  options.common.apply();
  checkOutput(options.output, {".png"});
  if (options.fps && !options.animate && !options.turntable) {
    throw Error(ErrorCode::kBadArgument, "--fps is for moving pictures", "", "add --animate or --turntable");
  }
  const Deformer& deformer = findDeformer(options.deformer);
  PreviewOptions preview;
  preview.show = options.joint.empty() ? parsePreviewShow(options.show) : PreviewShow::kWeights;
  preview.view = parseView(options.view);
  preview.joint = options.joint;
  preview.backdrop = parseBackdrop(options.background);
  const bool isRange = preview.show == PreviewShow::kStretch && !showsClip(options) && !options.turntable;
  if (options.worst > 0 && !isRange) {
    throw Error(ErrorCode::kBadArgument, "--worst is for a range of motion", "", "add --show stretch, and no clip");
  }
  const bool several = options.animate || options.turntable || options.frames > 0 || isRange;
  if (options.size.empty()) options.size = several ? "320x320" : "1024x768";
  parseSize(options.size, preview);
  if (options.parts.given() && preview.show != PreviewShow::kParts) {
    throw Error(ErrorCode::kBadArgument, "--by, --detail and --count are for parts", "", "add --show parts");
  }

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  const Character character(readAsset(options.input));
  const Asset& asset = character.document();
  if (preview.show == PreviewShow::kParts) {
    progress->stage("parts");
    preview.partOf = modelParts(character, options.parts.options(), *progress).partOf;
  }
  progress->stage("draw");
  Warnings warnings;
  const auto draw = [&] {
    const SceneMaker scenes(character, deformer);
    const bool isAsked = options.rest || isRange || showsClip(options);
    if (!isAsked && beginsWithClip(asset, scenes)) options.time = 0;
    if (options.turntable) return turntable(asset, scenes, options, preview, *progress, warnings);
    if (showsClip(options)) return clipPicture(asset, scenes, options, preview, *progress, warnings);
    if (isRange) return rangePicture(character, scenes, options.worst, preview, warnings);
    return stillPicture(scenes, preview, warnings);
  };
  const Bytes png = draw();
  progress->stage("write");
  writeFile(options.output, png);
  progress.finish();
  Warnings all = asset.warnings;
  all.append(warnings);
  printWarnings(all, options.common.quiet);
  Account(options.common.quiet, options.output).line(fmt::format("written: {}", options.output));
}

}  // namespace

void addPreviewCommand(CLI::App& program) {
  auto options = std::make_shared<PreviewArguments>();
  CLI::App* command = program.add_subcommand(
      "preview", "Draw a picture of a model, its handles, bones, weights, anatomy, parts or stretch");
  command->add_option("FILE", options->input, "the model; - is standard input")->required();
  command->add_option("-o,--output", options->output, "the .png to write; - is standard output")
      ->required()
      ->type_name("FILE");
  command->add_option("--show", options->show, "model, handles, weights, bones, anatomy, parts or stretch")
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_option("--view", options->view, "front, side, back, top, three-quarter, or azimuth,elevation in degrees")
      ->type_name("VIEW")
      ->capture_default_str();
  command
      ->add_option("--size", options->size,
                   "width and height in pixels (default 1024x768; of each picture of several 320x320)")
      ->type_name("WxH");
  CLI::Option* clip =
      command
          ->add_option(
              "--clip", options->clip,
              "the clip to show (default: the first), at its beginning unless --time, --frames or --animate says more")
          ->type_name("NAME");
  CLI::Option* time = command->add_option("--time", options->time, "a moment of the clip, in seconds")
                          ->check(momentOfClip())
                          ->type_name("S");
  CLI::Option* frames = command->add_option("--frames", options->frames, "a sheet of so many moments of the clip")
                            ->check(CLI::Range(1, 400))
                            ->type_name("N")
                            ->excludes(time);
  CLI::Option* animate =
      command->add_flag("--animate", options->animate, "an animated PNG of the clip")->excludes(time)->excludes(frames);
  CLI::Option* rest =
      command->add_flag("--rest", options->rest,
                        "draw no clip, but the pose of the file's joints: the rest pose, or what limber pose left");
  for (CLI::Option* ofClip : {clip, time, frames, animate}) rest->excludes(ofClip);
  command->add_flag("--turntable", options->turntable, "an animated PNG of the model from all around, in 4 seconds")
      ->excludes(animate)
      ->excludes(frames);
  command->add_option("--worst", options->worst, "of a range of motion the N poses that stretch the surface the most")
      ->check(CLI::Range(1, 400))
      ->type_name("N");
  command->add_option("--fps", options->fps, "pictures a second of an animation or a turntable (default 20)")
      ->check(numberIn(0.1, 100))
      ->type_name("RATE");
  command->add_option("--background", options->background, "studio, transparent, or a colour such as #ffffff")
      ->type_name("COLOUR")
      ->capture_default_str();
  command->add_option("--joint", options->joint, "the weight of this joint alone, from blue (none) to red (all)")
      ->type_name("NAME");
  command->add_option("--deformer", options->deformer, "how the surface of a rigged model bends, see below")
      ->type_name("NAME")
      ->capture_default_str();
  options->parts.addTo(*command);
  options->common.addTo(*command);
  command->footer(
      "A file with a skeleton and no mesh, such as a BVH, is shown as its bones. A rigged file with clips is shown at "
      "the\n"
      "beginning of its first clip, but where limber pose has saved a pose in it, and with --rest.\n"
      "Stretch is blue where the surface keeps its size at rest, and red where it is twice or half of it: at a\n"
      "moment of a clip, or without one as a sheet of a range of motion test (limber evaluate model --help), of which\n"
      "--worst takes the poses that stretch the most by linear blending, whatever the deformer.\n" +
      deformerList() +
      "\nExamples:\n"
      "  limber preview rigged.glb --show stretch -o stretch.png\n"
      "  limber preview rigged.glb --show stretch --worst 4 --deformer delta-mush -o stretch.png\n"
      "  limber preview rigged.glb --show handles --view 30,15 -o handles.png\n"
      "  limber preview walking.glb --frames 8 -o sheet.png\n"
      "  limber preview person.glb --show parts --count 6 -o parts.png\n"
      "  limber preview walk.bvh --animate --fps 8 -o walk.png\n"
      "  limber preview walking.glb --animate --fps 8 --deformer direct-delta-mush -o walk.png\n"
      "  limber preview dragon.glb --turntable --fps 8 --background transparent -o dragon.png");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
