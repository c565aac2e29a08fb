#include "limber/batch/batch_status.h"

#include <algorithm>
#include <system_error>

#include "limber/batch/batch_record.h"
#include "limber/batch/batch_run.h"
#include "limber/batch/batch_task.h"
#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

bool isThere(const fs::path& file) {
  std::error_code unseen;
  return fs::is_regular_file(file, unseen);
}

PlannedOutputs plannedIn(const BatchFolder& folder) {
  if (!isThere(folder.plan())) {
    throw Error(ErrorCode::kFile, "is no folder of a batch", folder.root.string(), "name the one that -o named");
  }
  const Bytes bytes = readFile(folder.plan());
  try {
    return parsePlannedOutputs({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const Error& error) {
    throw error.within(folder.plan().string());
  }
}

bool isOutdated(const BatchRecord& record, const std::string& task) {
  return !task.empty() && record.task != task;
}

void add(const BatchRecord& record, const fs::path& root, BatchStatus& status,
         std::map<std::pair<JobOutcome, std::string>, BatchFailures>& failures,
         std::map<std::string, std::size_t>& warnings) {
  status.seconds += record.seconds;
  status.slowest = std::max(status.slowest, record.seconds);
  status.peakMemory = std::max(status.peakMemory, record.peakMemory);
  if (record.outcome != JobOutcome::kDone) {
    ++status.failed;
    BatchFailures& alike = failures[{record.outcome, record.problem}];
    if (alike.count++ == 0) alike = {record.outcome, record.problem, 1, record.input};
    return;
  }
  for (const auto& [kind, count] : record.warnings) ++warnings[kind];
  if (isThere(root / record.output)) {
    ++status.done;
  } else {
    ++status.lost;
  }
}

}  // namespace

BatchStatus batchStatus(const fs::path& output) {
  const BatchFolder folder{output};
  BatchStatus status;
  const PlannedOutputs planned = plannedIn(folder);
  status.entries = planned.outputs.size();
  std::map<std::string, BatchRecord> known = readBatchRecords(folder.records(), status.recordWarnings);
  std::map<std::pair<JobOutcome, std::string>, BatchFailures> failures;
  std::map<std::string, std::size_t> warnings;
  for (std::size_t i = 0; i < planned.outputs.size(); ++i) {
    const auto node = known.extract(planned.outputs[i]);
    if (node.empty()) continue;
    if (isOutdated(node.mapped(), planned.taskOf(i))) {
      ++status.outdated;
    } else {
      add(node.mapped(), folder.root, status, failures, warnings);
    }
  }
  for (const auto& [outputPath, record] : known) {
    if (record.outcome == JobOutcome::kDone && isThere(folder.root / outputPath)) status.leftOver.push_back(outputPath);
  }
  for (auto& [kind, alike] : failures) status.failures.push_back(std::move(alike));
  status.warnings.assign(warnings.begin(), warnings.end());
  const auto byCount = [](const auto& list, auto count) {
    std::stable_sort(list->begin(), list->end(), [&](const auto& a, const auto& b) { return count(a) > count(b); });
  };
  byCount(&status.failures, [](const BatchFailures& one) { return one.count; });
  byCount(&status.warnings, [](const auto& one) { return one.second; });
  return status;
}

std::string mergedBatchRecords(const fs::path& output) {
  const BatchFolder folder{output};
  const PlannedOutputs planned = plannedIn(folder);
  Warnings warnings;  // by batchStatus
  const std::map<std::string, BatchRecord> known = readBatchRecords(folder.records(), warnings);
  std::string lines;
  for (std::size_t i = 0; i < planned.outputs.size(); ++i) {
    const auto found = known.find(planned.outputs[i]);
    if (found == known.end() || isOutdated(found->second, planned.taskOf(i))) continue;
    lines += batchRecordLine(found->second);
  }
  return lines;
}

}  // namespace limber
