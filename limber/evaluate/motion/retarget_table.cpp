#include "limber/evaluate/motion/retarget_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/rest_form.h"
#include "limber/document/clip/motion_io.h"
#include "limber/evaluate/group_summary.h"
#include "limber/evaluate/held_out.h"
#include "limber/evaluate/model_files.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "limber/motion/limbs/body/skin_tube.h"
#include "limber/motion/limbs/roughness.h"

namespace limber {

namespace {

constexpr std::size_t kMaxVertices = 1500;  // enough for means over many pairs

struct RatedCharacter {
  std::string name;
  bool heldOut;
  Skeleton skeleton;
  std::optional<SkinnedModel> model;
  std::shared_ptr<const BodySkin> skin;
};

std::vector<RatedCharacter> readCharacters(std::span<const std::filesystem::path> files, Warnings& skipped) {
  std::vector<RatedCharacter> characters;
  for (const std::filesystem::path& file : files) {
    try {
      const Character character(readAsset(file));
      characters.push_back({file.stem().string(), isHeldOut(file), character.skeleton(), std::nullopt, nullptr});
      if (!character.hasRig()) continue;
      const SkinnedModel& model = characters.back().model.emplace(readSkinnedModel(character));
      characters.back().skin = makeBodySkin(model.skeleton, model.mesh.positions, model.weights);
    } catch (const Error& error) {
      skipped.add("unreadable", "characters that cannot be read left out", error.what());
    }
  }
  return characters;
}

class Scorer {
 public:
  Scorer(const RetargetTrial& trial, Warnings& skipped) : trial_(trial), skipped_(skipped) {
    for (const RetargetMethod& method : retargetMethods()) {
      if (trial.methods.empty()) methods_.push_back(&method);
    }
    for (const std::string& name : trial.methods) methods_.push_back(&findRetargetMethod(name));
    characters_ = readCharacters(trial.characters, skipped);
  }

  void score(const std::filesystem::path& file, std::vector<RetargetScore>& scores) const {
    const Motion motion = trial_.prepare ? trial_.prepare(readMotion(file)) : readMotion(file);
    for (const Clip& clip : motion.clips) {
      const PlainSkeleton plain(motion.skeleton);
      PoseSequence source = plain.plain(sampleFrames(motion.skeleton, clip, frameRateOf(clip)));
      if (source.poses.size() > trial_.maxFrames) source.poses.resize(trial_.maxFrames);
      if (source.poses.size() < 5) {
        skipped_.add("short", "clips of less than 5 frames left out", clip.name);
        continue;
      }
      const std::string name = motion.clips.size() == 1 ? motion.name : motion.name + ":" + clip.name;
      for (const RatedCharacter& character : characters_) {
        scoreOn(plain.skeleton(), source, {name, isHeldOut(file)}, character, scores);
      }
    }
  }

 private:
  struct Named {
    std::string name;
    bool heldOut;
  };

  std::optional<double> insideOf(const RatedCharacter& character, const std::vector<Pose>& poses) const {
    if (!character.model || trial_.insideFrames == 0) return std::nullopt;
    return measureSelfPenetration(*character.model, poses, {trial_.insideFrames, kMaxVertices}).mean;
  }

  void scoreOn(const Skeleton& skeleton, const PoseSequence& source, const Named& motion,
               const RatedCharacter& character, std::vector<RetargetScore>& scores) const {
    try {
      const PlainSkeleton plain(character.skeleton);
      RetargetOptions options;
      options.skin = character.skin;
      const std::optional<Pose> pose = poseWithForm(skeleton, source.poses);
      const SkeletonMap map = matchSkeletons(skeleton, plain.skeleton(), false, pose ? &*pose : nullptr);
      const RetargetSetup setup(skeleton, plain.skeleton(), map, options, &source);
      if (!hasLegs(setup)) {
        skipped_.add("legless", "pairs without legs left out", fmt::format("{} on {}", motion.name, character.name));
        return;
      }
      PoseSequence aligned;
      std::optional<double> alignedInside;
      if (trial_.judge) {
        aligned = retargetFrames(findRetargetMethod("aligned"), setup, source);
        alignedInside = insideOf(character, plain.original(aligned).poses);
      }
      for (const RetargetMethod* method : methods_) {
        const double start = secondsNow();
        const PoseSequence result = retargetFrames(*method, setup, source);
        const double seconds = secondsNow() - start;
        const double rate = seconds > 0 ? static_cast<double>(source.poses.size()) / seconds : 0;
        const MotionMetrics metrics = measureMotion(setup, source, result);
        RetargetScore score = {motion.name,
                               character.name,
                               std::string(method->name),
                               metrics,
                               rate,
                               motion.heldOut || character.heldOut,
                               {},
                               {}};
        score.inside = insideOf(character, plain.original(result).poses);
        if (trial_.judge) {
          score.verdict = judgeRetargeting(setup, source, aligned, result);
          score.verdict->inside = score.inside;
          score.verdict->alignedInside = alignedInside;
        }
        scores.push_back(std::move(score));
      }
    } catch (const Error& error) {
      skipped_.add("unmatched", "pairs that cannot be compared left out",
                   fmt::format("{} on {}: {}", motion.name, character.name, error.message()));
    }
  }

  const RetargetTrial& trial_;
  Warnings& skipped_;
  std::vector<const RetargetMethod*> methods_;
  std::vector<RatedCharacter> characters_;
};

}  // namespace

std::vector<RetargetScore> scoreRetargeting(const RetargetTrial& trial, Progress& progress, Warnings& skipped) {
  std::vector<RetargetScore> scores;
  const Scorer scorer(trial, skipped);
  forEachFile(trial.motions.size(), "retarget", kUnreadMotions, progress, skipped,
              [&](std::size_t i) { scorer.score(trial.motions[i], scores); });
  return scores;
}

Table retargetMethodTable(std::span<const RetargetScore> scores) {
  using Score = RetargetScore;
  const auto of = [](double MotionMetrics::*metric, double factor = 1) {
    return [=](const Score& score) { return factor * score.metrics.*metric; };
  };
  const std::vector<RowMeasure<Score>> measures = {
      {"bones, degrees", decimals(1), Statistic::kMeanAndWorst, of(&MotionMetrics::boneDirection)},
      {"hands and feet, % of the limb", decimals(1), Statistic::kMeanAndWorst, of(&MotionMetrics::endEffector, 100)},
      {"sliding, heights/s", decimals(3), Statistic::kMeanAndWorst, of(&MotionMetrics::sliding)},
      {"of the source", decimals(3), Statistic::kMeanAndWorst, of(&MotionMetrics::sourceSliding)},
      {"below ground, mm of 1.7 m", decimals(1), Statistic::kMeanAndWorst, of(&MotionMetrics::penetration, 1700)},
      {"jerk, times the source's", decimals(2), Statistic::kMeanAndWorst, of(&MotionMetrics::jerk)},
      {"contacts kept, %", decimals(1), Statistic::kMean, of(&MotionMetrics::contactAgreement, 100)},
      {"inside itself, %", decimals(1), Statistic::kMeanAndWorst,
       [](const Score& score) { return score.inside ? std::optional(100 * *score.inside) : std::nullopt; }},
      {"frames/s", decimals(0), Statistic::kMean, &Score::framesPerSecond}};
  Table table = summaryTable({words("method")}, measures);
  for (const std::string& method : namesIn(scores, &Score::method)) {
    addSummary({method}, rowsWhere(scores, [&](const Score& score) { return score.method == method; }), measures,
               table);
  }
  return table;
}

Table eachRetargetScore(std::span<const RetargetScore> scores) {
  Table table{{words("motion"), words("character"), words("method"), number("bones", 3), number("ends", 4),
               number("sliding", 4), number("source_sliding", 4), number("penetration", 5),
               number("source_penetration", 5), number("jerk", 3), number("joint_jerk", 3), number("contacts", 3),
               number("self_penetration", 5), number("frames_per_second", 0), number("held_out", 0)}};
  table.columns.insert(
      table.columns.end(),
      {number("judged_jerk", 3), number("judged_peak", 3), number("judged_impact", 3), number("judged_sliding", 4),
       number("judged_source_sliding", 4), number("precision", 4), number("recall", 4), number("bones95", 3)});
  for (const RetargetScore& score : scores) {
    const MotionMetrics& m = score.metrics;
    std::vector<Cell> cells = {score.motion, score.character,    score.method,  m.boneDirection,       m.endEffector,
                               m.sliding,    m.sourceSliding,    m.penetration, m.sourcePenetration,   m.jerk,
                               m.jointJerk,  m.contactAgreement, score.inside,  score.framesPerSecond, score.heldOut};
    if (const auto& v = score.verdict) {
      cells.insert(cells.end(), {v->jerk, v->jerkPeak, v->impact, v->sliding, v->sourceSliding, v->contacts.precision(),
                                 v->contacts.recall(), v->bones95});
    }
    cells.resize(table.columns.size());
    table.add(std::move(cells));
  }
  return table;
}

}  // namespace limber
