// What became of the entries of a batch: a line of JSON each.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/core/error.h"
#include "limber/jobs/job.h"

namespace limber {

struct BatchRecord {
  std::string input, output;  // as BatchEntry
  std::size_t run = 0;        // of the batch, in which it was written: later ones have higher numbers
  JobOutcome outcome = JobOutcome::kDone;
  std::string problem;                                        // empty where it is done
  std::vector<std::pair<std::string, std::size_t>> warnings;  // kinds, and how often each
  double seconds = 0;
  std::size_t peakMemory = 0;             // bytes
  std::string inputSha256, outputSha256;  // of the files' bytes; the output's is empty where it is not done
  std::string task;                       // BatchTask's digest; empty in records of earlier versions
  std::string key;   // of the program, the command and all that it reads: equal keys, equal outputs
  JobLimits limits;  // that it ran within
};

// One line with its end.
std::string batchRecordLine(const BatchRecord& record);
// Throws Error kBadData where the text is no such line.
BatchRecord parseBatchRecord(std::string_view line);

// The last record of each output in the files of a folder (*.jsonl): that of the latest run, of one run's the last
// line. None where there is no such folder. A line that was not written to its end does not count. Lines that are no
// records, as a power loss can leave them, are passed over with a warning "damaged-records". Throws Error kFile.
std::map<std::string, BatchRecord> readBatchRecords(const std::filesystem::path& folder, Warnings& warnings);

// A file that lines are appended to, whole even where this program is killed. One at a time may have it open, in any
// process of this system.
class BatchRecordFile {
 public:
  // Makes the file, or cuts it after its last whole line. While another one has it open, `waiting` is called
  // ten times a second; it may throw to give up. Throws Error kFile: it cannot be written or locked (flock).
  BatchRecordFile(const std::filesystem::path& file, const std::function<void()>& waiting);
  BatchRecordFile(const BatchRecordFile&) = delete;
  BatchRecordFile& operator=(const BatchRecordFile&) = delete;

  void append(const BatchRecord& record);

 private:
  struct OpenFile {
    int number = -1;
    ~OpenFile();
  };

  std::string name_;
  OpenFile file_;
};

}  // namespace limber
