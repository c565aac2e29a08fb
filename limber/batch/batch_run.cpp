#include "limber/batch/batch_run.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/asset/utf8.h"
#include "limber/batch/batch_record.h"
#include "limber/core/error.h"
#include "limber/core/folder.h"
#include "limber/core/progress.h"
#include "limber/jobs/job_key.h"
#include "limber/jobs/job_pool.h"
#include "limber/jobs/last_line.h"
#include "limber/study/input_digest.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kWarningsFile = "warnings.json", kThreads = "--threads", kSpeaker = "limber: ";
constexpr std::size_t kMostProblem = 1000;    // bytes of a command's own words
constexpr std::size_t kMostOutput = 1 << 16;  // bytes kept of what a command prints
constexpr double kPaceSpan = 60;              // seconds that the pace is taken over
constexpr double kTurn = 0.02;                // seconds that entries are looked at before those that run are
constexpr int kNoWarningsCode = 1;

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
        folder_{prepared(plan, options)},
        records_(folder_.recordsOf(options.shard),
                 [&] {
                   if (options.waiting) options.waiting();
                 }),
        inputs_(plan.limits.memory) {
    removeFolder(unfinished());
    makeFolder(unfinished());
    known_ = readBatchRecords(folder_.records());
    for (const auto& [output, record] : known_) number_ = std::max(number_, record.run + 1);
    program_ = sha256OfFile(options.program);
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
    fs::path work;  // a folder of its own, for its output and warnings
  };

  // The folder, marked as a batch's before anything else is in it.
  static fs::path prepared(const BatchPlan& plan, const BatchOptions& options) {
    const BatchFolder folder{fs::absolute(options.output).lexically_normal()};
    std::error_code unseen;
    const bool isUsed = fs::exists(folder.root, unseen) && !fs::is_empty(folder.root, unseen);
    // Another shard may be at this very point, or was ended at it: its own folder comes before all else.
    if (isUsed && !fs::exists(folder.own(), unseen)) {
      throw Error(ErrorCode::kFile, "holds other files than a batch's", folder.root.string(),
                  "name a folder that is empty or new");
    }
    makeFolder(folder.records());
    Json outputs = Json::array();
    for (const BatchEntry& entry : plan.entries) outputs.push_back(entry.output);
    writeFile(folder.plan(), asBytes(dumpReport({{"limber_batch", 1}, {"outputs", std::move(outputs)}}, 0) + "\n"));
    return folder.root;
  }

  fs::path unfinished() const { return folder_.unfinished(options_.shard); }

  // All that the output depends on. Files that the command names besides count with their bytes.
  std::string keyOf(const BatchEntry& entry, const std::string& inputKey) {
    JobKey key;
    key.add("limber batch entry 1").add(program_).add(inputKey);
    for (const std::string& argument : plan_.command) key.add(argument).add(digestBeside(argument));
    key.add("options");
    for (const std::string& option : entry.options) key.add(option).add(digestBeside(option));
    return key.hex();
  }

  // Of the file that the argument names, by itself or as --name=file; empty where it names none.
  std::string digestBeside(const std::string& argument) {
    if (const auto known = beside_.find(argument); known != beside_.end()) return known->second;
    const std::size_t equals = argument.starts_with("--") ? argument.find('=') : std::string::npos;
    const fs::path named = equals == std::string::npos ? argument : argument.substr(equals + 1);
    std::error_code unseen;
    std::string digest;
    if (!named.empty() && fs::is_regular_file(plan_.folder / named, unseen)) {
      digest = inputs_.of(plan_.folder / named).all;
    }
    return beside_.emplace(argument, std::move(digest)).first->second;
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

  // Digests of the entry's files; what is wrong with these, empty where nothing is.
  std::string identify(const BatchEntry& entry, BatchRecord& record) {
    const fs::path input = plan_.folder / entry.input;
    try {
      const InputDigest digest = inputs_.of(input);
      record.inputSha256 = digest.bytes;
      record.key = keyOf(entry, digest.all);
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
      open_.emplace(begunChains_, Open{std::move(record), unfinished() / std::to_string(begunChains_)});
      return JobChain{jobOf(entry, open_.at(begunChains_++).work)};
    }
    return std::nullopt;
  }

  Job jobOf(const BatchEntry& entry, const fs::path& work) const {
    makeFolder(work);
    std::vector<std::string> arguments;
    for (const std::string& word : plan_.command) {
      arguments.push_back(word == kBatchInput    ? (plan_.folder / entry.input).string()
                          : word == kBatchOutput ? (work / fs::path(entry.output).filename()).string()
                                                 : word);
    }
    arguments.insert(arguments.end(), entry.options.begin(), entry.options.end());
    const bool saysThreads = std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
      return argument.substr(0, argument.find('=')) == kThreads;
    });
    if (!saysThreads) arguments.insert(arguments.end(), {std::string(kThreads), "1"});
    Job job;
    job.folder = plan_.folder;
    job.limits = plan_.limits;
    job.mostOutput = kMostOutput;
    if (options_.outOfMemoryCode != 0) job.outOfMemoryCode = options_.outOfMemoryCode;
    job.work = [&command = options_.command, arguments, work] {
      BatchWarnings warnings;
      const int code = command(arguments, warnings);
      if (code != 0 || warnings.empty()) return code;
      try {
        writeFile(work / kWarningsFile, asBytes(dumpReport(Json(warnings))));
      } catch (const Error& error) {
        fmt::print(stderr, "{}{}\n", kSpeaker, error.what());
        return kNoWarningsCode;
      }
      return 0;
    };
    return job;
  }

  static BatchWarnings warningsIn(const fs::path& file) {
    std::error_code unseen;
    if (!fs::exists(file, unseen)) return {};
    const Bytes bytes = readFile(file);
    Warnings ignored;
    return parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, ignored).get<BatchWarnings>();
  }

  // What the command said last, with the input's name taken out, so that alike failures read alike.
  static std::string wordsOf(const std::string& text, const fs::path& input) {
    const std::string line = validUtf8(lastLine(text, kMostProblem));
    std::string words = line.starts_with(kSpeaker) ? line.substr(kSpeaker.size()) : line;
    for (const std::string& name : {validUtf8(input.string()), validUtf8(input.filename().string())}) {
      for (std::size_t at = 0; (at = words.find(name, at)) != std::string::npos; at += kBatchInput.size()) {
        words.replace(at, name.size(), kBatchInput);
      }
    }
    return words;
  }

  std::string problemOf(const JobResult& result, const fs::path& input) const {
    const std::string words = wordsOf(result.error, input);
    if (result.outcome == JobOutcome::kFailed && !words.empty()) return words;
    Job job;
    job.limits = plan_.limits;
    return jobOutcomeText(job, result) + (words.empty() ? "" : ": " + words);
  }

  void take(std::size_t chain, const JobResult& result) {
    auto node = open_.extract(chain);
    BatchRecord& record = node.mapped().record;
    const fs::path work = node.mapped().work, made = work / fs::path(record.output).filename();
    record.outcome = result.outcome;
    record.seconds = result.seconds;
    record.peakMemory = result.peakMemory;
    if (result.outcome == JobOutcome::kDone) {
      takeOutput(work, made, record);
    } else {
      record.problem = problemOf(result, plan_.folder / record.input);
    }
    pace_.add(secondsNow());
    keep(std::move(record));
    removeFolder(work);
  }

  void takeOutput(const fs::path& work, const fs::path& made, BatchRecord& record) const {
    std::error_code problem;
    if (!fs::is_regular_file(made, problem)) {
      record.outcome = JobOutcome::kFailed;
      record.problem = "the command wrote no output";
      return;
    }
    record.outputSha256 = sha256OfFile(made);
    record.warnings = warningsIn(work / kWarningsFile);
    const fs::path place = folder_.root / record.output;
    makeFolder(place.parent_path());
    fs::rename(made, place, problem);
    if (problem) throw Error(ErrorCode::kFile, "cannot be written: " + problem.message(), place.string());
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
  BatchFolder folder_;
  BatchRecordFile records_;
  std::map<std::string, BatchRecord> known_;  // by output
  std::string program_;                       // its digest
  InputDigests inputs_;
  std::map<std::string, std::string> beside_;  // digests of files that the command names, by argument
  std::map<std::size_t, Open> open_;           // by the number of their chain
  std::size_t number_ = 1;                     // of this run
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
