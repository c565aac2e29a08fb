#include "limber/batch/batch_run.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/batch/batch_record.h"
#include "limber/batch/batch_task.h"
#include "limber/core/error.h"
#include "limber/core/file/folder.h"
#include "limber/core/file/storage_error.h"
#include "limber/core/progress.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/utf8.h"
#include "limber/jobs/job_key.h"
#include "limber/jobs/job_pool.h"
#include "limber/study/command_words.h"
#include "limber/study/input_digest.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kThreads = "--threads";
constexpr std::size_t kMaxOutput = 1 << 16;  // bytes kept of what a command prints
constexpr double kPaceSpan = 60;             // seconds that the pace is taken over
constexpr double kTurn = 0.02;               // seconds that entries are looked at before those that run are

// Entries that ran, over the last while.
class Pace {
 public:
  void add(double now) {
    ended_.push_back(now);
    while (ended_.front() < now - kPaceSpan) ended_.pop_front();
  }
  double perSecond(double begun, double now) const {
    const double span = std::min(kPaceSpan, now - begun);
    const auto recent = std::count_if(ended_.begin(), ended_.end(), [&](double at) { return at >= now - span; });
    return span > 0 ? static_cast<double>(recent) / span : 0;
  }

 private:
  std::deque<double> ended_;
};

// A shard while it runs.
class BatchRun {
 public:
  BatchRun(const BatchPlan& plan, const BatchOptions& options)
      : plan_(plan),
        options_(options),
        prints_(std::find(plan.command.begin(), plan.command.end(), kBatchOutput) == plan.command.end()),
        tasks_(plan, options.program, options.adapterFolders),
        folder_{prepared()},
        records_(folder_.recordsOf(options.shard),
                 [&] {
                   if (options.waiting) options.waiting();
                 }),
        inputs_(plan.limits.memory) {
    removeFolder(unfinished());
    makeFolder(unfinished());
    known_ = readBatchRecords(folder_.records(), state_.recordWarnings);
    for (const auto& [output, record] : known_) number_ = std::max(number_, record.run + 1);
    for (std::size_t i = options.shard.number - 1; i < plan.entries.size(); i += options.shard.count) ++state_.entries;
    next_ = options.shard.number - 1;
  }

  BatchProgress run() {
    begun_ = secondsNow();
    runJobs([&] { return nextChain(); }, options_.jobs, [&] { tell(); },
            [&](std::size_t chain, const std::vector<JobResult>& results) {
              if (!results.empty()) take(chain, results.back());
            });
    removeFolder(unfinished());
    tell();
    return state_;
  }

 private:
  struct Open {  // an entry that runs
    BatchRecord record;
    fs::path work;  // a folder for its output alone

    fs::path made() const { return work / fs::path(record.output).filename(); }
    fs::path warnings() const { return fs::path(work) += ".json"; }
    fs::path temporary() const { return fs::path(work) += ".tmp"; }
  };

  // The folder, marked as a batch's before anything else is in it.
  fs::path prepared() {
    const BatchFolder folder{fs::absolute(options_.output).lexically_normal()};
    std::error_code unseen;
    const fs::file_status found = fs::status(folder.root, unseen);
    if (unseen == std::errc::not_a_directory || (fs::exists(found) && !fs::is_directory(found))) {
      throw Error(ErrorCode::kBadArgument, "is a file, or lies in one", folder.root.string(), "name a folder");
    }
    const bool isUsed = fs::exists(found) && !fs::is_empty(folder.root, unseen);
    // Another shard may be at this very point, or was ended at it: its own folder comes before all else.
    if (isUsed && !fs::exists(folder.own(), unseen)) {
      throw Error(ErrorCode::kBadArgument, "holds other files than a batch's", folder.root.string(),
                  "name a folder that is empty or new");
    }
    makeFolder(folder.records());
    writeFile(folder.plan(), asBytes(plannedOutputsText(plannedOutputs(plan_, tasks_))));
    return folder.root;
  }

  fs::path unfinished() const { return folder_.unfinished(options_.shard); }

  // All that the output depends on.
  static std::string keyOf(const BatchTask& task, const std::string& inputKey) {
    return JobKey().add("limber batch entry 2").add(task.digest).add(inputKey).hex();
  }

  // A file that cannot be read has others.
  static bool hasBytes(const fs::path& file, const std::string& sha256) {
    std::error_code unseen;
    try {
      return fs::is_regular_file(file, unseen) && sha256OfFile(file) == sha256;
    } catch (const Error&) {
      return false;
    }
  }

  // Is what is recorded of an entry what it would come to now?
  bool isSettled(const BatchRecord& record, const std::string& key) const {
    if (record.key != key) return false;
    const JobLimits &now = plan_.limits, &then = record.limits;
    switch (record.outcome) {
      case JobOutcome::kDone:
        return hasBytes(folder_.root / record.output, record.outputSha256);
      case JobOutcome::kFailed:
        return !options_.retries;
      case JobOutcome::kTimedOut:
        return !options_.retries && now.seconds <= then.seconds;
      case JobOutcome::kOutOfMemory:
        return !options_.retries && now.memory <= then.memory;
      default:
        return false;
    }
  }

  // Why no file can be put there; empty where there is no obstacle.
  static std::string obstacleAt(const fs::path& location) {
    std::error_code problem;
    const fs::file_status found = fs::symlink_status(location, problem);
    if (fs::is_directory(found)) return "a folder lies where the output is to be";
    return problem == std::errc::not_a_directory ? "a file lies where the output's folder is to be" : "";
  }

  // Computes digests of the entry's files. Returns what is wrong with these or with its output's path, else empty.
  std::string identify(const BatchEntry& entry, BatchRecord& record) {
    const fs::path input = plan_.folder / entry.input;
    const BatchTask task = tasks_.of(entry);
    record.task = task.digest;
    if (std::string obstacle = obstacleAt(folder_.root / entry.output); !obstacle.empty()) return obstacle;
    try {
      if (task.problem) throw *task.problem;
      const InputDigest digest = inputs_.of(input);
      record.inputSha256 = digest.bytes;
      record.key = keyOf(task, digest.all);
    } catch (const Error& error) {  // without the input's own name, so that alike failures read alike
      return validUtf8(error.where() == input.string() ? error.message() : error.what());
    } catch (const std::bad_alloc&) {
      return "takes more memory to be looked at than there is";
    } catch (const std::exception& error) {
      return validUtf8(error.what());
    }
    const bool isWanted = entry.sha256.empty() || entry.sha256 == record.inputSha256;
    return isWanted ? "" : "has other bytes than the plan says";
  }

  // The next entry that is to run; an empty chain after a while without one.
  std::optional<JobChain> nextChain() {
    const double turnEnd = secondsNow() + kTurn;
    while (next_ < plan_.entries.size()) {
      if (secondsNow() > turnEnd) {
        ++begunChains_;
        return JobChain{};
      }
      const BatchEntry& entry = plan_.entries[next_];
      next_ += options_.shard.count;
      BatchRecord record;
      record.input = entry.input;
      record.output = entry.output;
      record.run = number_;
      record.limits = plan_.limits;
      if (record.problem = identify(entry, record); !record.problem.empty()) {
        record.outcome = JobOutcome::kFailed;
        keep(std::move(record));
        continue;
      }
      if (const auto known = known_.find(entry.output); known != known_.end() && isSettled(known->second, record.key)) {
        ++state_.kept;
        ++(known->second.outcome == JobOutcome::kDone ? state_.done : state_.failed);
        continue;
      }
      Open open{std::move(record), unfinished() / std::to_string(begunChains_)};
      Job job = jobOf(entry, open);
      open_.emplace(begunChains_++, std::move(open));
      return JobChain{std::move(job)};
    }
    return std::nullopt;
  }

  Job jobOf(const BatchEntry& entry, const Open& open) const {
    makeFolder(open.work);
    makeFolder(open.temporary());
    std::vector<std::string> arguments;
    for (const std::string& word : plan_.command) {
      arguments.push_back(word == kBatchInput    ? (plan_.folder / entry.input).string()
                          : word == kBatchOutput ? open.made().string()
                                                 : word);
    }
    arguments.insert(arguments.end(), entry.options.begin(), entry.options.end());
    const bool saysThreads = std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
      return argument.substr(0, argument.find('=')) == kThreads;
    });
    for (const fs::path& folder : options_.adapterFolders) {
      if (options_.takesAdapters) arguments.insert(arguments.end(), {"--adapter-folder", folder.string()});
    }
    if (options_.takesThreads && !saysThreads) arguments.insert(arguments.end(), {std::string(kThreads), "1"});
    Job job;
    job.folder = plan_.folder;
    job.limits = plan_.limits;
    job.maxOutput = kMaxOutput;
    if (options_.outOfMemoryCode != 0) job.outOfMemoryCode = options_.outOfMemoryCode;
    job.work = [this, arguments, made = open.made(), warnings = open.warnings(), temporary = open.temporary()] {
      setenv("TMPDIR", temporary.c_str(), 1);
      return runInChild(arguments, made, warnings);
    };
    return job;
  }

  int runInChild(const std::vector<std::string>& arguments, const fs::path& made, const fs::path& warningsFile) const {
    BatchWarnings warnings;
    try {
      if (prints_ && !std::freopen(made.c_str(), "wb", stdout)) failToWrite(made, errno);
      const int code = options_.command(arguments, made, warnings);
      if (prints_ && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)) failToWrite(made, errno);
      if (code == 0 && !warnings.empty()) writeFile(warningsFile, asBytes(dumpReport(Json(warnings))));
      return code;
    } catch (const Error& error) {
      fmt::print(stderr, "{}{}\n", kSpeaker, error.what());
      return options_.storageCode;
    }
  }

  static BatchWarnings warningsIn(const fs::path& file) {
    std::error_code unseen;
    if (!fs::exists(file, unseen)) return {};
    const Bytes bytes = readFile(file);
    Warnings ignored;
    return parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, ignored).get<BatchWarnings>();
  }

  // What the command said last, with the entry's own names taken out, so that alike failures read alike.
  std::string wordsOf(const std::string& text, const Open& open) const {
    std::string words = commandWords(text);
    const fs::path input = plan_.folder / open.record.input;
    for (const auto& [name, by] : {std::pair{open.made(), kBatchOutput},
                                   {open.work / "", ""},
                                   {input, kBatchInput},
                                   {input.filename(), kBatchInput}}) {
      words = replaced(std::move(words), validUtf8(name.string()), by);
    }
    return words;
  }

  std::string problemOf(const JobResult& result, const Open& open) const {
    const std::string words = wordsOf(result.error, open);
    if (result.outcome == JobOutcome::kFailed && !words.empty()) return words;
    Job job;
    job.limits = plan_.limits;
    return jobOutcomeText(job, result) + (words.empty() ? "" : ": " + words);
  }

  void take(std::size_t chain, const JobResult& result) {
    Open open = std::move(open_.extract(chain).mapped());
    BatchRecord& record = open.record;
    record.outcome = result.outcome;
    record.seconds = result.seconds;
    record.peakMemory = result.peakMemory;
    if (result.outcome == JobOutcome::kFailed && result.code == options_.storageCode) {
      throw Error(ErrorCode::kFile, commandWords(result.error), {},
                  "mend that and call it again: it goes on from here");
    }
    if (result.outcome == JobOutcome::kDone) {
      record.problem = problemWithOutput(open);
      if (!record.problem.empty()) record.outcome = JobOutcome::kFailed;
    } else {
      record.problem = problemOf(result, open);
    }
    if (record.outcome == JobOutcome::kDone) takeOutput(open);
    pace_.add(secondsNow());
    keep(std::move(record));
    removeFolder(open.work);
    removeFolder(open.temporary());
    std::error_code unseen;
    fs::remove(open.warnings(), unseen);
  }

  // Why the output cannot be accepted; empty where it can.
  static std::string problemWithOutput(const Open& open) {
    const fs::path made = open.made();
    std::error_code unseen;
    if (!fs::is_regular_file(made, unseen) || fs::file_size(made, unseen) == 0) return "the command wrote no output";
    for (const fs::path& file : filesBelow(open.work)) {
      if (file == made) continue;
      return fmt::format("the command wrote '*{}' beside its output, which would be lost (take a format of one file)",
                         validUtf8(file.extension().string()));
    }
    return {};
  }

  void takeOutput(Open& open) const {
    BatchRecord& record = open.record;
    const fs::path made = open.made(), location = folder_.root / record.output;
    record.outputSha256 = sha256OfFile(made);
    record.warnings = warningsIn(open.warnings());
    std::error_code problem;
    makeFolder(location.parent_path());
    fs::rename(made, location, problem);
    if (problem) failToWrite(location, problem.value());
  }

  void keep(BatchRecord record) {
    ++(record.outcome == JobOutcome::kDone ? state_.done : state_.failed);
    records_.append(record);
  }

  void tell() {
    const double now = secondsNow();
    state_.seconds = now - begun_;
    state_.perSecond = pace_.perSecond(begun_, now);
    const std::size_t left = state_.entries - state_.done - state_.failed;
    state_.secondsLeft = state_.perSecond > 0 ? static_cast<double>(left) / state_.perSecond : 0;
    if (options_.tell) options_.tell(state_);
  }

  const BatchPlan& plan_;
  const BatchOptions& options_;
  bool prints_;  // its output, rather than writing a file
  BatchTasks tasks_;
  BatchFolder folder_;
  BatchRecordFile records_;
  std::map<std::string, BatchRecord> known_;  // by output
  InputDigests inputs_;
  std::map<std::size_t, Open> open_;  // by the number of their chain
  std::size_t number_ = 1;            // of this run
  std::size_t next_ = 0, begunChains_ = 0;
  BatchProgress state_;
  Pace pace_;
  double begun_ = 0;
};

}  // namespace

fs::path BatchFolder::recordsOf(const BatchShard& shard) const {
  return records() / fmt::format("{}-of-{}.jsonl", shard.number, shard.count);
}

fs::path BatchFolder::unfinished(const BatchShard& shard) const {
  return own() / fmt::format("unfinished-{}-of-{}", shard.number, shard.count);
}

BatchProgress runBatch(const BatchPlan& plan, const BatchOptions& options) {
  return BatchRun(plan, options).run();
}

}  // namespace limber
