// Data as a zlib stream: deflate (RFC 1951) between zlib's header and checksum (RFC 1950).
#pragma once

#include "limber/core/file/file.h"

namespace limber {

// Matches of 4 to 258 bytes, found greedily among the last 16 that begin alike, and Huffman codes made anew for each
// 32768 literals and matches. Of limber's own making because the bytes have to be the same in a program and in a page,
// and zlib is not to be had as WebAssembly from Debian. Cost: linear; some 30 megabytes a second of coordinates, which
// become some 2 percent longer than by zlib's level 6.
Bytes deflateZlib(ByteSpan data);

}  // namespace limber
