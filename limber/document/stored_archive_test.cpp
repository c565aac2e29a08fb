#include "limber/document/stored_archive.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/document/testing/stored_zip.h"

namespace limber {
namespace {

using testing::storedZip;

ErrorCode refusalOf(const Bytes& archive) {
  try {
    readZipArchive(archive, "a.zip");
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "a.zip");
    return error.code();
  }
  ADD_FAILURE() << "took it";
  return ErrorCode::kFile;
}

Bytes textBytes(std::string_view text) {
  return Bytes(text.begin(), text.end());
}

TEST(StoredArchive, HoldsItsFilesByTheirPaths) {
  const auto files = readZipArchive(storedZip({{"a.npy", "one"}, {"folder/b.npy", ""}, {"c", "three"}}), "a.zip");
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files.at("a.npy"), textBytes("one"));
  EXPECT_TRUE(files.at("folder/b.npy").empty());
  EXPECT_EQ(files.at("c"), textBytes("three"));
}

// By Python's zipfile, with the local sizes in a ZIP64 field, as numpy.savez has it.
Bytes bytesOfDigits(std::string_view digits) {
  Bytes bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

TEST(StoredArchive, ReadsWhatNumpyWrites) {
  Bytes archive = bytesOfDigits(
      "504b03042d0000000000000021002639f4cbffffffffffffffff05001400612e6e7079010010000900000000000000090000"
      "0000000000313233343536373839504b01022d032d0000000000000021002639f4cb09000000090000000500000000000000"
      "00000000800100000000612e6e7079504b0506000000000100010033000000400000000000");
  EXPECT_EQ(readZipArchive(archive, "a.npz").at("a.npy"), textBytes("123456789"));
  archive[57] ^= 1;  // within the digits: their checksum tells
  EXPECT_EQ(refusalOf(archive), ErrorCode::kBadData);
}

// 24 zeros by numpy.savez_compressed.
TEST(StoredArchive, InflatesWhatNumpyCompresses) {
  Bytes archive = bytesOfDigits(
      "504b030414000000080000002100a29e853d480000004001000005001400612e6e707901001000400100000000000048000000000000009b"
      "ec"
      "17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a1aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a46"
      "26"
      "3a9a3a0ab50ae4032e86210e00504b0102140314000000080000002100a29e853d4800000040010000050000000000000000000000800100"
      "0000"
      "00612e6e7079504b05060000000001000100330000007f0000000000");
  const Bytes content = readZipArchive(archive, "a.npz").at("a.npy");
  ASSERT_EQ(content.size(), 320u);
  EXPECT_EQ(content[0], 0x93);
  EXPECT_EQ(Bytes(content.end() - 192, content.end()), Bytes(192, 0));
  for (std::size_t at = 0; at < archive.size(); ++at) {
    for (const int flip : {1, 0x80, 0xff}) {
      Bytes patched = archive;
      patched[at] = static_cast<std::uint8_t>(patched[at] ^ flip);
      try {
        for (const auto& [path, bytes] : readZipArchive(patched, "a.npz")) EXPECT_EQ(bytes, content);
      } catch (const Error&) {
      }
    }
  }
}

TEST(StoredArchive, WhatNobodyAsksForIsNotUnpacked) {
  Bytes archive = storedZip({{"a", "one"}, {"b", "two"}});
  archive[30 + 1 + 3 + 30 + 1] ^= 1;  // the first letter of "two": its checksum tells
  EXPECT_EQ(refusalOf(archive), ErrorCode::kBadData);
  const auto isA = [](const std::string& path) { return path == "a"; };
  EXPECT_EQ(readZipArchive(archive, "a.zip", isA).at("a"), textBytes("one"));
  const ZipArchive directory(archive, "a.zip");
  EXPECT_EQ(directory.find("a"), textBytes("one"));
  EXPECT_EQ(directory.find("c"), std::nullopt);
  EXPECT_THROW(directory.find("b"), Error);
}

TEST(StoredArchive, ASmallArchiveHoldsNoGigabyte) {
  Bytes archive = storedZip({{"a", "one"}});
  const std::size_t entry = archive.size() - 22 - 47;
  archive[entry + 10] = 8;    // deflated
  archive[entry + 27] = 100;  // its size: 1.7 GB
  EXPECT_EQ(refusalOf(archive), ErrorCode::kLimit);
}

TEST(StoredArchive, MayEndInAComment) {
  Bytes archive = storedZip({{"a", "one"}});
  archive[archive.size() - 2] = 5;
  for (const char c : std::string_view("PK\5\6!")) archive.push_back(static_cast<std::uint8_t>(c));
  EXPECT_EQ(readZipArchive(archive, "a.zip").at("a"), textBytes("one"));
}

TEST(StoredArchive, IsRefusedAtEveryLength) {
  const Bytes archive = storedZip({{"a.npy", "some numbers"}, {"b.npy", "others"}});
  for (std::size_t size = 0; size < archive.size(); ++size) {
    EXPECT_EQ(refusalOf(Bytes(archive.begin(), archive.begin() + static_cast<std::ptrdiff_t>(size))),
              ErrorCode::kBadData);
  }
}

// What is read of a patched archive is what was in it, or it is refused.
TEST(StoredArchive, DoesNotTrustAByte) {
  const Bytes archive = storedZip({{"a.npy", "some numbers"}, {"b.npy", "others"}});
  for (std::size_t at = 0; at < archive.size(); ++at) {
    for (const int flip : {1, 0x80, 0xff}) {
      Bytes patched = archive;
      patched[at] = static_cast<std::uint8_t>(patched[at] ^ flip);
      try {
        std::size_t size = 0;
        for (const auto& [path, content] : readZipArchive(patched, "a.zip")) size += content.size();
        EXPECT_LE(size, archive.size());
      } catch (const Error&) {
      }
    }
  }
}

TEST(StoredArchive, TellsWhatItCannotRead) {
  Bytes compressed = storedZip({{"a", "one"}});
  const std::size_t entry = compressed.size() - 22 - 47;
  compressed[entry + 10] = 12;  // bzip2
  EXPECT_EQ(refusalOf(compressed), ErrorCode::kUnsupported);
  Bytes encrypted = storedZip({{"a", "one"}});
  encrypted[entry + 8] = 1;
  EXPECT_EQ(refusalOf(encrypted), ErrorCode::kUnsupported);
  EXPECT_EQ(refusalOf(storedZip({{"a", "one"}, {"a", "two"}})), ErrorCode::kBadData);
}

}  // namespace
}  // namespace limber
