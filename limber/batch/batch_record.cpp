#include "limber/batch/batch_record.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/utf8.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRecordExtension = ".jsonl";
constexpr std::chrono::milliseconds kPause(100);  // between tries for a file that another program has open

[[noreturn]] void refuseFile(const std::string& name, const char* what, const char* remedy = "") {
  throw Error(ErrorCode::kFile, std::string(what) + ": " + std::strerror(errno), name, remedy);
}

// Up to and with the last end of a line.
std::string_view wholeLines(std::string_view text) {
  const std::size_t end = text.rfind('\n');
  return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

}  // namespace

std::string batchRecordLine(const BatchRecord& record) {
  Json warnings = Json::object();
  for (const auto& [kind, count] : record.warnings) warnings[kind] = count;
  const Json json = {{"input", record.input},
                     {"output", record.output},
                     {"run", record.run},
                     {"outcome", jobOutcomeName(record.outcome)},
                     {"problem", record.problem},
                     {"warnings", std::move(warnings)},
                     {"seconds", record.seconds},
                     {"peak_memory", record.peakMemory},
                     {"input_sha256", record.inputSha256},
                     {"output_sha256", record.outputSha256},
                     {"task", record.task},
                     {"key", record.key},
                     {"limits", {{"seconds", record.limits.seconds}, {"memory", record.limits.memory}}}};
  return dumpReport(json, -1) + "\n";
}

BatchRecord parseBatchRecord(std::string_view line) {
  Warnings ignored;
  const Json json = parseJson(line, ignored);
  const JsonView root(json);
  BatchRecord record;
  record.input = root.text("input");
  record.output = root.text("output");
  if (record.output.empty()) root.fail("names no output");
  record.run = root.count("run").value_or(0);  // none before there were numbers
  record.outcome = findJobOutcome(root.text("outcome"));
  record.problem = root.text("problem");
  root.object("warnings").forEachMember([&](std::string_view kind, const JsonView& count) {
    record.warnings.emplace_back(kind, count.asCount());
  });
  record.seconds = root.number("seconds", 0);
  record.peakMemory = root.count("peak_memory").value_or(0);
  record.inputSha256 = root.text("input_sha256");
  record.outputSha256 = root.text("output_sha256");
  record.task = root.text("task");
  record.key = root.text("key");
  record.limits.seconds = root.object("limits").number("seconds", 0);
  record.limits.memory = root.object("limits").count("memory").value_or(0);
  return record;
}

std::map<std::string, BatchRecord> readBatchRecords(const fs::path& folder, Warnings& warnings) {
  std::vector<fs::path> files;
  std::error_code problem;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    if (lowerExtension(it->path()) == kRecordExtension) files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, BatchRecord> records;
  for (const fs::path& file : files) {
    const Bytes bytes = readFile(file);
    std::string_view text = wholeLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(line.size() + 1);
      try {
        BatchRecord record = parseBatchRecord(line);
        const auto [known, isNew] = records.try_emplace(record.output);
        if (isNew || record.run >= known->second.run) known->second = std::move(record);
      } catch (const Error&) {
        warnings.add("damaged-records",
                     "lines that are no records are passed over; entries that have no other run again",
                     fmt::format("{}: line {}", validUtf8(file.string()), number));
      }
    }
  }
  return records;
}

BatchRecordFile::OpenFile::~OpenFile() {
  if (number >= 0) close(number);
}

BatchRecordFile::BatchRecordFile(const fs::path& file, const std::function<void()>& waiting) : name_(file.string()) {
  file_.number = open(name_.c_str(), O_CREAT | O_RDWR | O_APPEND | O_CLOEXEC, 0666);
  if (file_.number < 0) refuseFile(name_, "cannot be written");
  while (flock(file_.number, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) {
      refuseFile(name_, "cannot be locked", "the folder has to lie on a file system that offers flock");
    }
    waiting();
    std::this_thread::sleep_for(kPause);
  }
  const Bytes bytes = readFile(file);
  const std::size_t whole = wholeLines({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).size();
  if (whole < bytes.size() && ftruncate(file_.number, static_cast<off_t>(whole)) != 0) {
    refuseFile(name_, "cannot be cut to its whole lines");
  }
}

void BatchRecordFile::append(const BatchRecord& record) {
  const std::string line = batchRecordLine(record);
  std::string_view left = line;
  while (!left.empty()) {
    const ssize_t written = write(file_.number, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuseFile(name_, "cannot be written");
    left.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace limber
