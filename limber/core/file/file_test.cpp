#include "limber/core/file/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/file/storage_error.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("limber_file_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t filesLeft() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  std::string text(const char* name) const {
    const Bytes bytes = readFile(folder_ / name);
    return {bytes.begin(), bytes.end()};
  }

  fs::path folder_;
};

TEST_F(FileTest, PiecesAreTheWholeFileInOrder) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1} << 20, (std::size_t{5} << 19) + 7}) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 2654435761u >> 13);
    writeFile(folder_ / "pieces", bytes);
    Bytes joined;
    std::size_t largest = 0;
    readFileInPieces(folder_ / "pieces", [&](ByteSpan piece) {
      largest = std::max(largest, piece.size());
      joined.insert(joined.end(), piece.begin(), piece.end());
    });
    EXPECT_EQ(joined, bytes);
    EXPECT_LE(largest, std::size_t{1} << 20);
  }
  EXPECT_THROW(readFileInPieces(folder_ / "nothing", [](ByteSpan) {}), Error);
}

TEST_F(FileTest, WhatIsWrittenIsRead) {
  Bytes bytes(3 << 20);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 31 >> 3);
  writeFile(folder_ / "a.bin", bytes);
  EXPECT_EQ(readFile(folder_ / "a.bin"), bytes);
  writeFile(folder_ / "a.bin", asBytes("short"));
  EXPECT_EQ(readFile(folder_ / "a.bin").size(), 5u);
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(FileTest, AnEmptyFileIsAFile) {
  writeFile(folder_ / "empty", {});
  EXPECT_TRUE(readFile(folder_ / "empty").empty());
}

TEST_F(FileTest, PiecesAreWrittenOneBehindTheOther) {
  const OutputFile file{folder_ / "a.bin", asBytes("one "), {asBytes("two "), {}, asBytes("three")}};
  writeFiles({&file, 1});
  EXPECT_EQ(text("a.bin"), "one two three");
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(FileTest, SeveralFilesAreWrittenAllOrNone) {
  const std::array<OutputFile, 2> files = {
      {{folder_ / "good.bin", asBytes("good")}, {folder_ / "no such folder" / "bad.bin", asBytes("bad")}}};
  EXPECT_THROW(writeFiles(files), Error);
  EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(FileTest, AFailedWriteLeavesTheOldFile) {
  fs::create_directories(folder_ / "taken" / "inside");  // a folder with content cannot be replaced by a file
  EXPECT_THROW(writeFile(folder_ / "taken", asBytes("new")), Error);
  EXPECT_TRUE(fs::is_directory(folder_ / "taken" / "inside"));
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(FileTest, SomebodyElsesFileOfTheTemporaryNameStays) {
  std::ofstream(folder_ / "a.bin.limber-part") << "theirs";
  std::ofstream(folder_ / "precious") << "precious";
  fs::create_symlink("precious", folder_ / "a.bin.limber-part1");
  writeFile(folder_ / "a.bin", asBytes("ours"));
  EXPECT_EQ(text("a.bin"), "ours");
  EXPECT_EQ(text("a.bin.limber-part"), "theirs");
  EXPECT_EQ(text("precious"), "precious");
  EXPECT_EQ(filesLeft(), 4u);
}

TEST_F(FileTest, WhatALinkPointsToIsReplacedAndTheLinkStays) {
  fs::create_directories(folder_ / "inner");
  std::ofstream(folder_ / "inner" / "real") << "old";
  fs::create_symlink("inner/real", folder_ / "first");
  fs::create_symlink("first", folder_ / "second");
  fs::create_symlink("inner/later", folder_ / "dangling");
  for (const char* link : {"second", "dangling"}) {
    writeFile(folder_ / link, asBytes("new"));
    EXPECT_TRUE(fs::is_symlink(folder_ / link));
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "first"));
  EXPECT_FALSE(fs::is_symlink(folder_ / "inner" / "real"));
  EXPECT_EQ(text("inner/real"), "new");
  EXPECT_EQ(text("inner/later"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "inner"), fs::directory_iterator()), 2);
}

TEST_F(FileTest, LinksInACircleAreAnError) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_THROW(writeFile(folder_ / "a", asBytes("x")), Error);
  EXPECT_EQ(filesLeft(), 2u);
}

TEST_F(FileTest, APipeIsWrittenIntoAndStaysAPipe) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);  // so that opening it for writing does not wait
  ASSERT_GE(reader, 0);
  writeFile(pipe, asBytes("through"));
  std::array<char, 16> got{};
  EXPECT_EQ(read(reader, got.data(), got.size()), 7);
  close(reader);
  EXPECT_STREQ(got.data(), "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(FileTest, AFullDeviceLeavesTheOtherFilesUnwritten) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const std::array<OutputFile, 2> files = {{{folder_ / "good.bin", asBytes("good")}, {"/dev/full", asBytes("bad")}}};
  EXPECT_THROW(writeFiles(files), StorageError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(FileTest, ErrorsNameTheFileAndTheReason) {
  for (const fs::path& path : {folder_ / "missing.glb", folder_}) {
    try {
      readFile(path);
      FAIL() << "read " << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFile);
      EXPECT_EQ(error.where(), path.string());
      EXPECT_FALSE(error.message().empty());
    }
  }
}

}  // namespace
}  // namespace limber
