#include "limber/document/fbx/records/fbx_encode.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/document/fbx/records/testing/fbx_reader.h"

namespace limber {
namespace {

std::vector<FbxNode> everyKindOfValue() {
  FbxNode values{"Values",
                 {true, std::int16_t{-2}, std::int32_t{3}, std::int64_t{-4}, 0.5f, 0.25, std::string("a\0\1B", 4),
                  Bytes{1, 0, 2}, std::vector<std::int32_t>{1, -2}, std::vector<std::int64_t>{},
                  std::vector<float>(1000, 1.5f), std::vector<double>{1e300}},
                 {}};
  FbxNode parent{"Parent", {std::int32_t{1}}, {values, {"Empty", {}, {}}}};
  return {{"FileId", {Bytes(fbxFileId().begin(), fbxFileId().end())}, {}}, parent, {"References", {}, {}}};
}

void expectEqual(const FbxNode& a, const FbxNode& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.values, b.values) << a.name;
  ASSERT_EQ(a.children.size(), b.children.size()) << a.name;
  for (std::size_t i = 0; i < a.children.size(); ++i) expectEqual(a.children[i], b.children[i]);
}

TEST(EncodeFbxFile, AnotherReaderFindsWhatWasPutIn) {
  const std::vector<FbxNode> records = everyKindOfValue();
  const Bytes bytes = encodeFbxFile(records);
  const std::vector<FbxNode> back = testing::FbxTestReader(bytes).read();
  ASSERT_EQ(back.size(), records.size());
  for (std::size_t i = 0; i < back.size(); ++i) expectEqual(back[i], records[i]);
}

TEST(EncodeFbxFile, HeaderAndFooterAreThoseOfTheSdk) {
  const Bytes bytes = encodeFbxFile(everyKindOfValue());
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 20), "Kaydara FBX Binary  ");
  EXPECT_EQ(Bytes(bytes.begin() + 20, bytes.begin() + 27), (Bytes{0, 0x1a, 0, 0xe8, 0x1c, 0, 0}));
  EXPECT_EQ(bytes.size() % 16, 0u);
  testing::FbxTestReader reader(bytes);
  reader.read();
  EXPECT_EQ(bytes[reader.at()], 0xfa);  // of the footer, right behind the records
  const Bytes end(bytes.end() - 140, bytes.end());
  EXPECT_EQ(Bytes(end.begin(), end.begin() + 4), (Bytes{0xe8, 0x1c, 0, 0}));
  EXPECT_EQ(std::count(end.begin() + 4, end.begin() + 124, 0), 120);
  EXPECT_EQ(end[124], 0xf8);
  EXPECT_EQ(end[139], 0x0b);
}

TEST(EncodeFbxFile, LongArraysAreDeflatedAndShortOnesAreNot) {
  const auto sizeOf = [](std::size_t count) {
    return encodeFbxFile(std::vector<FbxNode>{{"A", {std::vector<double>(count, 1)}, {}}}).size();
  };
  EXPECT_LT(sizeOf(10000), sizeOf(1) + 200);
}

}  // namespace
}  // namespace limber
