#include "limber/batch/batch_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

void noWaiting() {
  throw std::logic_error("another one has the file open");
}

BatchRecord recordOf(const std::string& name) {
  BatchRecord record;
  record.input = name + ".obj";
  record.output = name + ".glb";
  record.run = 3;
  record.outcome = JobOutcome::kTimedOut;
  record.problem = "more than 2 s\n\"quoted\"";
  record.warnings = {{"converted-units", 1}, {"loose-vertices", 12}};
  record.seconds = 1.25;
  record.peakMemory = 123456789;
  record.inputSha256 = std::string(64, 'a');
  record.task = "0123456789abcdef";
  record.key = std::string(64, 'b');
  record.limits = {2, 1 << 20};
  return record;
}

std::map<std::string, BatchRecord> recordsIn(const std::filesystem::path& folder) {
  Warnings warnings;
  const auto records = readBatchRecords(folder, warnings);
  EXPECT_TRUE(warnings.empty());
  return records;
}

std::string wholeTextOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(BatchRecord, ComesBackFromItsLine) {
  const BatchRecord record = recordOf("hero");
  const std::string line = batchRecordLine(record);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  EXPECT_EQ(batchRecordLine(parseBatchRecord(line)), line);
  const BatchRecord back = parseBatchRecord(line);
  EXPECT_EQ(back.run, record.run);
  EXPECT_EQ(back.outcome, record.outcome);
  EXPECT_EQ(back.problem, record.problem);
  EXPECT_EQ(back.warnings, record.warnings);
  EXPECT_EQ(back.seconds, record.seconds);
  EXPECT_EQ(back.peakMemory, record.peakMemory);
  EXPECT_EQ(back.task, record.task);
  EXPECT_EQ(back.limits.memory, record.limits.memory);
  EXPECT_THROW(parseBatchRecord("{}"), Error);
  EXPECT_THROW(parseBatchRecord(line.substr(0, line.size() / 2)), Error);
}

TEST(BatchRecord, LastOneCountsAndTornOnesDoNot) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "1-of-1.jsonl";
  BatchRecord again = recordOf("b");
  again.outcome = JobOutcome::kDone;
  {
    BatchRecordFile records(file, noWaiting);
    for (const BatchRecord& record : {recordOf("a"), recordOf("b"), again}) records.append(record);
  }
  const std::string whole = wholeTextOf(file);
  std::ofstream(file, std::ios::app | std::ios::binary) << batchRecordLine(recordOf("c")).substr(0, 40);
  const auto records = recordsIn(folder.path());
  EXPECT_EQ(records.size(), 2u);
  EXPECT_EQ(records.at("b.glb").outcome, JobOutcome::kDone);
  const BatchRecordFile opened(file, noWaiting);
  EXPECT_EQ(wholeTextOf(file), whole);
  EXPECT_TRUE(recordsIn(folder.path() / "missing").empty());
}

TEST(BatchRecord, TheLatestRunCountsWhateverItsFile) {
  const testing::TemporaryFolder folder;
  BatchRecord before = recordOf("a"), after = before;
  before.run = 0;
  after.outcome = JobOutcome::kDone;
  const auto outcome = [&] { return recordsIn(folder.path()).at("a.glb").outcome; };
  BatchRecordFile(folder.path() / "5-of-16.jsonl", noWaiting).append(before);
  BatchRecordFile(folder.path() / "1-of-1.jsonl", noWaiting).append(after);
  EXPECT_EQ(outcome(), JobOutcome::kDone);
  before.run = after.run + 1;
  BatchRecordFile(folder.path() / "1-of-1.jsonl", noWaiting).append(before);
  EXPECT_EQ(outcome(), JobOutcome::kTimedOut);
}

TEST(BatchRecord, LinesThatAreNoneArePassedOverWithAWarning) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "1-of-1.jsonl";
  std::ofstream(file, std::ios::binary) << batchRecordLine(recordOf("a")) << "garbage\n"
                                        << std::string(8, '\0') << batchRecordLine(recordOf("b")) << "[1]\n"
                                        << batchRecordLine(recordOf("c"));
  Warnings warnings;
  const auto records = readBatchRecords(folder.path(), warnings);
  EXPECT_EQ(records.size(), 2u);
  EXPECT_TRUE(records.contains("c.glb"));
  ASSERT_EQ(warnings.items().size(), 1u);
  EXPECT_EQ(warnings.items()[0].kind, "damaged-records");
  EXPECT_EQ(warnings.items()[0].count, 3u);
  EXPECT_EQ(warnings.items()[0].where, file.string() + ": line 2");
}

TEST(BatchRecord, OneAtATimeWrites) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "1-of-1.jsonl";
  auto first = std::make_unique<BatchRecordFile>(file, noWaiting);
  EXPECT_THROW(BatchRecordFile(file, noWaiting), std::logic_error);
  int tries = 0;
  BatchRecordFile second(file, [&] {
    if (++tries == 3) first.reset();
  });
  EXPECT_EQ(tries, 3);
  second.append(recordOf("a"));
  EXPECT_EQ(recordsIn(folder.path()).size(), 1u);
}

}  // namespace
}  // namespace limber
