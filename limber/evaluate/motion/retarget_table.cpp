#include "limber/evaluate/motion/retarget_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/rest_form.h"
#include "limber/document/clip/motion_io.h"
#include "limber/evaluate/held_out.h"
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

// Mean and worst of one measure.
struct Summary {
  double sum = 0, worst = 0, count = 0;
  void add(double value) {
    sum += value;
    worst = std::max(worst, value);
    ++count;
  }
  std::string text(int digits) const { return fmt::format("{:.{}f} ({:.{}f})", sum / count, digits, worst, digits); }
};

std::string verdictTsv(const RetargetVerdict& v) {
  return fmt::format("\t{:.3f}\t{:.3f}\t{:.3f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.3f}", v.jerk, v.jerkPeak, v.impact,
                     v.sliding, v.sourceSliding, v.contacts.precision(), v.contacts.recall(), v.bones95);
}

}  // namespace

std::vector<RetargetScore> scoreRetargeting(const RetargetTrial& trial, Progress& progress, Warnings& skipped) {
  std::vector<RetargetScore> scores;
  const Scorer scorer(trial, skipped);
  progress.stage("retarget");
  for (std::size_t i = 0; i < trial.motions.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(trial.motions.size()));
    try {
      scorer.score(trial.motions[i], scores);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add("unreadable-motions", "motions that cannot be read left out", error.what());
    }
  }
  progress.finish();
  return scores;
}

std::string retargetMethodTable(std::span<const RetargetScore> scores) {
  std::vector<std::string> methods;
  for (const RetargetScore& score : scores) {
    if (std::find(methods.begin(), methods.end(), score.method) == methods.end()) methods.push_back(score.method);
  }
  std::string table =
      "| method | bones, degrees | hands and feet, % of the limb | sliding, heights/s | of the source "
      "| below ground, mm of 1.7 m | jerk, times the source's | contacts kept, % | inside itself, % | frames/s |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& method : methods) {
    Summary bones, ends, sliding, source, depth, jerk, contacts, inside, rate;
    for (const RetargetScore& score : scores) {
      if (score.method != method) continue;
      const MotionMetrics& m = score.metrics;
      bones.add(m.boneDirection);
      ends.add(100 * m.endEffector);
      sliding.add(m.sliding);
      source.add(m.sourceSliding);
      depth.add(1700 * m.penetration);
      jerk.add(m.jerk);
      contacts.add(100 * m.contactAgreement);
      if (score.inside) inside.add(100 * *score.inside);
      rate.add(score.framesPerSecond);
    }
    table += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.1f} | {} | {:.0f} |\n", method, bones.text(1),
                         ends.text(1), sliding.text(3), source.text(3), depth.text(1), jerk.text(2),
                         contacts.sum / contacts.count, inside.count > 0 ? inside.text(1) : "-", rate.sum / rate.count);
  }
  return table;
}

std::string retargetScoresTsv(std::span<const RetargetScore> scores) {
  std::string text =
      "motion\tcharacter\tmethod\tbones\tends\tsliding\tsource_sliding\tpenetration\tsource_penetration\tjerk\t"
      "joint_jerk\tcontacts\tself_penetration\tframes_per_second\theld_out\tjudged_jerk\tjudged_peak\tjudged_impact\t"
      "judged_sliding\tjudged_source_sliding\tprecision\trecall\tbones95\n";
  for (const RetargetScore& score : scores) {
    const MotionMetrics& m = score.metrics;
    text += fmt::format(
        "{}\t{}\t{}\t{:.3f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.5f}\t{:.5f}\t{:.3f}\t{:.3f}\t{:.3f}\t{}\t{:.0f}\t{}{}\n",
        score.motion, score.character, score.method, m.boneDirection, m.endEffector, m.sliding, m.sourceSliding,
        m.penetration, m.sourcePenetration, m.jerk, m.jointJerk, m.contactAgreement,
        score.inside ? fmt::format("{:.5f}", *score.inside) : "", score.framesPerSecond, score.heldOut ? 1 : 0,
        score.verdict ? verdictTsv(*score.verdict) : "\t\t\t\t\t\t\t\t");
  }
  return text;
}

}  // namespace limber
