// SHA-256 (FIPS 180-4), by which kept results are found again.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "limber/core/file.h"

namespace limber {

class Sha256 {
 public:
  void add(ByteSpan bytes);
  // Of all that was added, as 64 hexadecimal digits; nothing may be added after.
  std::string hex();

 private:
  void addBlock(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> open_{};  // the block that is not full
  std::uint64_t length_ = 0;             // bytes
};

// Cost: 300 MB a second.
std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace limber
