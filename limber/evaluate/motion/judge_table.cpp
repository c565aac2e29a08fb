#include "limber/evaluate/motion/judge_table.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "limber/document/clip/motion_io.h"
#include "limber/evaluate/held_out.h"
#include "limber/evaluate/motion/body_contacts.h"
#include "limber/evaluate/motion/known_answers.h"

namespace limber {

namespace {

constexpr double kPerson = 1700;  // millimetres

// What one column sums up.
struct JudgeColumn {
  std::string method;
  bool heldOut;
};

struct MeanAndWorst {
  double sum = 0, count = 0;
  double worst = 0;
  void add(double value) {
    sum += value;
    worst = std::max(worst, value);
    ++count;
  }
  double mean() const { return count > 0 ? sum / count : 0; }
  std::string text(int digits) const {
    return count > 0 ? fmt::format("{:.{}f} ({:.{}f})", mean(), digits, worst, digits) : "-";
  }
};

using Measure = std::function<std::optional<double>(const RetargetVerdict&)>;

std::string meanAndWorst(std::span<const RetargetScore> scores, const JudgeColumn& column, int digits,
                         const Measure& measure) {
  MeanAndWorst summary;
  for (const RetargetScore& score : scores) {
    if (score.method != column.method || score.heldOut != column.heldOut || !score.verdict) continue;
    if (const std::optional<double> value = measure(*score.verdict)) summary.add(*value);
  }
  return summary.text(digits);
}

// Of all frames together.
std::string contactFraction(std::span<const RetargetScore> scores, const JudgeColumn& column) {
  ContactAgreement all;
  for (const RetargetScore& score : scores) {
    if (score.method != column.method || score.heldOut != column.heldOut || !score.verdict) continue;
    const ContactAgreement& contacts = score.verdict->contacts;
    all.found += contacts.found;
    all.foundRight += contacts.foundRight;
    all.meant += contacts.meant;
    all.meantFound += contacts.meantFound;
  }
  return fmt::format("{:.1f}, {:.1f}", 100 * all.precision(), 100 * all.recall());
}

std::string insideAgainstAligned(std::span<const RetargetScore> scores, const JudgeColumn& column) {
  double own = 0, aligned = 0;
  for (const RetargetScore& score : scores) {
    if (score.method != column.method || score.heldOut != column.heldOut || !score.verdict) continue;
    own += score.verdict->inside.value_or(0);
    aligned += score.verdict->alignedInside.value_or(0);
  }
  return aligned > 0 ? fmt::format("{:.2f}", own / aligned) : "-";
}

std::string framesPerSecond(std::span<const RetargetScore> scores, const JudgeColumn& column) {
  MeanAndWorst rate;
  for (const RetargetScore& score : scores) {
    if (score.method == column.method && score.heldOut == column.heldOut) rate.add(score.framesPerSecond);
  }
  return fmt::format("{:.0f}", rate.mean());
}

std::string worstAnswer(std::span<const AnswerScore> answers, const JudgeColumn& column, std::string_view change) {
  MeanAndWorst off;
  for (const AnswerScore& answer : answers) {
    if (answer.method == column.method && answer.heldOut == column.heldOut && answer.change == change) {
      off.add(kPerson * answer.error);
    }
  }
  return off.text(2);
}

std::string contactTable(const std::vector<std::string>& methods) {
  std::string table = "\n| contact of the body with itself |";
  for (const std::string& method : methods) table += fmt::format(" {} |", method);
  table += "\n|---|" + [&] {
    std::string line;
    for (std::size_t i = 0; i < methods.size(); ++i) line += "---|";
    return line;
  }() + "\n";
  for (const BodyContact& contact : bodyContacts()) {
    table += fmt::format("| {} |", contact.name);
    for (const std::string& method : methods) {
      const ContactScore score = scoreContact(findRetargetMethod(method), contact);
      table += fmt::format(" {:.0f} of {:.0f} (off by {:.1f} %); {:.0f} out of reach, {:.1f} % |", score.kept,
                           score.reached, 100 * score.worst, score.farReached, 100 * score.farWorst);
    }
    table += '\n';
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
  progress.stage("answers");
  const std::size_t all = trial.motions.size() + trial.characters.size();
  for (std::size_t i = 0; i < all; ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(all));
    const bool isCharacter = i >= trial.motions.size();
    const std::filesystem::path& file = isCharacter ? trial.characters[i - trial.motions.size()] : trial.motions[i];
    try {
      score(file, isCharacter);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add("unreadable-motions", "motions that cannot be read left out", error.what());
    }
  }
  progress.finish();
  return scores;
}

std::string judgeTable(std::span<const RetargetScore> scores, std::span<const AnswerScore> answers) {
  std::vector<std::string> methods;
  for (const RetargetScore& score : scores) {
    if (std::find(methods.begin(), methods.end(), score.method) == methods.end()) methods.push_back(score.method);
  }
  std::vector<JudgeColumn> columns;
  std::string table = "| measure |", line = "\n|---|";
  for (const std::string& method : methods) {
    for (const bool heldOut : {false, true}) {
      columns.push_back({method, heldOut});
      table += fmt::format(" {}, {} |", method, heldOut ? "held out" : "set by");
      line += "---|";
    }
  }
  table += line + '\n';
  const auto add = [&](std::string_view name, const std::function<std::string(const JudgeColumn&)>& cell) {
    table += fmt::format("| {} |", name);
    for (const JudgeColumn& column : columns) table += fmt::format(" {} |", cell(column));
    table += '\n';
  };
  const auto measure = [&](std::string_view name, int digits, const Measure& of) {
    add(name, [&](const JudgeColumn& column) { return meanAndWorst(scores, column, digits, of); });
  };
  measure("jerk of joint positions, times `aligned`", 2, [](const RetargetVerdict& v) { return v.jerk; });
  measure("its peaks, likewise", 2, [](const RetargetVerdict& v) { return v.jerkPeak; });
  measure("accelerations at contacts, likewise", 2, [](const RetargetVerdict& v) { return v.impact; });
  measure("sliding, heights/s", 3, [](const RetargetVerdict& v) { return v.sliding; });
  measure("the source's own", 3, [](const RetargetVerdict& v) { return v.sourceSliding; });
  add("contacts, precision and recall, %", [&](const JudgeColumn& column) { return contactFraction(scores, column); });
  measure("bone directions against `aligned` where nothing touches, p95, degrees", 1,
          [](const RetargetVerdict& v) { return v.bones95; });
  measure("surface inside the body, %", 2,
          [](const RetargetVerdict& v) { return v.inside ? std::optional(100 * *v.inside) : std::nullopt; });
  add("the same over that of `aligned`",
      [&](const JudgeColumn& column) { return insideAgainstAligned(scores, column); });
  for (const char* change : {"own", "renamed", "reposed", "scaled", "mirrored"}) {
    add(fmt::format("known answer, {}: off by, mm of 1.7 m", change),
        [&](const JudgeColumn& column) { return worstAnswer(answers, column, change); });
  }
  add("frames/s", [&](const JudgeColumn& column) { return framesPerSecond(scores, column); });
  return table + contactTable(methods);
}

std::string answersTsv(std::span<const AnswerScore> answers) {
  std::string text = "motion\tchange\tmethod\theld_out\terror_heights\n";
  for (const AnswerScore& answer : answers) {
    text += fmt::format("{}\t{}\t{}\t{}\t{:.7f}\n", answer.motion, answer.change, answer.method, answer.heldOut ? 1 : 0,
                        answer.error);
  }
  return text;
}

}  // namespace limber
