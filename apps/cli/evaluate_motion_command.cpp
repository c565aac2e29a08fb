// limber evaluate motion: how well a character moves as the source of its motion did.
#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.h"
#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/file/file.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "limber/evaluate/motion/judge_table.h"
#include "limber/evaluate/motion/retarget_table.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct MotionEvaluationArguments {
  std::string result, source, truth, clip, sourceClip, mapFile;
  bool json = false;
};

// A clip whose name is taken is added as name_2, name_3, and so on.
std::string withoutNumber(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  return end != std::string::npos && end + 1 < name.size() && end > 0 && name[end] == '_' ? name.substr(0, end) : name;
}

const Clip* findClip(const Motion& motion, std::string_view name) {
  const auto found =
      std::find_if(motion.clips.begin(), motion.clips.end(), [&](const Clip& clip) { return clip.name == name; });
  return found == motion.clips.end() ? nullptr : &*found;
}

[[noreturn]] void refuseClip(const Motion& motion, const std::string& wanted, const char* option) {
  std::vector<std::string> names;
  for (const Clip& clip : motion.clips) names.push_back(clip.name);
  throw Error(ErrorCode::kBadArgument, fmt::format("has no clip '{}'", wanted), motion.name,
              fmt::format("choose by {} NAME; there are: {}", option, joinNames(names)));
}

// The clip of that name, else the one that was last named after the source, else the only one.
const Clip& clipOfResult(const Motion& result, const Motion& source, const std::string& name) {
  const std::string& wanted = name.empty() ? source.name : name;
  for (auto clip = result.clips.rbegin(); clip != result.clips.rend(); ++clip) {
    if (clip->name == wanted || (name.empty() && withoutNumber(clip->name) == wanted)) return *clip;
  }
  if (name.empty() && result.clips.size() == 1) return result.clips.front();
  refuseClip(result, wanted, "--clip");
}

// The clip of that name, else the only one, else the one named as the result's.
const Clip& clipOfSource(const Motion& source, const std::string& name, const std::string& moved) {
  if (!name.empty()) {
    if (const Clip* clip = findClip(source, name)) return *clip;
    refuseClip(source, name, "--source-clip");
  }
  if (source.clips.size() == 1) return source.clips.front();
  if (const Clip* clip = findClip(source, moved)) return *clip;
  if (const Clip* clip = findClip(source, withoutNumber(moved))) return *clip;
  refuseClip(source, moved, "--source-clip");
}

Motion withClip(Motion motion, const std::string& file) {
  if (motion.clips.empty()) throw Error(ErrorCode::kBadArgument, "holds no motion", file);
  return motion;
}

void run(const MotionEvaluationArguments& options) {
  const Character character(readAsset(options.result));
  const Asset& asset = character.document();
  const Motion result = asItRests(withClip(motionOf(asset, character.moving()), options.result), character.reading());
  const Motion given = withClip(readMotion(options.source), options.source);
  const SkeletonReading sourceReading(given.skeleton);
  const Motion source = asItRests(given, sourceReading);
  const Clip& moved = clipOfResult(result, source, options.clip);
  const Clip& original = clipOfSource(source, options.sourceClip, moved.name);
  SkeletonMap map;
  if (options.mapFile.empty()) {
    map = matchMotion(source, sourceReading, character.reading());
  } else {
    const Bytes text = readFile(options.mapFile);
    map = skeletonMapFromJson({reinterpret_cast<const char*>(text.data()), text.size()}, source.skeleton,
                              result.skeleton);
  }
  const double rate = frameRateOf(original);
  const PlainSkeleton sourcePlain(source.skeleton), resultPlain(result.skeleton);
  const PoseSequence sampled = sampleFrames(source.skeleton, original, rate), from = sourcePlain.plain(sampled);
  PoseSequence to = sampleFrames(result.skeleton, moved, rate);
  to.poses.resize(from.poses.size(), to.poses.back());
  const PoseSequence toPlain = resultPlain.plain(to);
  RetargetOptions standing;
  standing.characterOnGround = !isSkeletonAlone(asset);
  const RetargetSetup setup(sourcePlain.skeleton(), resultPlain.skeleton(), map, standing, &from);
  const ShownJoints shownFrom = shownJoints(source.skeleton, sampled, setup.sourceKinematics.toBody()),
                    shownTo = shownJoints(result.skeleton, to, setup.targetKinematics.toBody());
  MotionMetrics metrics = measureMotion(setup, from, toPlain, &shownFrom, &shownTo);
  if (character.hasRig()) metrics.selfPenetration = measureSelfPenetration(readSkinnedModel(character), to.poses);
  if (!options.truth.empty()) {
    const Motion known = withClip(readMotion(options.truth), options.truth);
    const Motion truth = asItRests(known, known.skeleton);
    PoseSequence right = sampleFrames(truth.skeleton, clipOfResult(truth, source, options.clip), rate);
    if (truth.skeleton.jointCount() != result.skeleton.jointCount()) {
      throw Error(ErrorCode::kBadArgument, "has another skeleton than the result", options.truth);
    }
    right.poses.resize(from.poses.size(), right.poses.back());
    const ShownJoints shownRight = shownJoints(truth.skeleton, right, setup.targetKinematics.toBody());
    metrics.jointError = jointErrorOf(setup, resultPlain.plain(right), toPlain, &shownRight, &shownTo);
  }
  printReport(metrics, options.json);
}

struct MatrixOptions {
  std::vector<std::string> motions, characters;
  RetargetTrial trial;
  std::string output = "-", each;
  Common common;
};

void runMatrix(const MatrixOptions& options) {
  options.common.apply();
  checkOutput(options.output, {".md"});
  std::vector<std::string> others = options.motions;
  others.insert(others.end(), options.characters.begin(), options.characters.end());
  others.push_back(options.output);
  checkBeside("--each", options.each, others);
  RetargetTrial trial = options.trial;
  trial.motions.assign(options.motions.begin(), options.motions.end());
  trial.characters.assign(options.characters.begin(), options.characters.end());
  trial.prepare = [](const Motion& motion) { return asItRests(motion, motion.skeleton); };
  for (const std::string& method : trial.methods) findRetargetMethod(method);
  TerminalProgress progress(options.common.quiet);
  Warnings skipped;
  const std::vector<RetargetScore> scores = scoreRetargeting(trial, *progress, skipped);
  refuseNothing(scores.empty(), skipped);
  std::vector<AnswerScore> answers;
  if (trial.judge) answers = scoreAnswers(trial, *progress, skipped);
  if (!options.each.empty())
    writeText(options.each, toTsv(eachRetargetScore(scores)) + (trial.judge ? toTsv(eachAnswer(answers)) : ""));
  writeText(options.output,
            trial.judge ? toMarkdown(judgeTables(scores, answers)) : toMarkdown(retargetMethodTable(scores)));
  printWarnings(skipped, options.common.quiet);
}

}  // namespace

void addRetargetingEvaluation(CLI::App& evaluate) {
  auto options = std::make_shared<MatrixOptions>();
  CLI::App* command =
      evaluate.add_subcommand("retargeting", "Run the retargeting methods over motions and characters, and compare");
  command->add_option("--motion", options->motions, "files with motions")->required()->type_name("FILE");
  command->add_option("--character", options->characters, "rigged characters")->required()->type_name("FILE");
  command->add_option("--method", options->trial.methods, "only these methods; limber retarget --help lists them")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--most-frames", options->trial.maxFrames, "of each clip")
      ->check(CLI::Range(5, 1000000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--judge", options->trial.judge,
                    "judge against aligned and known answers, half of the makers apart, by what no method minimises");
  command
      ->add_option("--inside-frames", options->trial.insideFrames,
                   "frames of each clip in which it is seen what is inside the body; 0: none")
      ->check(CLI::Range(0, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  addMarkdownOutput(*command, options->output, "the table");
  command->add_option("--each", options->each, "write the figures of each pair, tab separated")
      ->check(notForPlans())
      ->type_name("FILE");
  options->common.addTo(*command);
  command->footer(
      "The measures are those of limber evaluate motion: means over all pairs of a clip and a character, the worst in\n"
      "brackets.\n"
      "\nExample:\n  limber evaluate retargeting --motion walk.bvh run.bvh --character hero.glb");
  command->callback([options] { runMatrix(*options); });
}

void addMotionEvaluation(CLI::App& evaluate) {
  auto options = std::make_shared<MotionEvaluationArguments>();
  CLI::App* command = evaluate.add_subcommand("motion", "Measure how well a character moves as its motion's source");
  command->add_option("RESULT", options->result, "the character with its clip")->required();
  command->add_option("--source", options->source, "the motion it came from")->required()->type_name("FILE");
  command->add_option("--truth", options->truth, "the same character with the clip as it should be")->type_name("FILE");
  command->add_option("--clip", options->clip, "the clip (default: the last named after the source)")
      ->type_name("NAME");
  command->add_option("--source-clip", options->sourceClip, "the source's (default: the one of that name)")
      ->type_name("NAME");
  command->add_option("--map", options->mapFile, "which joints follow which, in JSON")->type_name("FILE");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "Prints the angle between the bones' directions, the way of hands and feet against the limb's length, how fast\n"
      "planted feet slide, how deep feet go below the ground, the jerk against the source's, how often what is "
      "planted\n"
      "in the source is planted in the result, and, of a character with a skin, the share of its vertices that are\n"
      "inside the body and were outside in bind pose (5000 vertices in 24 frames at most, both taken evenly); with\n"
      "--truth the joints' squared distances, too. Animals are measured by their legs, what has none by how its\n"
      "joints turn.\n"
      "\nExample:\n  limber retarget hero.glb walk.bvh -o walking.glb\n"
      "  limber evaluate motion walking.glb --source walk.bvh");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
