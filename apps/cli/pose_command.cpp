// limber pose: the joints of a rigged model are turned, scaled, moved and reached, and stand so in the written file.

#include <algorithm>

#include <fmt/format.h>

#include "command.h"
#include "deformer_list.h"
#include "limber/actions/export/write_model.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/pose/put_pose.h"
#include "limber/actions/rig/body_masses.h"
#include "limber/character/character.h"
#include "limber/core/text/names.h"
#include "limber/deform/deformer.h"
#include "limber/document/clip/clip_moment.h"
#include "limber/document/clip/pose_file.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/document/read.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/samples/motions/sample_poses.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/limits/limits_json.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct PoseArguments {
  std::string input, output, applied, posesFile, poseName, limitsFile, deformer = "linear-blend", rootMotion = "fixed";
  std::optional<std::string> clip;
  std::optional<double> seconds;
  std::vector<std::string> turns, scales, moves, reaches, poles, bases, tasks;
  PoseOptions pose;
  bool bake = false, setRest = false;
  Common common;
};

// The pose of that name; the only one of the file where none is named.
PoseEdits editsOf(const std::string& file, const std::string& name) {
  const Bytes bytes = readFile(file);
  std::vector<NamedPose> poses = parsePoses({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  if (name.empty() && poses.size() == 1) return poses.front().edits;
  std::vector<std::string> names;
  for (NamedPose& pose : poses) {
    if (!name.empty() && pose.name == name) return std::move(pose.edits);
    names.push_back(pose.name);
  }
  throw Error(ErrorCode::kBadArgument,
              name.empty() ? "holds several poses" : fmt::format("holds no pose called '{}'", name), file,
              fmt::format("choose by --pose NAME; there are: {}", joinNames(names)));
}

// What the file says first, then what the options say.
PoseEdits collectEdits(const PoseArguments& options) {
  PoseEdits edits;
  if (!options.posesFile.empty()) edits = editsOf(options.posesFile, options.poseName);
  for (const std::string& text : options.turns) {
    const std::vector<JointTurn> turns = parseTurn(text);
    edits.turns.insert(edits.turns.end(), turns.begin(), turns.end());
  }
  for (const std::string& text : options.scales) edits.scales.push_back(parseScale(text));
  for (const std::string& text : options.moves) edits.moves.push_back(parseMove(text));
  for (const std::string& text : options.reaches) edits.reaches.push_back(parseReach(text));
  for (const std::string& text : options.poles) parsePole(text, edits);
  for (const std::string& text : options.bases) parseBase(text, edits);
  for (const std::string& text : options.tasks) edits.tasks.push_back(parseTask(text));
  return edits;
}

// A file, or the name of a sample.
PortablePose portablePose(const std::string& named) {
  if (!lowerCase(named).ends_with(".json")) return makeSamplePose(named);
  return parsedFile(named, poseFromJson);
}

bool isPoseFile(const std::string& file) {
  return lowerCase(file).ends_with(kPoseFileEnding);
}

RootMotion rootMotionOf(const std::string& name) {
  if (name == "fixed") return RootMotion::kFixed;
  if (name == "turn") return RootMotion::kTurn;
  return RootMotion::kTranslate;
}

std::optional<JointLimits> readLimits(const std::string& file, const Skeleton& skeleton) {
  if (file.empty()) return std::nullopt;
  return parsedFile(file, [&](std::string_view text) { return limitsFromJson(text, skeleton); });
}

// None: as the file's nodes stand.
std::optional<ClipMoment> momentOf(const PoseArguments& options) {
  if (!options.clip && !options.seconds) return std::nullopt;
  return ClipMoment{options.clip.value_or(""), options.seconds.value_or(0)};
}

// As heavy as the skin says, where there is one: only balance asks.
std::vector<PointMass> massesFor(const PoseEdits& edits, const Character& character) {
  const auto isBalance = [](const TaskEdit& task) { return task.kind == TaskKind::kBalance; };
  if (std::none_of(edits.tasks.begin(), edits.tasks.end(), isBalance)) return {};
  return bodyMasses(character.surface(), character.weights(), character.binding().skeleton);
}

std::string_view outcomeText(IkOutcome outcome) {
  switch (outcome) {
    case IkOutcome::kReached:
      return "reached";
    case IkOutcome::kOutOfReach:
      return "out of reach";
    case IkOutcome::kStuck:
      break;
  }
  return "not reached, though it may be possible";
}

void writePose(const Asset& asset, const AssetSkeleton& skeleton, const Pose& pose, const std::string& file) {
  const std::string text = poseToJson({asset.name, skeleton.skeleton, pose});
  writeFile(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// A format that holds one clip shows the pose, and not a clip's.
Warnings writeModelInPose(const Asset& asset, const std::string& file) {
  WriteModelOptions still;
  still.isStill = true;
  return writeModel(asset, file, still);
}

// character  of the asset as it is
Warnings writeResult(Asset& asset, const Character& character, const Pose& pose, const PoseArguments& options) {
  const AssetSkeleton& skeleton = character.binding();
  if (isPoseFile(options.output)) {
    writePose(asset, skeleton, pose, options.output);
    return {};
  }
  if (!options.bake) {
    options.setRest ? setRestPose(asset, skeleton, pose) : writeNodePose(asset, skeleton, pose);
    return writeModelInPose(asset, options.output);
  }
  const PosedGeometry posed = posedGeometry(character, skeleton, pose, findDeformer(options.deformer));
  if (isMeshFormat(options.output)) {
    writeMesh(exportMesh(asset, posed.geometry), options.output);
    return {};
  }
  freezeGeometry(asset, character.surface(), posed.geometry.positions, posed.normals);
  return writeModelInPose(asset, options.output);
}

void run(PoseArguments options) {
  options.common.apply();
  std::vector<std::string_view> formats = modelExtensions();
  if (options.bake) formats.insert(formats.end(), {".obj", ".stl", ".ply"});
  if (options.bake || !isPoseFile(options.output)) checkOutput(options.output, formats);
  findIkMethod(options.pose.solver);
  findDeformer(options.deformer);
  options.pose.ik.rootMotion = rootMotionOf(options.rootMotion);
  const PoseEdits edits = collectEdits(options);

  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.input);
  if (!hasRig(asset)) {
    throw Error(ErrorCode::kBadArgument, "the model has no rig to pose", asset.name, "limber rig gives it one");
  }
  const std::optional<ClipMoment> moment = momentOf(options);
  if (moment) writeShapeWeights(asset, shapesAt(asset, *moment));
  const Character character(asset);
  const AssetSkeleton& skeleton = character.binding();
  Pose pose = moment ? poseAt(asset, skeleton, *moment) : readNodePose(asset, skeleton);
  progress->stage("pose");
  if (!options.applied.empty()) pose = putPose(portablePose(options.applied), skeleton.skeleton, pose);
  const std::optional<JointLimits> limits = readLimits(options.limitsFile, skeleton.skeleton);
  const std::vector<ReachReport> reports =
      editPose(skeleton.skeleton, pose, edits, limits ? &*limits : nullptr, options.pose);
  IkTaskResult tasks;
  if (!edits.tasks.empty()) {
    tasks = applyTasks(skeleton.skeleton, pose, edits.tasks, limits ? &*limits : nullptr,
                       {options.pose.ik, massesFor(edits, character)});
  }
  progress->stage("write");
  const Warnings written = writeResult(asset, character, pose, options);
  Warnings warnings = asset.warnings;
  warnings.append(written);
  progress.finish();

  const Account account(options.common.quiet, options.output);
  for (const ReachReport& report : reports) {
    account.line(fmt::format("{:<16} {:.6f} m left: {}", report.joint, report.distance, outcomeText(report.outcome)));
  }
  for (std::size_t t = 0; t < tasks.tasks.size(); ++t) {
    account.line(fmt::format("{}: {}", edits.tasks[t].where, taskOutcome(tasks.tasks[t])));
  }
  printWarnings(warnings, options.common.quiet);
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

std::string poseHelp() {
  std::string text = "Solvers:\n";
  for (const IkMethod& method : ikMethods()) text += fmt::format("  {:<20}{}\n", method.name, method.summary);
  text += deformerList() + "Tasks:\n";
  for (const TaskForm& form : taskForms()) text += fmt::format("  {}\n      {}\n", form.form, form.summary);
  text +=
      "  Behind each, where it matters: @weight=2,priority=1. Priority 0 comes first; later ones get what those "
      "before\n"
      "  leave free. What cannot be met is said, with what is left and what is in the way; the exit code is 0 then, "
      "too.\n"
      "Sample poses:\n";
  for (const SamplePose& pose : samplePoses()) text += fmt::format("  {:<20}{}\n", pose.name, pose.summary);
  return text +
         "\nThe pose of --apply comes first. All turns are made next, then all scales, then all moves, then all "
         "reaches "
         "at\n"
         "once, then all tasks at once. Axes and points are the world's. Joints are called as in the file or as VRM's "
         "bones "
         "(leftHand).\n"
         "Names in the examples are those of handles (rigged.glb) and of the template humanoid (hero.glb).\n"
         "The file that --poses names: {\"poses\": [{\"name\": \"wave\", \"turn\": [{\"joint\": \"head\", \"axis\": "
         "[0, 1, 0],\n\"degrees\": 30}], \"scale\": [{\"joint\": \"head\", \"factor\": 1.2}], "
         "\"move\": [{\"joint\": \"hips\", \"offset\": [0, -0.1, 0]}],\n\"reach\": "
         "[{\"joint\": \"hand.L\", \"target\": [0.4, 1.2, 0.3], \"pole\": [0, 1, -1], \"base\": \"chest\"}],\n"
         "\"tasks\": [{\"kind\": \"look-at\", \"joint\": \"head\", \"target\": [0, 1.6, 2], \"weight\": 2, "
         "\"priority\": 1}]}]}  (docs/poses.schema.json)\n"
         "\nExamples:\n"
         "  limber pose rigged.glb --turn handle_03.L=z:30 --move handle_07.L=0,0.1,0 -o posed.glb\n"
         "  limber pose hero.glb --turn head=y:30 --move hips=0,-0.1,0 --reach leftHand=0.4,1.2,0.3 -o posed.glb\n"
         "  limber pose hero.glb --task look-at:head=0,1.6,2 --task keep-out:leftHand=sphere:0,1,0,0.3 -o posed.glb\n"
         "  echo '{\"poses\": [{\"name\": \"nod\", \"turn\": [{\"joint\": \"head\", \"axis\": [1, 0, 0], \"degrees\": "
         "20}]}]}' "
         "> poses.json\n"
         "  limber pose hero.glb --poses poses.json --bake -o posed.obj\n"
         "  limber pose rigged.glb --scale handle_02=1.4 -o large_head.glb\n"
         "  limber pose walking.glb --clip walk --time 0.4 --bake -o statue.stl\n"
         "  limber pose hero.glb --turn leftUpperArm=z:45 --set-rest -o t_pose.glb\n"
         "  limber pose hero.glb --apply sit -o sitting.glb\n"
         "  limber pose walking.glb --clip walk --time 0.4 -o step.pose.json";
}

}  // namespace

void addPoseCommand(CLI::App& program) {
  auto options = std::make_shared<PoseArguments>();
  CLI::App* command = program.add_subcommand("pose", "Turn, scale, move and reach the joints of a rigged model");
  command->add_option("IN", options->input, "the rigged model; - is standard input")->required();
  command->add_option("-o,--output", options->output, modelOutputHelp() + "; or the pose alone as .pose.json")
      ->required()
      ->type_name("FILE");
  const auto addMany = [&](const char* name, std::vector<std::string>& values, const char* description,
                           const char* form) {
    command->add_option(name, values, description)->type_name(form)->allow_extra_args(false);
  };
  addMany("--turn", options->turns, "turn a joint about axes of the world by degrees", "JOINT=y:30");
  addMany("--scale", options->scales, "scale a joint with its children by a factor", "JOINT=1.5");
  addMany("--move", options->moves, "move a joint, in metres", "JOINT=x,y,z");
  addMany("--reach", options->reaches, "bring a joint to a point; the joints above it turn", "JOINT=x,y,z");
  addMany("--pole", options->poles, "the point to which the middle of a reaching limb bends", "JOINT=x,y,z");
  addMany("--base", options->bases, "the highest joint that turns for a reaching one (default: the root's children)",
          "JOINT=JOINT");
  addMany("--task", options->tasks, "goals and constraints of a joint, see below", "KIND:JOINT=VALUE");
  command->add_option("--clip", options->clip, "start from this clip (default: as the file stands)")->type_name("NAME");
  command->add_option("--time", options->seconds, "at this moment of the clip, or of the first, in seconds")
      ->check(momentOfClip())
      ->type_name("S");
  command
      ->add_option("--apply", options->applied,
                   "a pose of this or another skeleton: a .pose.json file, or a name of those below")
      ->type_name("POSE");
  command->add_option("--poses", options->posesFile, "edits out of a JSON file, made before those of the options")
      ->type_name("FILE");
  command->add_option("--pose", options->poseName, "which pose of that file")->type_name("NAME")->needs("--poses");
  command->add_option("--solver", options->pose.solver, "how joints reach, see below")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--limits", options->limitsFile, "how far joints turn, in JSON (docs/limits.schema.json)")
      ->type_name("FILE");
  command->add_option("--root-motion", options->rootMotion, "what the root may do for reaching joints and tasks")
      ->check(CLI::IsMember({"fixed", "turn", "move"}))
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_flag("--bake", options->bake,
                    "move the vertices for good and take the rig out; then .obj, .stl and .ply can be written too");
  command->add_option("--deformer", options->deformer, "how --bake bends the surface, see below")
      ->type_name("NAME")
      ->needs("--bake")
      ->capture_default_str();
  command
      ->add_flag("--set-rest", options->setRest,
                 "make the pose the rest pose: vertices and bind matrices are those of it, clips play as before")
      ->excludes("--bake");
  options->common.addTo(*command);
  command->footer(poseHelp());
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
