// ZIP archives whose files are stored as they are, for tests. Not installed.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "limber/core/file/file.h"

namespace limber::testing {

inline void putNumber(Bytes& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

// By a table, as RFC 1952 does it.
inline std::uint32_t crcOf(const std::string& text) {
  std::array<std::uint32_t, 256> table = {};
  for (std::uint32_t n = 0; n < table.size(); ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  std::uint32_t sum = 0xffffffffu;
  for (const char c : text) sum = table[(sum ^ static_cast<unsigned char>(c)) & 0xff] ^ (sum >> 8);
  return sum ^ 0xffffffffu;
}

// With the path and its size behind what both records of a file have in common.
inline void putRecord(Bytes& bytes, const std::string& path, const std::string& content, std::uint32_t signature) {
  const bool isEntry = signature == 0x02014b50;
  putNumber(bytes, signature, 4);
  if (isEntry) putNumber(bytes, 20, 2);
  for (const int value : {20, 0, 0, 0, 33}) putNumber(bytes, static_cast<std::uint32_t>(value), 2);
  putNumber(bytes, crcOf(content), 4);
  for (int i = 0; i < 2; ++i) putNumber(bytes, static_cast<std::uint32_t>(content.size()), 4);
  putNumber(bytes, static_cast<std::uint32_t>(path.size()), 2);
  putNumber(bytes, 0, 2);
}

inline Bytes storedZip(const std::vector<std::pair<std::string, std::string>>& files) {
  Bytes bytes, directory;
  for (const auto& [path, content] : files) {
    const std::size_t at = bytes.size();
    putRecord(bytes, path, content, 0x04034b50);
    bytes.insert(bytes.end(), path.begin(), path.end());
    bytes.insert(bytes.end(), content.begin(), content.end());
    putRecord(directory, path, content, 0x02014b50);
    for (const int size : {2, 2, 2, 4}) putNumber(directory, 0, size);
    putNumber(directory, static_cast<std::uint32_t>(at), 4);
    directory.insert(directory.end(), path.begin(), path.end());
  }
  const std::size_t start = bytes.size();
  bytes.insert(bytes.end(), directory.begin(), directory.end());
  putNumber(bytes, 0x06054b50, 4);
  putNumber(bytes, 0, 4);
  for (int i = 0; i < 2; ++i) putNumber(bytes, static_cast<std::uint32_t>(files.size()), 2);
  putNumber(bytes, static_cast<std::uint32_t>(directory.size()), 4);
  putNumber(bytes, static_cast<std::uint32_t>(start), 4);
  putNumber(bytes, 0, 2);
  return bytes;
}

}  // namespace limber::testing
