// Lists of integers as USD's crates pack them.
#pragma once

#include <cstdint>
#include <span>

#include "limber/core/file/file.h"

namespace limber {

// Differences of neighbours, the commonest of them as a code of two bits, others in one, two or four bytes behind the
// codes (OpenUSD, pxr/usd/sdf/integerCoding.cpp); then one chunk of LZ4 with a zero before it
// (pxr/base/tf/fastCompression.cpp).
Bytes packUsdIntegers(std::span<const std::int32_t> values);

// Bytes as one such chunk.
Bytes packUsdBytes(ByteSpan bytes);

}  // namespace limber
