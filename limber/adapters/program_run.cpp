#include "limber/adapters/program_run.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/file/folder.h"
#include "limber/core/text/split_text.h"
#include "limber/document/utf8.h"
#include "limber/jobs/job_pool.h"
#include "limber/jobs/last_line.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxWords = 300;  // bytes of a program's own words

// Of one run, gone with it.
class RunFolder {
 public:
  RunFolder() {
    std::error_code problem;
    std::string name = (fs::temp_directory_path(problem) / "limber-run-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw Error(ErrorCode::kFile, std::string("cannot be made: ") + std::strerror(errno), name);
    }
    path_ = name;
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void put(const fs::path& file, ByteSpan bytes) {
  makeFolder(file.parent_path());
  writeFile(file, bytes);
}

AdapterPaths prepareRun(const Adapter& adapter, const ProgramInput& input, const fs::path& folder) {
  AdapterPaths paths;
  paths.folder = folder;
  const std::string_view extension = adapterExtension(adapter.inputFormat);
  paths.input = folder / "input" / fmt::format("{}{}", adapterFileStem(adapter.kind), extension);
  paths.output = folder / adapter.outputFile;
  put(paths.input, input.file);
  if (adapter.kind == AdapterKind::kRetarget) {
    paths.skeleton = folder / "input" / fmt::format("skeleton{}", extension);
    put(paths.skeleton, input.skeleton);
  }
  makeFolder(paths.output.parent_path());
  return paths;
}

// As a shell finds it; the name itself where it is nowhere, which then says so when it is run.
std::string programPath(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  for (const std::string_view folder : splitAt(path == nullptr ? "" : path, ':')) {
    if (folder.empty()) continue;
    std::string file = fmt::format("{}/{}", folder, name);
    std::error_code unseen;
    if (fs::is_regular_file(file, unseen) && access(file.c_str(), X_OK) == 0) return file;
  }
  return name;
}

Job jobOf(const Adapter& adapter, const AdapterStep& step, const AdapterPaths& paths) {
  Job job;
  for (const std::string& argument : step.command) job.command.push_back(filledIn(argument, paths, adapter.seed));
  job.command.front() = programPath(job.command.front());
  job.folder = step.folder.empty() ? paths.folder : fs::path(filledIn(step.folder.string(), paths, adapter.seed));
  job.limits = adapter.limits;
  return job;
}

// Of what it says of errors, else of its output.
std::string lastWords(const JobResult& result) {
  const std::string words = lastLine(result.error, kMaxWords);
  return validUtf8(words.empty() ? lastLine(result.out, kMaxWords) : words);
}

std::string saying(const JobResult& result) {
  const std::string words = lastWords(result);
  return words.empty() ? std::string() : fmt::format("; its last words: {}", words);
}

// What Python, C++, the C library, CUDA and the kernel's own killer say when memory does not suffice. No exit code
// tells.
bool ranOutOfMemory(const JobResult& result) {
  constexpr std::array<std::string_view, 4> kSigns = {"memoryerror", "out of memory", "cannot allocate memory",
                                                      "std::bad_alloc"};
  if (result.outcome == JobOutcome::kCrashed && result.code == SIGKILL) return true;  // not ours: that is kTimedOut
  std::string words = lastLine(result.error, kMaxWords);
  std::transform(words.begin(), words.end(), words.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c | 0x20 : c; });
  return std::any_of(kSigns.begin(), kSigns.end(),
                     [&](std::string_view sign) { return words.find(sign) != std::string::npos; });
}

[[noreturn]] void failStep(const Adapter& adapter, std::size_t step, const Job& job, const JobResult& result) {
  const std::string where = fmt::format("{}: step {} ({})", adapter.name, step + 1, job.command.front());
  constexpr double kMegabyte = 1 << 20;
  const bool hasEnded = result.outcome != JobOutcome::kTimedOut && result.outcome != JobOutcome::kNotStarted;
  if (hasEnded && ranOutOfMemory(result)) {
    throw Error(
        ErrorCode::kUnsupported,
        fmt::format("ran out of memory (its limit is {:.0f} MB): {}{}",
                    static_cast<double>(job.limits.memory) / kMegabyte, jobOutcomeText(job, result), saying(result)),
        where, "raise \"memory_mb\" in the adapter's limits, unless it is the graphics card's");
  }
  switch (result.outcome) {
    case JobOutcome::kNotStarted:
      throw Error(ErrorCode::kUnsupported, fmt::format("cannot be run: {}", std::strerror(result.code)), where,
                  "correct the command and the folder in the adapter");
    case JobOutcome::kTimedOut:
      throw Error(ErrorCode::kUnsupported, fmt::format("did not end within {:g} s", job.limits.seconds), where,
                  "raise \"seconds\" in the adapter's limits");
    case JobOutcome::kCrashed:
      throw Error(ErrorCode::kUnsupported, fmt::format("crashed: {}{}", jobOutcomeText(job, result), saying(result)),
                  where);
    default:
      throw Error(ErrorCode::kUnsupported, fmt::format("failed: {}{}", jobOutcomeText(job, result), saying(result)),
                  where);
  }
}

}  // namespace

ProgramOutput runProgram(const Adapter& adapter, const ProgramInput& input, Progress& progress) {
  const RunFolder folder;
  const AdapterPaths paths = prepareRun(adapter, input, folder.path());
  JobChain chain;
  for (const AdapterStep& step : adapter.steps) chain.push_back(jobOf(adapter, step, paths));
  JobResult last;
  runJobs({&chain, 1}, 1, progress, [&](std::size_t, const std::vector<JobResult>& results) {
    const std::size_t step = results.size() - 1;
    last = results.back();
    if (last.outcome != JobOutcome::kDone) failStep(adapter, step, chain[step], last);
  });
  std::error_code unseen;
  const bool isThere = fs::is_regular_file(paths.output, unseen);
  const auto size = isThere ? fs::file_size(paths.output, unseen) : 0;
  if (!isThere || unseen || size == 0) {
    throw Error(ErrorCode::kBadData,
                fmt::format("{} {}{}", isThere ? "left an empty" : "wrote no", adapter.outputFile, saying(last)),
                adapter.name);
  }
  return {paths.output.filename().string(), readFile(paths.output)};
}

}  // namespace limber
