// limber convert: motions, and models that move, from one file format to another, cut, mirrored and sampled anew on the
// way.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "command.h"
#include "limber/anatomy/skeleton_mirror.h"
#include "limber/asset/bvh_write.h"
#include "limber/asset/clip_io.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/unique_names.h"
#include "limber/asset/write.h"
#include "limber/core/counted.h"
#include "limber/core/names.h"
#include "limber/skeleton/clip_edit.h"
#include "limber/usd/usd_write.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  std::vector<std::string> files;
  std::string output, unit = "m", outputUnit, up = "auto", trim;
  std::vector<std::string> clips;
  std::optional<double> fps;
  bool mirror = false, loop = false;
  Common common;
};

double metresOf(const std::string& unit) {
  constexpr std::pair<const char*, double> kUnits[] = {
      {"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}, {"cmu", 0.0254 / 0.45}};
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  char* end = nullptr;
  const double metres = std::strtod(unit.c_str(), &end);
  if (!unit.empty() && *end == 0 && metres > 0 && std::isfinite(metres)) return metres;
  throw Error(ErrorCode::kBadArgument, "\"" + unit + "\" is no unit of length", "",
              "use m, dm, cm, mm, in, ft, cmu, or how many metres it has");
}

BvhOptions bvhOptions(const ConvertArguments& options) {
  BvhOptions bvh;
  bvh.metresPerUnit = metresOf(options.unit);
  if (options.up == "y") bvh.up = UpAxis::kY;
  if (options.up == "z") bvh.up = UpAxis::kZ;
  return bvh;
}

bool isBvh(const std::string& path) {
  return lowerExtension(path) == ".bvh";
}

// The seconds of "1.5:3", ":3" or "1.5:".
std::pair<double, double> trimSpan(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto part = [&](const std::string& number, double otherwise) {
    if (number.empty()) return otherwise;
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    return *end == 0 ? value : std::nan("");
  };
  std::pair<double, double> span(std::nan(""), std::nan(""));
  if (colon != std::string::npos) {
    span = {part(text.substr(0, colon), 0), part(text.substr(colon + 1), HUGE_VAL)};
  }
  if (span.first < span.second) return span;
  throw Error(ErrorCode::kBadArgument, "\"" + text + "\" is no span of time", "",
              "write its ends in seconds: 1.5:3, 1.5: or :3");
}

// The clips that are asked for; all where none is.
std::vector<Clip> chosenClips(std::vector<Clip> clips, const std::vector<std::string>& names) {
  if (names.empty()) return clips;
  std::vector<Clip> chosen;
  for (const std::string& name : names) {
    const auto found = std::find_if(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.name == name; });
    if (found != clips.end()) {
      chosen.push_back(*found);
      continue;
    }
    std::vector<std::string> all;
    all.reserve(clips.size());
    for (const Clip& clip : clips) all.push_back(clip.name);
    throw Error(ErrorCode::kBadArgument, fmt::format("there is no clip called '{}'", name), "",
                fmt::format("there are: {}", joinNames(all)));
  }
  return chosen;
}

// What the options do to each clip, in this order: loop, trim, mirror, fps.
void edit(Motion& motion, const ConvertArguments& options, const Account& account) {
  const SkeletonMirror mirror = options.mirror ? mirrorOf(motion.skeleton) : SkeletonMirror{};
  for (Clip& clip : motion.clips) {
    if (options.loop) {
      const std::optional<ClipLoop> loop = findLoop(motion.skeleton, clip);
      if (loop) clip = trimClip(clip, loop->begin, loop->end);
      account.line(loop ? fmt::format("{}: loops from {:.3f} to {:.3f} s, the ends {:.2g} of its size apart", clip.name,
                                      loop->begin, loop->end, loop->error)
                        : fmt::format("{}: no loop found, left as it is", clip.name));
    }
    if (!options.trim.empty()) {
      const auto [from, to] = trimSpan(options.trim);
      clip = trimClip(clip, from, to);
    }
    if (options.mirror) clip = mirrorClip(clip, motion.skeleton, mirror);
    if (options.fps) clip = resampleClip(clip, *options.fps);
  }
  if (options.fps) motion.framesPerSecond = *options.fps;
}

void describe(const std::string& file, const Motion& motion, const Account& account) {
  account.line(fmt::format("{}: {}, {}", file, counted(motion.skeleton.jointCount(), "joint"),
                           counted(motion.clips.size(), "clip")));
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    const Clip& clip = motion.clips[c];
    const double rate = frameRateOf(motion, c);
    account.line(fmt::format("  {:<30} {:8.3f} s, {} at {:.6g} a second", clip.name, clip.duration(),
                             counted(frameCount(clip, rate), "frame"), rate));
  }
}

// Puts the clips of `other` behind those of `motion`. The skeletons must be one.
void append(Motion& motion, Motion other, const std::string& file) {
  if (motion.skeleton.jointCount() != other.skeleton.jointCount()) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("has {} where the first file has {}", counted(other.skeleton.jointCount(), "joint"),
                            motion.skeleton.jointCount()),
                file, "clips of different skeletons: limber retarget brings them to one");
  }
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    const Joint &a = motion.skeleton.joints[j], &b = other.skeleton.joints[j];
    if (a.name == b.name && a.parent == b.parent) continue;
    throw Error(ErrorCode::kBadArgument,
                fmt::format("joint {} is '{}' and not '{}' as in the first file", j, b.name, a.name), file,
                "clips of different skeletons: limber retarget brings them to one");
  }
  for (Clip& clip : other.clips) motion.clips.push_back(std::move(clip));
  motion.warnings.append(other.warnings);
}

// Of formats that hold one clip: a file for each, under the name given, or with the clip's behind it where there are
// several.
std::vector<fs::path> pathsOfClips(const Motion& motion, const fs::path& output) {
  if (motion.clips.size() <= 1) return {motion.clips.size(), output};
  if (output == "-") throw Error(ErrorCode::kBadArgument, "such a file holds one clip", "", "choose it by --clip NAME");
  std::vector<fs::path> paths;
  UniqueNames names;
  for (const Clip& clip : motion.clips) {
    std::string name = clip.name;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char ch) { return ch < 0x20 || ch == '/' || ch == '\\'; }, '_');
    paths.push_back(output);
    paths.back().replace_filename(names.add(output.stem().string() + "_" + name) + output.extension().string());
  }
  return paths;
}

std::vector<std::pair<fs::path, Bytes>> bvhFiles(const Motion& motion, const ConvertArguments& options) {
  std::vector<std::pair<fs::path, Bytes>> files;
  for (const fs::path& path : pathsOfClips(motion, options.output)) {
    BvhWriteOptions write;
    write.clip = files.size();
    write.metresPerUnit = metresOf(options.outputUnit.empty() ? options.unit : options.outputUnit);
    files.emplace_back(path, writeBvh(motion, write));
  }
  if (files.empty()) throw Error(ErrorCode::kBadArgument, "there is no clip to write", options.files.front());
  return files;
}

void writeBvhFiles(const Motion& motion, const ConvertArguments& options, const Account& account) {
  const std::vector<std::pair<fs::path, Bytes>> files = bvhFiles(motion, options);
  std::vector<OutputFile> outputs;
  outputs.reserve(files.size());
  for (const auto& [path, bytes] : files) outputs.push_back({path, bytes});
  writeFiles(outputs);
  for (const auto& [path, bytes] : files) {
    if (path != "-") account.line(fmt::format("written: {}", path.string()));
  }
}

// A model keeps all but the animations of its joints, which make room for the clips; from a BVH comes a skeleton.
Asset withClips(std::optional<Asset>& model, const Motion& motion) {
  if (!model) return motionAsset(motion);
  const AssetSkeleton skeleton = animatedSkeleton(*model);
  removeChannels(*model, [&](Index node, std::string_view path) {
    return path != "weights" &&
           std::find(skeleton.jointNode.begin(), skeleton.jointNode.end(), node) != skeleton.jointNode.end();
  });
  addClips(*model, skeleton, motion.clips);
  return std::move(*model);
}

// A model with its clips, one a file.
void writeUsdFiles(const Asset& asset, const Motion& motion, const ConvertArguments& options, const Account& account) {
  std::vector<fs::path> paths = pathsOfClips(motion, options.output);
  if (paths.empty()) paths.emplace_back(options.output);
  const std::vector<gltf::Animation>& clips = asset.document.animations;
  for (std::size_t c = 0; c < paths.size(); ++c) {
    UsdOptions usd;
    const std::size_t number = clips.size() - motion.clips.size() + c;  // clips are added behind what is there
    if (number < clips.size()) usd.clip = clips[number].name;
    const Warnings warnings = writeUsd(asset, paths[c], usd);
    account.line(fmt::format("written: {}", paths[c].string()));
    if (c == 0) printWarnings(warnings, options.common.quiet);
  }
}

// Has it a rig, or anything that moves?
bool hasMotion(const Asset& asset) {
  return hasRig(asset) || !asset.document.animations.empty();
}

void run(ConvertArguments options) {
  options.common.apply();
  if (options.output.empty()) {
    if (options.files.size() < 2) {
      throw Error(ErrorCode::kBadArgument, "the output is missing", "", "name it last, or by -o");
    }
    options.output = options.files.back();
    options.files.pop_back();
  }
  checkOutput(options.output, {".glb", ".gltf", ".bvh", ".usda", ".usdz"});
  if (!options.trim.empty()) trimSpan(options.trim);
  if (!options.outputUnit.empty()) metresOf(options.outputUnit);
  const BvhOptions bvh = bvhOptions(options);
  const Account account(options.common.quiet, options.output);

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  std::optional<Motion> motion;
  std::optional<Asset> model;  // the first file, where it is one
  for (const std::string& file : options.files) {
    Motion read;
    if (isBvh(file)) {
      read = readBvh(file, bvh);
    } else {
      Asset asset = readAsset(file);
      if (isUsdFormat(options.output) && options.files.size() == 1 && !hasMotion(asset)) {
        progress.finish();
        return writeUsdFiles(asset, {}, options, account);
      }
      read = motionOf(asset);
      if (!motion && asset.format != "bvh") model = std::move(asset);
    }
    progress.finish();
    describe(file, read, account);
    if (motion) {
      append(*motion, std::move(read), file);
    } else {
      motion = std::move(read);
    }
  }
  motion->clips = chosenClips(std::move(motion->clips), options.clips);
  progress->stage("edit");
  edit(*motion, options, account);
  progress->stage("write");
  if (isBvh(options.output)) {
    progress.finish();
    writeBvhFiles(*motion, options, account);
  } else if (isUsdFormat(options.output)) {
    const Asset asset = withClips(model, *motion);
    progress.finish();
    writeUsdFiles(asset, *motion, options, account);
  } else {
    writeAsset(withClips(model, *motion), options.output);
    progress.finish();
    if (options.output != "-")
      account.line(fmt::format("written: {}, {}", options.output, counted(motion->clips.size(), "clip")));
  }
  printWarnings(motion->warnings, options.common.quiet);
}

}  // namespace

void addConvertCommand(CLI::App& program) {
  auto options = std::make_shared<ConvertArguments>();
  CLI::App* command =
      program.add_subcommand("convert", "Convert motions between BVH and glTF, and to USD; cut, mirror, resample");
  command
      ->add_option("FILES", options->files,
                   "motions over one skeleton (BVH, GLB, glTF, FBX, DAE); the last is the output unless -o names it")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "the .glb, .gltf, .bvh, .usda or .usdz to write; - is standard output (GLB)")
      ->type_name("FILE");
  command->add_option("--clip", options->clips, "only the clip of this name; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--trim", options->trim, "only what lies between two moments, in seconds")->type_name("FROM:TO");
  command->add_flag("--mirror", options->mirror, "left for right");
  command->add_flag("--loop", options->loop, "cut each clip to its best loop, where it has one");
  command->add_option("--fps", options->fps, "sample anew, so many frames a second")
      ->check(numberIn(0.01, 10000))
      ->type_name("RATE");
  command
      ->add_option("--unit", options->unit,
                   "what a length of 1 in a BVH means: m, dm, cm, mm, in, ft, cmu (1/0.45 inch), or metres")
      ->type_name("UNIT")
      ->capture_default_str();
  command->add_option("--output-unit", options->outputUnit, "the same for the BVH to write (default: --unit)")
      ->type_name("UNIT");
  command->add_option("--up", options->up, "which axis of a BVH points up; auto tells it from heads and feet")
      ->check(CLI::IsMember({"auto", "y", "z"}))
      ->type_name("AXIS")
      ->capture_default_str();
  options->common.addTo(*command);
  command->footer(
      "A BVH does not say its unit: lengths are kept as numbers, so that 1 is a metre, unless --unit tells. Out of a\n"
      "BVH comes a skeleton with one clip, named after the file. A model keeps all that it has; its clips are the "
      "ones\n"
      "that are written. A BVH and a USD hold one clip: of several each gets a file, OUT_CLIP.bvh.\n"
      "\nExamples:\n"
      "  limber convert walk.bvh walk.glb --unit cm\n"
      "  limber convert walk.bvh run.bvh -o both.glb --unit cmu --fps 30\n"
      "  limber convert hero.glb hero.usdz --clip walk\n"
      "  limber convert hero.glb waving.bvh --clip wave --trim 0.5:2 --mirror");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
