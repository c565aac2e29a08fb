// Deflated data (RFC 1951), by themselves and between zlib's header and checksum (RFC 1950).
#pragma once

#include <cstdint>
#include <span>

#include "limber/core/file/file.h"

namespace limber {

// The most bytes that one byte of deflated data can become: a match of 258 bytes takes two bits.
inline constexpr std::size_t kMaxInflatedPerByte = 1032;

// Fills `out` with the decompressed data. Throws Error kBadData where the data are broken or cut off, or contain more
// or fewer bytes than `out`; bytes after the end of the stream are ignored. Allocates nothing. Cost: linear, some 150
// megabytes of `out` a second.
void inflate(ByteSpan packed, std::span<std::uint8_t> out);

// The same of a zlib stream; throws, too, where it refers to a preset dictionary or does not have the checksum that it
// says.
void inflateZlib(ByteSpan stream, std::span<std::uint8_t> out);

}  // namespace limber
