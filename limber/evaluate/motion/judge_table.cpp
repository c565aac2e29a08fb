#include "limber/evaluate/motion/judge_table.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "limber/document/clip/motion_io.h"
#include "limber/evaluate/group_summary.h"
#include "limber/evaluate/held_out.h"
#include "limber/evaluate/model_files.h"
#include "limber/evaluate/motion/body_contacts.h"
#include "limber/evaluate/motion/known_answers.h"

namespace limber {

namespace {

constexpr double kPerson = 1700;  // millimetres

// What one column sums up.
struct JudgeColumn {
  std::string name;
  RowGroup<RetargetScore> scores;
  RowGroup<AnswerScore> answers;
};

using VerdictValue = std::function<std::optional<double>(const RetargetVerdict&)>;

RowMeasure<RetargetScore> meanAndWorst(std::string name, int digits, const VerdictValue& value) {
  return {std::move(name), decimals(digits), Statistic::kMeanAndWorst,
          [=](const RetargetScore& score) { return score.verdict ? value(*score.verdict) : std::nullopt; }};
}

// Of all frames together.
std::string contactFraction(const JudgeColumn& column) {
  ContactAgreement all;
  for (const RetargetScore* score : column.scores) {
    if (!score->verdict) continue;
    const ContactAgreement& contacts = score->verdict->contacts;
    all.found += contacts.found;
    all.foundRight += contacts.foundRight;
    all.meant += contacts.meant;
    all.meantFound += contacts.meantFound;
  }
  return fmt::format("{:.1f}, {:.1f}", 100 * all.precision(), 100 * all.recall());
}

Cell insideAgainstAligned(const JudgeColumn& column) {
  double own = 0, aligned = 0;
  for (const RetargetScore* score : column.scores) {
    if (!score->verdict) continue;
    own += score->verdict->inside.value_or(0);
    aligned += score->verdict->alignedInside.value_or(0);
  }
  return aligned > 0 ? Cell(fmt::format("{:.2f}", own / aligned)) : Cell();
}

RowMeasure<AnswerScore> errorOf(std::string_view change) {
  return {fmt::format("known answer, {}: off by, mm of 1.7 m", change), decimals(2), Statistic::kMeanAndWorst,
          [=](const AnswerScore& answer) {
            return answer.change == change ? std::optional(kPerson * answer.error) : std::nullopt;
          }};
}

Table contactTable(const std::vector<std::string>& methods) {
  Table table{{words("contact of the body with itself")}};
  for (const std::string& method : methods) table.columns.push_back(words(method));
  for (const BodyContact& contact : bodyContacts()) {
    table.addAcross(contact.name, methods, [&](const std::string& method) {
      const ContactScore score = scoreContact(findRetargetMethod(method), contact);
      return fmt::format("{:.0f} of {:.0f} (off by {:.1f} %); {:.0f} out of reach, {:.1f} %", score.kept, score.reached,
                         100 * score.worst, score.farReached, 100 * score.farWorst);
    });
  }
  return table;
}

}  // namespace

std::vector<AnswerScore> scoreAnswers(const RetargetTrial& trial, Progress& progress, Warnings& skipped) {
  std::vector<const RetargetMethod*> methods;
  for (const RetargetMethod& method : retargetMethods()) {
    const auto& asked = trial.methods;
    if (asked.empty() || std::find(asked.begin(), asked.end(), method.name) != asked.end()) methods.push_back(&method);
  }
  std::vector<AnswerScore> scores;
  const auto score = [&](const std::filesystem::path& file, bool isCharacter) {
    const Motion read = readMotion(file);
    const Motion motion = trial.prepare ? trial.prepare(read) : read;
    const std::vector<KnownAnswer> answers = knownAnswers(motion.skeleton);
    RetargetOptions options;
    options.characterOnGround = isCharacter;
    for (const Clip& clip : motion.clips) {
      PoseSequence frames = sampleFrames(motion.skeleton, clip, frameRateOf(clip));
      if (frames.poses.size() > trial.maxFrames) frames.poses.resize(trial.maxFrames);
      if (frames.poses.size() < 5) continue;
      for (const KnownAnswer& answer : answers) {
        if (isCharacter && &answer != &answers.front()) break;
        for (const RetargetMethod* method : methods) {
          try {
            const double error = errorOfAnswer(*method, motion.skeleton, frames, answer, options);
            scores.push_back({file.stem().string() + ":" + clip.name, std::string(answer.change),
                              std::string(method->name), isHeldOut(file), error});
          } catch (const Error& error) {
            skipped.add("answers", "known answers left out",
                        fmt::format("{} {}: {}", file.stem().string(), answer.change, error.message()));
          }
        }
      }
    }
  };
  forEachFile(trial.motions.size() + trial.characters.size(), "answers", kUnreadMotions, progress, skipped,
              [&](std::size_t i) {
                const bool isCharacter = i >= trial.motions.size();
                score(isCharacter ? trial.characters[i - trial.motions.size()] : trial.motions[i], isCharacter);
              });
  return scores;
}

std::vector<Table> judgeTables(std::span<const RetargetScore> scores, std::span<const AnswerScore> answers) {
  const std::vector<std::string> methods = namesIn(scores, &RetargetScore::method);
  std::vector<JudgeColumn> columns;
  Table table{{words("measure")}};
  for (const std::string& method : methods) {
    for (const bool heldOut : {false, true}) {
      const auto isIn = [&](const auto& one) { return one.method == method && one.heldOut == heldOut; };
      columns.push_back({fmt::format("{}, {}", method, heldOut ? "held out" : "set by"), rowsWhere(scores, isIn),
                         rowsWhere(answers, isIn)});
      table.columns.push_back(words(columns.back().name));
    }
  }
  const auto add = [&](const RowMeasure<RetargetScore>& measure) {
    table.addAcross(measure.name, columns, [&](const auto& column) { return summaryOf(column.scores, measure); });
  };
  using Verdict = RetargetVerdict;
  add(meanAndWorst("jerk of joint positions, times `aligned`", 2, &Verdict::jerk));
  add(meanAndWorst("its peaks, likewise", 2, &Verdict::jerkPeak));
  add(meanAndWorst("accelerations at contacts, likewise", 2, &Verdict::impact));
  add(meanAndWorst("sliding, heights/s", 3, &Verdict::sliding));
  add(meanAndWorst("the source's own", 3, &Verdict::sourceSliding));
  table.addAcross("contacts, precision and recall, %", columns, contactFraction);
  add(meanAndWorst("bone directions against `aligned` where nothing touches, p95, degrees", 1, &Verdict::bones95));
  add(meanAndWorst("surface inside the body, %", 2,
                   [](const Verdict& v) { return v.inside ? std::optional(100 * *v.inside) : std::nullopt; }));
  table.addAcross("the same over that of `aligned`", columns, insideAgainstAligned);
  for (const char* change : {"own", "renamed", "reposed", "scaled", "mirrored"}) {
    const RowMeasure<AnswerScore> error = errorOf(change);
    table.addAcross(error.name, columns, [&](const auto& column) { return summaryOf(column.answers, error); });
  }
  const RowMeasure<RetargetScore> rate{"frames/s", decimals(0), Statistic::kMean, &RetargetScore::framesPerSecond};
  table.addAcross(rate.name, columns, [&](const auto& column) { return summaryOf(column.scores, rate); });
  return {std::move(table), contactTable(methods)};
}

Table eachAnswer(std::span<const AnswerScore> answers) {
  Table table{{words("motion"), words("change"), words("method"), number("held_out", 0), number("error_heights", 7)}};
  for (const AnswerScore& answer : answers) {
    table.add({answer.motion, answer.change, answer.method, answer.heldOut, answer.error});
  }
  return table;
}

}  // namespace limber
