#include "limber/document/gltf/glb.h"

#include <gtest/gtest.h>

#include "limber/document/testing/gltf_builder.h"

namespace limber {
namespace {

using testing::GltfBuilder;

std::string textOf(ByteSpan bytes) {
  return {bytes.begin(), bytes.end()};
}

GlbChunks split(const Bytes& file) {
  Warnings warnings;
  const GlbChunks chunks = splitGlb(file, warnings);
  EXPECT_TRUE(warnings.empty());
  return chunks;
}

ErrorCode codeOf(const Bytes& file) {
  Warnings warnings;
  try {
    splitGlb(file, warnings);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return {};
}

void setWord(Bytes& file, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

TEST(Glb, SplitsChunks) {
  const Bytes file = GltfBuilder::glbOf("{\"a\":1}", {1, 2, 3});
  const GlbChunks chunks = split(file);
  EXPECT_EQ(textOf(chunks.json), "{\"a\":1} ");
  ASSERT_TRUE(chunks.binary);
  EXPECT_EQ(Bytes(chunks.binary->begin(), chunks.binary->end()), (Bytes{1, 2, 3, 0}));
  const Bytes jsonOnly = GltfBuilder::glbOf("{}", {});
  EXPECT_FALSE(split(jsonOnly).binary);
}

TEST(Glb, JoinsAsTheSpecificationSays) {
  for (std::size_t size : {0u, 1u, 4u, 7u}) {
    const Bytes binary(size, 7);
    BinaryChunk chunk;
    EXPECT_EQ(chunk.add(binary), 0u);
    Bytes file = glbHead("{\"a\":12}", chunk);
    for (const ByteSpan piece : chunk.pieces) file.insert(file.end(), piece.begin(), piece.end());
    EXPECT_EQ(file, GltfBuilder::glbOf("{\"a\":12}", binary));
  }
}

TEST(Glb, PiecesBeginAtMultiplesOfFour) {
  const Bytes three(3, 1), four(4, 2);
  BinaryChunk chunk;
  EXPECT_EQ(chunk.add(three), 0u);
  EXPECT_EQ(chunk.add(four), 4u);
  EXPECT_EQ(chunk.add(three), 8u);
  EXPECT_EQ(chunk.size, 11u);
  Bytes binary;
  for (const ByteSpan piece : chunk.pieces) binary.insert(binary.end(), piece.begin(), piece.end());
  EXPECT_EQ(binary, (Bytes{1, 1, 1, 0, 2, 2, 2, 2, 1, 1, 1, 0}));
}

TEST(Glb, EveryTruncationIsAnError) {
  const Bytes file = GltfBuilder::glbOf("{\"a\":1}", {1, 2, 3});
  for (std::size_t length = 4; length < file.size(); ++length) {
    EXPECT_EQ(codeOf({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length)}), ErrorCode::kBadData);
  }
}

TEST(Glb, InconsistentContainersAreErrors) {
  const Bytes file = GltfBuilder::glbOf("{\"a\":1}", {1, 2, 3});
  Bytes version = file, length = file, chunk = file, notJson = file, secondJson = file,
        noChunk(file.begin(), file.begin() + 12);
  setWord(version, 4, 1);
  EXPECT_EQ(codeOf(version), ErrorCode::kUnsupported);
  setWord(length, 8, 3);
  EXPECT_EQ(codeOf(length), ErrorCode::kBadData);
  setWord(chunk, 12, 0xfffffff0);
  EXPECT_EQ(codeOf(chunk), ErrorCode::kBadData);
  setWord(notJson, 16, 0x12345678);
  EXPECT_EQ(codeOf(notJson), ErrorCode::kBadData);
  setWord(secondJson, 32, 0x4E4F534A);
  EXPECT_EQ(codeOf(secondJson), ErrorCode::kBadData);
  setWord(noChunk, 8, 12);
  EXPECT_EQ(codeOf(noChunk), ErrorCode::kBadData);
}

TEST(Glb, ForeignChunksAndTrailingBytesAreLeftOutWithAWarning) {
  Bytes file = GltfBuilder::glbOf("{}", {1, 2, 3, 4});
  GltfBuilder::word(file, 4);
  file.insert(file.end(), {'X', 'T', 'R', 'A', 9, 9, 9, 9});
  setWord(file, 8, static_cast<std::uint32_t>(file.size()));
  file.insert(file.end(), {5, 5, 5});
  Warnings warnings;
  const GlbChunks chunks = splitGlb(file, warnings);
  EXPECT_EQ(chunks.binary->size(), 4u);
  ASSERT_EQ(warnings.items().size(), 2u);
  EXPECT_EQ(warnings.items()[0].kind, "trailing-bytes");
  EXPECT_EQ(warnings.items()[0].count, 3u);
  EXPECT_EQ(warnings.items()[1].kind, "unknown-chunks");
}

}  // namespace
}  // namespace limber
