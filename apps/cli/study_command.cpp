// limber study: methods side by side over many models, as tables and as a page.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "adapter_arguments.h"
#include "command.h"
#include "limber/core/counted.h"
#include "limber/core/file/file.h"
#include "limber/core/parallel.h"
#include "limber/jobs/own_program.h"
#include "limber/study/report/cell_table.h"
#include "limber/study/report/report_page.h"
#include "limber/study/report/study_summary.h"
#include "limber/study/study_run.h"
#include "progress_line.h"
#include "vote_files.h"

namespace limber::cli {

namespace {

struct StudyArguments {
  std::string plan, output;
  std::vector<std::string> votes;
  int jobs = 0;  // 0: as many as there are processors for
  bool retries = false, noTimes = false, prints = false, quiet = false;
  AdapterArguments adapters;
};

StudyPlan readPlan(const std::string& file, const AdapterArguments& adapters) {
  return parsedFile(file, [&](std::string_view text) { return studyPlanFromJson(text, adapters.allFolders()); });
}

void writeReport(const StudyResult& study, std::span<const Vote> votes, const std::filesystem::path& folder,
                 const SummaryOptions& options) {
  const std::string csv = cellsCsv(study), json = cellsJson(study),
                    page = reportPage(study, folder, rankByVotes(votes)), summary = studySummary(study, options);
  const OutputFile files[] = {{folder / "cells.csv", asBytes(csv)},
                              {folder / "cells.json", asBytes(json)},
                              {folder / "summary.md", asBytes(summary)},
                              {folder / "index.html", asBytes(page)}};
  writeFiles(files);
}

// How far it is: on a terminal in the line of the progress, elsewhere a line for each tenth of the cells, for logs.
class StudyLine {
 public:
  StudyLine(bool quiet, TerminalProgress& progress)
      : isLog_(!quiet && isatty(STDERR_FILENO) == 0), progress_(progress) {}

  void show(const StudyProgress& at) {
    std::string text = fmt::format("cell {} of {}", at.done, at.cells);
    if (at.secondsLeft > 0) text += fmt::format(", about {} left", timeText(at.secondsLeft));
    progress_.describe(text);
    if (!isBegun_) {
      isBegun_ = true;
      shown_ = at.done;
    }
    const std::size_t step = std::max<std::size_t>(1, at.cells / 10);
    if (!isLog_ || at.done == at.cells || at.done < shown_ + step) return;
    shown_ = at.done;
    fmt::print(stderr, "{}\n", text);
    std::fflush(stderr);
  }

 private:
  bool isLog_, isBegun_ = false;
  TerminalProgress& progress_;
  std::size_t shown_ = 0;  // cells done at the last line
};

void run(const StudyArguments& arguments) {
  if (arguments.prints) {
    fmt::print("{}", exampleStudyPlan());
    return;
  }
  if (arguments.plan.empty()) throw CLI::RequiredError("PLAN");
  if (arguments.output.empty()) throw CLI::RequiredError("--output");
  const StudyPlan plan = readPlan(arguments.plan, arguments.adapters);
  const std::vector<Vote> allVotes = readVotes(arguments.votes);
  StudyOptions options;
  options.program = ownProgram();
  options.planFolder =
      arguments.plan == "-" ? std::filesystem::path() : std::filesystem::path(arguments.plan).parent_path();
  options.output = arguments.output;
  options.jobs = arguments.jobs > 0 ? arguments.jobs : std::max(1, threadCount() / std::max(1, plan.threads));
  options.outOfMemoryCode = kOutOfMemoryCode;
  options.retries = arguments.retries;
  TerminalProgress progress(arguments.quiet);
  StudyLine line(arguments.quiet, progress);
  options.tell = [&](const StudyProgress& at) { line.show(at); };
  const StudyResult study = runStudy(plan, options, *progress);
  progress.describe({});
  progress->stage("write");
  const std::vector<Vote> votes = votesOn(study.cells, allVotes);
  writeReport(study, votes, options.output, {!arguments.noTimes});
  progress.finish();
  Warnings skipped;
  if (votes.size() < allVotes.size()) {
    skipped.add("votes-on-other-results", "votes left out that are on results of other studies", {},
                allVotes.size() - votes.size());
  }
  printWarnings(skipped, arguments.quiet);
  const auto failed = std::count_if(study.results.begin(), study.results.end(),
                                    [](const CellResult& result) { return result.outcome != JobOutcome::kDone; });
  const Account account(arguments.quiet, {});
  account.line(fmt::format("{}: {} run, {} kept from before; {} did not end well", counted(study.cells.size(), "cell"),
                           study.ran, study.cells.size() - study.ran, failed));
  account.line(fmt::format("written: {}", (options.output / "index.html").string()));
}

}  // namespace

void addStudyCommand(CLI::App& program) {
  auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = program.add_subcommand("study", "Compare methods over many models, in tables and on a page");
  command->add_option("PLAN", arguments->plan,
                      "what to compare, in JSON (docs/study.schema.json); - is standard input");
  command->add_option("-o,--output", arguments->output, "the folder to write; a study that was stopped there goes on")
      ->type_name("FOLDER");
  command->add_option("--jobs", arguments->jobs, "cells at once (default: as many as there are processors for)")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
  command->add_option("--votes", arguments->votes, "votes.csv files that this study's page saved: rank by them as well")
      ->type_name("FILE");
  arguments->adapters.addFolderTo(*command);
  command->add_flag("--retry", arguments->retries, "run again what crashed, was refused or ran out of time or memory");
  command->add_flag("--no-times", arguments->noTimes,
                    "leave times out of summary.md, which is then the same each time");
  command->add_flag("--example", arguments->prints, "print a plan that runs as it is");
  command->add_flag("--quiet,-q", arguments->quiet, "print nothing but errors");
  command->footer(
      "Each cell (a method on a model) is a process of its own, within limits of time and memory; its result is kept\n"
      "in FOLDER/cells under a hash of the program, the arguments and the model's bytes. So a study that was stopped\n"
      "goes on, and another method costs its own cells alone. FOLDER/cells.csv and cells.json have a line for each\n"
      "cell and measure; FOLDER/index.html shows rankings, tests, the worst cells and all pictures, and\n"
      "has a blind ballot whose votes --votes ranks; FOLDER/summary.md has the medians and which methods the tests\n"
      "tell apart, to quote. docs/study.md tells more.\n"
      "\nExamples:\n"
      "  limber study --example > plan.json\n"
      "  limber study plan.json -o report\n"
      "  limber study plan.json -o report --votes anna.csv ben.csv");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace limber::cli
