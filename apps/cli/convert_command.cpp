// limber convert: motions, and models that move, from one file format to another; they can be cut, mirrored and
// resampled as well.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "clip_arguments.h"
#include "command.h"
#include "fbx_arguments.h"
#include "limber/actions/export/write_model.h"
#include "limber/character/anatomy/skeleton_mirror.h"
#include "limber/character/anatomy/skeleton_size.h"
#include "limber/core/counted.h"
#include "limber/core/text/names.h"
#include "limber/core/text/parse_number.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/clip/replace_clips.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/mesh/rest_mesh.h"
#include "limber/document/unique_names.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/clip/moving_scales.h"
#include "motion_arguments.h"
#include "progress_line.h"
#include "target_arguments.h"
#include "vrm_arguments.h"
#include "vrma_files.h"

namespace limber::cli {

namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  std::vector<std::string> files;
  std::string output, unit = "m", outputUnit, trim;
  std::vector<std::string> clips;
  bool mirror = false;
  MotionArguments motionFiles;
  ClipArguments clipEdits;
  TargetArguments target;
  FbxArguments fbx;
  VrmArguments vrm;
  Common common;

  // Are the clips to be anything else than they were?
  bool editsClips() const { return mirror || !trim.empty() || clipEdits.edits.any(); }
};

double metresOf(const std::string& unit) {
  constexpr std::pair<const char*, double> kUnits[] = {
      {"m", 1}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}, {"cmu", 0.0254 / 0.45}};
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  if (const std::optional<double> metres = finiteNumber(unit); metres && *metres > 0) return *metres;
  throw Error(ErrorCode::kBadArgument, "\"" + unit + "\" is no unit of length", "",
              "use m, dm, cm, mm, in, ft, cmu, or how many metres it has");
}

MotionOptions motionOptions(const ConvertArguments& options) {
  MotionOptions motion = options.motionFiles.options();
  motion.bvh.metresPerUnit = metresOf(options.unit);
  return motion;
}

bool isBvh(const std::string& path) {
  return lowerExtension(path) == ".bvh";
}

// The seconds of "1.5:3", ":3" or "1.5:".
TimeSpan trimSpan(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto part = [&](const std::string& number, double otherwise) {
    return number.empty() ? otherwise : finiteNumber(number).value_or(std::nan(""));
  };
  TimeSpan span{std::nan(""), std::nan("")};
  if (colon != std::string::npos) {
    span = {part(text.substr(0, colon), 0), part(text.substr(colon + 1), HUGE_VAL)};
  }
  if (span.from < span.to) return span;
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

// One of blend shapes or other nodes alone has no tracks.
bool moves(const Clip& clip) {
  return !clip.translations.empty() || !clip.rotations.empty() || !clip.scales.empty();
}

// What comes before the edits of clips that are common to several commands.
void trimAndMirror(Motion& motion, const ConvertArguments& options) {
  const SkeletonMirror mirror = options.mirror ? mirrorOf(motion.skeleton) : SkeletonMirror{};
  for (Clip& clip : motion.clips) {
    if (!options.trim.empty() && moves(clip)) {
      const auto [from, to] = trimSpan(options.trim);
      clip = trimClip(clip, from, to);
    }
    if (options.mirror) clip = mirrorClip(clip, motion.skeleton, mirror);
  }
}

// The clips as they were written.
void describe(const Motion& motion, const ConvertArguments& options, const Account& account) {
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    const Clip& clip = motion.clips[c];
    if (!moves(clip)) {
      account.line(fmt::format("  {:<30} moves no joint", clip.name));
      continue;
    }
    std::string line = fmt::format("  {:<30} {:8.3f} s", clip.name, clip.duration());
    if (!options.clipEdits.edits.tolerance) {
      const double rate = isBvh(options.output) ? bvhFrameRate(motion, c) : frameRateOf(motion, c);
      line += fmt::format(", {} at {:.6g} a second", counted(frameCount(clip, rate), "frame"), rate);
    }
    account.line(line);
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

void writeBvhFiles(Motion& motion, const ConvertArguments& options, const Account& account) {
  for (const Clip& clip : motion.clips) {
    const std::vector<Index> scaled = jointsWithScales(motion.skeleton, clip);
    if (scaled.empty()) continue;
    motion.warnings.add("bvh-scales", "scales of joints change, which a BVH does not hold: they are left out",
                        motion.skeleton.joints[scaled.front()].name, scaled.size());
  }
  const std::vector<std::pair<fs::path, Bytes>> files = bvhFiles(motion, options);
  std::vector<OutputFile> outputs;
  outputs.reserve(files.size());
  for (const auto& [path, bytes] : files) outputs.push_back({path, bytes});
  writeFiles(outputs);
  for (const auto& [path, bytes] : files) {
    if (path != "-") account.line(fmt::format("written: {}", path.string()));
  }
}

// Takes the clips out that were not asked for.
void keepClips(Asset& asset, const std::vector<std::string>& names) {
  if (names.empty()) return;
  const AccessorSweep accessors(asset);
  const BufferViewSweep views(asset);
  std::erase_if(asset.document.animations, [&](const gltf::Animation& animation) {
    return std::find(names.begin(), names.end(), animation.name) == names.end();
  });
  accessors.sweep(asset);
  views.sweep(asset);
}

// Reading what was read before tells the same again.
void appendNewKinds(const Warnings& from, Warnings& to) {
  const std::vector<Warning> known = to.items();
  for (const Warning& warning : from.items()) {
    const auto isSame = [&](const Warning& other) { return other.kind == warning.kind; };
    if (std::none_of(known.begin(), known.end(), isSame)) {
      to.add(warning.kind, warning.message, warning.where, warning.count);
    }
  }
}

// A model keeps all but the animations of its joints, which make room for the clips; from a motion comes a skeleton.
// The motion has the clips as they are edited afterwards.
Asset withClips(std::optional<Asset>& model, Motion& motion, const ConvertArguments& options,
                std::vector<ClipEditReport>& reports) {
  Asset asset;
  std::vector<std::string> names;
  if (model) {
    asset = std::move(*model);
    keepClips(asset, options.clips);
    std::optional<TimeSpan> cut;
    if (!options.trim.empty()) cut = trimSpan(options.trim);
    asset.warnings = {};  // the motion has them, and those of its own reading
    names = replaceClips(asset, movingSkeleton(asset), motion.clips, cut);
    appendNewKinds(asset.warnings, motion.warnings);
  } else {
    asset = motionAsset(motion);
    for (const gltf::Animation& animation : asset.document.animations) names.push_back(animation.name);
  }
  if (!options.clipEdits.edits.any()) return asset;
  asset.warnings = {};  // the motion has them
  reports = editClips(asset, names, options.clipEdits.edits);
  motion.warnings.append(asset.warnings);
  Motion edited = motionOf(asset);
  asset.warnings = std::move(edited.warnings);
  const std::vector<Clip>& clips = edited.clips;
  motion.clips.assign(clips.end() - static_cast<std::ptrdiff_t>(motion.clips.size()), clips.end());
  return asset;
}

// A model with its clips, one a file where the format holds one.
void writeModelFiles(const Asset& asset, const Motion& motion, const ConvertArguments& options,
                     const Account& account) {
  std::vector<fs::path> paths;
  if (holdsOneClip(options.output)) paths = pathsOfClips(motion, options.output);
  if (paths.empty()) paths.emplace_back(options.output);
  const std::vector<gltf::Animation>& clips = asset.document.animations;
  for (std::size_t c = 0; c < paths.size(); ++c) {
    WriteModelOptions write;
    write.target = options.target.target;
    write.vrm = options.vrm.meta;
    options.fbx.setIn(write);
    const std::size_t number = clips.size() - motion.clips.size() + c;  // clips are added behind what is there
    if (number < clips.size()) write.clip = clips[number].name;
    const Warnings warnings = writeModel(asset, paths[c], write);
    const std::string holds = holdsOneClip(paths[c]) ? "" : ", " + counted(motion.clips.size(), "clip");
    if (paths[c] != "-") account.line(fmt::format("written: {}{}", paths[c].string(), holds));
    if (c == 0) printWarnings(warnings, options.common.quiet);
  }
}

// Does it hold a motion alone, without a model?
bool isMotionFormat(const std::string& path) {
  return isBvh(path) || isVrmaFormat(path);
}

// Is more to be done than to bring a model, which may be still or move by blend shapes alone, into another format?
bool needsJoints(const ConvertArguments& options) {
  return options.files.size() > 1 || isMotionFormat(options.output) || options.mirror || options.clipEdits.edits.any();
}

// A mesh format holds neither joints nor clips, so that nothing which changes these can be asked for.
void checkMeshArguments(const ConvertArguments& options) {
  if (options.files.size() > 1) {
    throw Error(ErrorCode::kBadArgument, fmt::format("holds one mesh, not {} files", options.files.size()),
                options.output, "convert one at a time");
  }
  const bool changesClips = options.editsClips() || !options.clips.empty();
  if (changesClips || !findTarget(options.target.target).isPlain()) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("holds no {}, which {} would change", changesClips ? "clips" : "skeleton",
                            changesClips ? "the other options" : "--target"),
                options.output, "leave these options out, or write a .glb");
  }
}

// The model in its rest pose, as a mesh alone.
void writeMeshFile(const ConvertArguments& options, TerminalProgress& progress, const Account& account) {
  const Asset asset = readAsset(options.files.front());
  progress->stage("write");
  Warnings warnings = asset.warnings;
  const ExportMesh mesh = exportRestMesh(asset, warnings);
  writeMesh(mesh, options.output);
  progress.finish();
  account.line(fmt::format("written: {}, {}", options.output, counted(mesh.triangles.size(), "triangle")));
  printWarnings(warnings, options.common.quiet);
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
  std::vector<std::string_view> formats = modelExtensions();
  formats.insert(formats.end(), {".vrma", ".bvh", ".obj", ".stl", ".ply"});
  checkOutput(options.output, formats);
  options.target.check();
  options.clipEdits.check();
  if (isMeshFormat(options.output)) checkMeshArguments(options);
  if (options.clipEdits.edits.tolerance && isBvh(options.output)) {
    throw Error(ErrorCode::kBadArgument, "a BVH has all frames: --tolerance has nothing to leave out", options.output,
                "write a .glb, or fewer frames by --fps");
  }
  if (isVrmaFormat(options.output) && !findTarget(options.target.target).isPlain()) {
    throw Error(ErrorCode::kBadArgument,
                "a VRMA says itself which bone of VRM a joint is: --target has nothing to change", options.output,
                "write a .glb, .fbx or .bvh, or leave --target out");
  }
  if (!options.trim.empty()) trimSpan(options.trim);
  if (!options.outputUnit.empty()) metresOf(options.outputUnit);
  const MotionOptions reading = motionOptions(options);
  const Account account(options.common.quiet, options.output);

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  if (isMeshFormat(options.output)) return writeMeshFile(options, progress, account);
  std::optional<Motion> motion;
  std::optional<Asset> model;  // the first file, where it is one
  for (const std::string& file : options.files) {
    Motion read;
    if (isBvh(file) || lowerExtension(file) == ".npz") {
      read = readMotion(file, reading);
    } else {
      Asset asset = readAsset(file);
      read = needsJoints(options) ? motionOf(asset) : motionOf(asset, movingSkeleton(asset));
      if (!motion && asset.format != "bvh" && asset.format != "npz") model = std::move(asset);
    }
    if (motion) {
      append(*motion, std::move(read), file);
    } else {
      motion = std::move(read);
    }
  }
  motion->clips = chosenClips(std::move(motion->clips), options.clips);
  progress->stage("edit");
  trimAndMirror(*motion, options);
  warnUnlikelySize(motion->skeleton, motion->clips, motion->warnings);
  std::vector<ClipEditReport> reports;
  if (isMotionFormat(options.output)) {
    reports = editClips(*motion, options.clipEdits.edits);
    if (isBvh(options.output)) toTarget(*motion, findTarget(options.target.target));
    progress.finish();
    if (isBvh(options.output)) {
      writeBvhFiles(*motion, options, account);
    } else {
      const VrmaSource source{model ? std::optional<Character>(*model) : std::nullopt, &*motion, options.editsClips()};
      writeVrmaFiles(source, pathsOfClips(*motion, options.output), options.common.quiet, account);
    }
  } else {
    const Asset asset = withClips(model, *motion, options, reports);
    progress.finish();
    writeModelFiles(asset, *motion, options, account);
  }
  describe(*motion, options, account);
  options.clipEdits.tell(reports, account);
  printWarnings(motion->warnings, options.common.quiet);
}

}  // namespace

void addConvertCommand(CLI::App& program) {
  auto options = std::make_shared<ConvertArguments>();
  CLI::App* command = program.add_subcommand(
      "convert", "Convert models and motions from one format to another; cut, mirror, loop, resample");
  command
      ->add_option("FILES", options->files,
                   "motions over one skeleton (BVH, SMPL's .npz, GLB, glTF, VRM, VRMA, FBX, DAE); the last is the "
                   "output unless -o names it")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "a .bvh or .vrma, a mesh alone as .obj, .stl or .ply, or " + modelOutputHelp())
      ->type_name("FILE");
  command->add_option("--clip", options->clips, "only the clip of this name; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--trim", options->trim, "only what lies between two moments, in seconds")->type_name("FROM:TO");
  command->add_flag("--mirror", options->mirror, "left for right");
  options->clipEdits.addTo(*command);
  command->add_option("--fps", options->clipEdits.edits.frameRate, "sample anew, so many frames a second")
      ->check(numberIn(0.01, 10000))
      ->type_name("RATE");
  command
      ->add_option("--unit", options->unit,
                   "what a length of 1 in a BVH means: m, dm, cm, mm, in, ft, cmu (1/0.45 inch), or metres")
      ->type_name("UNIT")
      ->capture_default_str();
  command->add_option("--output-unit", options->outputUnit, "the same for the BVH to write (default: --unit)")
      ->type_name("UNIT");
  options->motionFiles.addTo(*command);
  options->target.addTo(*command);
  options->fbx.addTo(*command);
  options->vrm.addTo(*command);
  options->common.addTo(*command);
  command->footer(
      TargetArguments::list() +
      "\n"
      "A BVH does not say its unit: lengths are kept as numbers, so that 1 is a metre, unless --unit tells. Out of a\n"
      "BVH comes a skeleton with one clip, named after the file. A model keeps all that it has; its clips are the "
      "ones\n"
      "that are written. A BVH, a USD and a VRMA hold one clip: of several each gets a file, OUT_CLIP.bvh.\n"
      "An OBJ, STL and PLY hold a mesh alone: of a rigged model it is the rest pose, without rig and clips, as a "
      "warning\n"
      "tells (limber pose --bake writes another pose).\n"
      "Edits come in the order trim, mirror, loop, root motion, fps, tolerance.\n"
      "\nExamples:\n"
      "  limber convert walk.bvh walk.glb\n"
      "  limber convert walk.bvh walk_cm.bvh --output-unit cm\n"
      "  limber convert walk_cm.bvh walk.glb --unit cm\n"
      "  limber convert walk.bvh run.bvh -o both.glb --fps 30\n"
      "  limber convert amass_walk.npz walk.bvh --fps 30\n"
      "  limber convert walk.glb game.glb --loop --root-joint --tolerance 1\n"
      "  limber convert hero.glb hero.fbx --target unreal\n"
      "  limber convert walking.glb walking.usdz --clip walk\n"
      "  limber convert person.glb scan.obj\n"
      "  limber convert hero.glb hero.vrm --vrm-author Ada --vrm-allow everyone\n"
      "  limber convert walking.glb walk.vrma --clip walk\n"
      "  limber convert walking.glb mirrored.bvh --clip walk --trim 0.5:2 --mirror");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
