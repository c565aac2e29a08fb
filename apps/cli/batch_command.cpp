// limber batch: one command done to many files, and how far that is.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "adapter_arguments.h"
#include "command.h"
#include "limber/batch/batch_run.h"
#include "limber/batch/batch_status.h"
#include "limber/core/counted.h"
#include "limber/core/file/file.h"
#include "limber/core/parallel.h"
#include "limber/document/gltf/json_text.h"
#include "limber/jobs/own_program.h"
#include "program.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

// Those that make one file of one.
constexpr std::string_view kBatchCommands[] = {"rig",  "animate",  "retarget", "convert", "preview",
                                               "pose", "transfer", "evaluate", "info"};
constexpr double kMegabyte = 1 << 20;
constexpr std::size_t kMaxTrials = 100;  // lists of options, for one with which a command makes sense
constexpr int kWrongCode = 2, kStoppedCode = kStorageCode;  // exit codes: a wrong call; the batch could not go on

struct BatchArguments {
  std::string plan, output, shard = "1/1";
  AdapterArguments adapters;
  int jobs = 0;  // 0: as many as there are processors for
  bool retries = false, prints = false, quiet = false;
};

struct BatchStatusArguments {
  std::string folder, merged;
  bool json = false, quiet = false;
};

// One line on a terminal; elsewhere a line now and then, for logs.
class BatchLine {
 public:
  explicit BatchLine(bool quiet) : isQuiet_(quiet), isTerminal_(isatty(STDERR_FILENO) != 0) {}

  void show(const BatchProgress& at) {
    const double pause = isTerminal_ ? 0.2 : 30;  // seconds
    if (isQuiet_ || at.seconds - shownAt_ < pause) return;
    shownAt_ = at.seconds;
    std::string text = fmt::format("{} of {}, {} failed", at.done + at.failed, at.entries, at.failed);
    if (at.perSecond > 0) {
      text += fmt::format(", {:.3g} a second, about {} left", at.perSecond, timeText(at.secondsLeft));
    }
    fmt::print(stderr, "{}{}{}", isTerminal_ ? "\r" : "", text, isTerminal_ ? "\x1b[K" : "\n");
    std::fflush(stderr);
    isShown_ = true;
  }
  void clear() const {
    if (isShown_ && isTerminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool isQuiet_, isTerminal_, isShown_ = false;
  double shownAt_ = 0;
};

// In a child of the batch.
int runInChild(const std::vector<std::string>& arguments, const BatchCall& call, BatchWarnings& warnings) {
  const int code = runProgram(arguments, &call);
  for (const Warning& warning : givenWarnings().items()) warnings.emplace_back(warning.kind, warning.count);
  return code;
}

// Of the plan's command; where it makes no sense alone, with the options of the first entry with which it does. Throws
// Error kBadData where it makes none with those of many entries either: no entry could be done.
CallOutline outlineOf(const BatchPlan& plan) {
  const BatchCall call{std::string(kBatchOutput)};
  CallOutline outline = outlineCall(plan.command, call);
  std::set<std::vector<std::string>> tried;
  for (auto entry = plan.entries.begin();
       !outline.problem.empty() && entry != plan.entries.end() && tried.size() < kMaxTrials; ++entry) {
    if (entry->options.empty() || !tried.insert(entry->options).second) continue;
    std::vector<std::string> words = plan.command;
    words.insert(words.end(), entry->options.begin(), entry->options.end());
    CallOutline withOptions = outlineCall(words, call);
    if (withOptions.problem.empty()) outline = std::move(withOptions);
  }
  if (outline.problem.empty() && outline.hasOutput &&
      std::find(plan.command.begin(), plan.command.end(), kBatchOutput) == plan.command.end()) {
    outline.problem = fmt::format("does not hold \"{}\", as an element of its own", kBatchOutput);
  }
  if (!outline.problem.empty()) throw Error(ErrorCode::kBadData, outline.problem, "command");
  return outline;
}

// Not everything is done: said by the exit code, beside the account.
void failUnless(bool isWell, std::string_view what) {
  if (!isWell) throw Error(ErrorCode::kBadData, std::string(what), {}, "limber batch status tells which and why");
}

// What ends `work`, but for cancelling and want of memory, ends the program with this exit code; a wrong call with its
// own.
template <typename Work>
auto withExitCode(int code, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    const auto* known = dynamic_cast<const Error*>(&error);
    if (known && known->code() == ErrorCode::kCancelled) throw;
    throw CLI::RuntimeError(error.what(), known && known->code() == ErrorCode::kBadArgument ? kWrongCode : code);
  }
}

void runPlan(const BatchArguments& arguments) {
  if (arguments.prints) {
    fmt::print("{}", exampleBatchPlan());
    return;
  }
  if (arguments.plan.empty()) throw CLI::RequiredError("PLAN");
  if (arguments.output.empty()) throw CLI::RequiredError("--output");
  BatchOptions options;
  const BatchPlan plan = withExitCode(kWrongCode, [&] {
    options.shard = parseBatchShard(arguments.shard);
    BatchPlan read = readBatchPlan(arguments.plan, kBatchCommands, arguments.output);
    try {
      const CallOutline outline = outlineOf(read);
      options.takesThreads = outline.hasThreads;
      options.takesAdapters = outline.hasAdapters;
    } catch (const Error& error) {
      throw error.within(arguments.plan == "-" ? "standard input" : arguments.plan);
    }
    return read;
  });
  options.output = arguments.output;
  options.jobs = arguments.jobs > 0 ? arguments.jobs : std::max(1, threadCount());
  options.outOfMemoryCode = kOutOfMemoryCode;
  options.storageCode = kStorageCode;
  options.retries = arguments.retries;
  for (const std::filesystem::path& folder : arguments.adapters.allFolders()) {
    options.adapterFolders.push_back(std::filesystem::absolute(folder).lexically_normal());
  }
  options.command = [&options](const std::vector<std::string>& words, const std::filesystem::path& output,
                               BatchWarnings& warnings) {
    return runInChild(words, {output.string(), options.adapterFolders}, warnings);
  };
  TerminalProgress cancel(true);
  BatchLine line(arguments.quiet);
  options.waiting = [&, isReported = arguments.quiet]() mutable {
    cancel->update(0);
    if (!std::exchange(isReported, true))
      fmt::print(stderr, "another program is at this shard: its end is waited for\n");
  };
  options.tell = [&](const BatchProgress& at) {
    cancel->update(0);
    line.show(at);
  };
  const BatchProgress end = withExitCode(kStoppedCode, [&] {
    options.program = ownProgram();
    return runBatch(plan, options);
  });
  line.clear();
  printWarnings(end.recordWarnings, arguments.quiet);
  Account(arguments.quiet, {})
      .line(fmt::format("{}: {} run in {}, {} kept from before; {} failed", counted(end.entries, "entry", "entries"),
                        end.done + end.failed - end.kept, timeText(end.seconds), end.kept, end.failed));
  failUnless(end.failed == 0, counted(end.failed, "entry", "entries") + " failed");
}

Json toJson(const BatchStatus& status) {
  Json failures = Json::array(), warnings = Json::object();
  for (const BatchFailures& one : status.failures) {
    failures.push_back({{"outcome", jobOutcomeName(one.outcome)},
                        {"problem", one.problem},
                        {"count", one.count},
                        {"example", one.example}});
  }
  for (const auto& [kind, count] : status.warnings) warnings[kind] = count;
  return {{"entries", status.entries},
          {"done", status.done},
          {"failed", status.failed},
          {"open", status.open()},
          {"lost", status.lost},
          {"outdated", status.outdated},
          {"left_over", status.leftOver},
          {"seconds", status.seconds},
          {"slowest", status.slowest},
          {"peak_memory", status.peakMemory},
          {"failures", std::move(failures)},
          {"warnings", std::move(warnings)},
          {"record_warnings", toJson(status.recordWarnings)}};
}

void tell(const BatchStatus& status, const Account& account) {
  account.line(fmt::format("{}: {} done, {} failed, {} open", counted(status.entries, "entry", "entries"), status.done,
                           status.failed, status.open()));
  if (status.lost > 0) account.line(fmt::format("{} whose output is gone", counted(status.lost, "entry", "entries")));
  if (status.outdated > 0) {
    account.line(fmt::format("{} done or failed by another command or program than the latest run's",
                             counted(status.outdated, "entry", "entries")));
  }
  if (!status.leftOver.empty()) {
    account.line(fmt::format("{} of earlier plans still there (such as {})", counted(status.leftOver.size(), "output"),
                             status.leftOver.front()));
  }
  account.line(fmt::format("{} of work, the slowest {:.2f} s, at most {:.0f} MB", timeText(status.seconds),
                           status.slowest, static_cast<double>(status.peakMemory) / kMegabyte));
  for (const BatchFailures& one : status.failures) {
    account.line(
        fmt::format("  {:>7} {}: {} (such as {})", one.count, jobOutcomeName(one.outcome), one.problem, one.example));
  }
  for (const auto& [kind, count] : status.warnings) {
    account.line(fmt::format("  {:>7} with warning {}", count, kind));
  }
}

void runStatus(const BatchStatusArguments& arguments) {
  if (arguments.json && arguments.merged == "-") {
    throw CLI::ValidationError("--merge", "to standard output does not go with --json, which prints there, too");
  }
  const BatchStatus status = batchStatus(arguments.folder);
  printWarnings(status.recordWarnings, arguments.quiet);
  if (!arguments.merged.empty()) writeFile(arguments.merged, asBytes(mergedBatchRecords(arguments.folder)));
  if (arguments.json) {
    printJson(toJson(status));
  } else {
    tell(status, Account(arguments.quiet, arguments.merged));
  }
  failUnless(status.isWell(), fmt::format("{} of {} are not done", status.entries - status.done,
                                          counted(status.entries, "entry", "entries")));
}

void addStatus(CLI::App& batch) {
  auto arguments = std::make_shared<BatchStatusArguments>();
  CLI::App* command = batch.add_subcommand("status", "How far a batch is, and what failed, over all its shards");
  command->add_option("FOLDER", arguments->folder, "the folder of outputs")->required();
  command
      ->add_option("--merge", arguments->merged, "write the records of all shards as one file, a line for each entry")
      ->type_name("FILE");
  command->add_flag("--json{true}", arguments->json, "print the account as JSON");
  command->add_flag("--quiet,-q", arguments->quiet, "print nothing but errors");
  command->footer(
      "Exit code 0 where every entry of the plan is done and its output there.\n"
      "\nExample:\n"
      "  limber batch status out --merge records.jsonl");
  command->callback([arguments] { runStatus(*arguments); });
}

}  // namespace

void addBatchCommand(CLI::App& program) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* command = program.add_subcommand("batch", "Do one command to many files; go on where it was stopped");
  command->add_option("PLAN", arguments->plan, "what to do, in JSON (docs/batch.schema.json); - is standard input");
  command->add_option("-o,--output", arguments->output, "the folder to write; a batch that was stopped there goes on")
      ->type_name("FOLDER");
  command->add_option("--shard", arguments->shard, "only this part of the entries: its number, and how many there are")
      ->type_name("I/N")
      ->capture_default_str();
  command->add_option("--jobs", arguments->jobs, "entries at once (default: as many as there are processors for)")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
  command->add_flag("--retry", arguments->retries, "do again what failed");
  arguments->adapters.addFolderTo(*command);
  command->add_flag("--example", arguments->prints,
                    "print a plan that runs as it is, in a folder of models without rigs");
  command->add_flag("--quiet,-q", arguments->quiet, "print nothing but errors");
  command->require_subcommand(0, 1);
  addStatus(*command);
  command->footer(fmt::format(
      "Commands: {}. What one without -o prints\n"
      "is the output.\n"
      "Each entry is a process of its own, within limits of time and memory: what is damaged, endless or huge costs\n"
      "itself alone. Outputs come to their places whole, and a line for each stands in FOLDER/.limber-batch/records:\n"
      "its outcome, seconds, memory, warnings, hashes. A batch that was stopped, however it was, goes on; what has "
      "the\n"
      "same bytes, command and program is not done again. docs/scale.md tells more.\n"
      "\nExit code 0 where all is done, 1 where some entries failed, 2 where the plan or the call is wrong,\n"
      "4 where the batch itself could not go on: its folder cannot be written, or no process started.\n"
      "\nExamples:\n"
      "  mkdir library\n"
      "  limber sample biped -o library/person.glb\n"
      "  limber batch --example > library/plan.json\n"
      "  limber batch library/plan.json -o out\n"
      "  limber batch library/plan.json -o out --shard 3/16\n"
      "  limber batch status out",
      fmt::join(kBatchCommands, ", ")));
  command->callback([command, arguments] {
    if (command->get_subcommands().empty()) runPlan(*arguments);
  });
}

}  // namespace limber::cli
