#include "limber/batch/batch_status.h"

#include <algorithm>
#include <system_error>

#include <nlohmann/json.hpp>

#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/batch/batch_record.h"
#include "limber/batch/batch_run.h"
#include "limber/core/error.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> outputsOf(const BatchFolder& folder) {
  std::error_code unseen;
  if (!fs::is_regular_file(folder.plan(), unseen)) {
    throw Error(ErrorCode::kFile, "is no folder of a batch", folder.root.string(), "name the one that -o named");
  }
  const Bytes bytes = readFile(folder.plan());
  try {
    Warnings ignored;
    const Json json = parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, ignored);
    const JsonView root(json);
    if (root.count("limber_batch") != 1) root.fail("is of another version");
    return root.array("outputs").json().get<std::vector<std::string>>();
  } catch (const Error& error) {
    throw error.within(folder.plan().string());
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kBadData, "has outputs that are no texts", folder.plan().string());
  }
}

// The records of the plan as it is now, in its order; nothing for what has none.
std::vector<BatchRecord> recordsOf(const BatchFolder& folder, const std::vector<std::string>& outputs) {
  std::map<std::string, BatchRecord> known = readBatchRecords(folder.records());
  std::vector<BatchRecord> records;
  for (const std::string& output : outputs) {
    if (const auto found = known.find(output); found != known.end()) records.push_back(std::move(found->second));
  }
  return records;
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
  std::error_code unseen;
  if (fs::is_regular_file(root / record.output, unseen)) {
    ++status.done;
  } else {
    ++status.lost;
  }
}

}  // namespace

BatchStatus batchStatus(const fs::path& output) {
  const BatchFolder folder{output};
  BatchStatus status;
  const std::vector<std::string> outputs = outputsOf(folder);
  status.entries = outputs.size();
  std::map<std::pair<JobOutcome, std::string>, BatchFailures> failures;
  std::map<std::string, std::size_t> warnings;
  for (const BatchRecord& record : recordsOf(folder, outputs)) add(record, folder.root, status, failures, warnings);
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
  std::string lines;
  for (const BatchRecord& record : recordsOf(folder, outputsOf(folder))) lines += batchRecordLine(record);
  return lines;
}

}  // namespace limber
