#include "limber/core/file/file_view.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

constexpr std::size_t kMapFrom = 100;

Bytes someBytes(std::size_t count) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i * 2654435761u >> 11);
  return bytes;
}

TEST(FileView, ShowsWhatTheFileHolds) {
  const testing::TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kMapFrom - 1, kMapFrom, std::size_t{70001}}) {
    const Bytes bytes = someBytes(size);
    writeFile(folder.path() / "file", bytes);
    const FileView view(folder.path() / "file", kMapFrom);
    EXPECT_EQ(view.isMapped(), size >= kMapFrom);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), view.bytes().begin(), view.bytes().end()));
  }
}

TEST(FileView, StaysWhenAnotherFileTakesItsPlace) {
  const testing::TemporaryFolder folder;
  const Bytes before = someBytes(5000);
  writeFile(folder.path() / "file", before);
  const FileView view(folder.path() / "file", kMapFrom);
  writeFile(folder.path() / "file", someBytes(3));
  EXPECT_TRUE(std::equal(before.begin(), before.end(), view.bytes().begin(), view.bytes().end()));
}

TEST(FileView, APipeIsRead) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Bytes bytes = someBytes(500);
  std::thread writer(
      [&] { std::ofstream(pipe, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), 500); });
  const FileView view(pipe, kMapFrom);
  writer.join();
  EXPECT_FALSE(view.isMapped());
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), view.bytes().begin(), view.bytes().end()));
}

TEST(FileView, NothingAndFoldersAreErrors) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(FileView(folder.path() / "nothing"), Error);
  EXPECT_THROW(FileView(folder.path(), 0), Error);
}

}  // namespace
}  // namespace limber
