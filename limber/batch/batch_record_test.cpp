#include "limber/batch/batch_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

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
  record.key = std::string(64, 'b');
  record.limits = {2, 1 << 20};
  return record;
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
    BatchRecordFile records(file);
    for (const BatchRecord& record : {recordOf("a"), recordOf("b"), again}) records.append(record);
  }
  const std::string whole = wholeTextOf(file);
  std::ofstream(file, std::ios::app | std::ios::binary) << batchRecordLine(recordOf("c")).substr(0, 40);
  const auto records = readBatchRecords(folder.path());
  EXPECT_EQ(records.size(), 2u);
  EXPECT_EQ(records.at("b.glb").outcome, JobOutcome::kDone);
  const BatchRecordFile opened(file);
  EXPECT_EQ(wholeTextOf(file), whole);
  EXPECT_TRUE(readBatchRecords(folder.path() / "missing").empty());
}

TEST(BatchRecord, TheLatestRunCountsWhateverItsFile) {
  const testing::TemporaryFolder folder;
  BatchRecord before = recordOf("a"), after = before;
  before.run = 0;
  after.outcome = JobOutcome::kDone;
  const auto outcome = [&] { return readBatchRecords(folder.path()).at("a.glb").outcome; };
  BatchRecordFile(folder.path() / "5-of-16.jsonl").append(before);
  BatchRecordFile(folder.path() / "1-of-1.jsonl").append(after);
  EXPECT_EQ(outcome(), JobOutcome::kDone);
  before.run = after.run + 1;
  BatchRecordFile(folder.path() / "1-of-1.jsonl").append(before);
  EXPECT_EQ(outcome(), JobOutcome::kTimedOut);
}

TEST(BatchRecord, OneAtATimeWrites) {
  const testing::TemporaryFolder folder;
  const BatchRecordFile first(folder.path() / "1-of-1.jsonl");
  EXPECT_THROW(BatchRecordFile(folder.path() / "1-of-1.jsonl"), Error);
}

}  // namespace
}  // namespace limber
