// PLY files: any bytes are a document that passes every check, or an Error.
#include <cstddef>
#include <cstdint>

#include "limber/document/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4 || data[0] != 'p' || data[1] != 'l' || data[2] != 'y') return 0;
  try {
    limber::readAsset(limber::ByteSpan{data, size}, "fuzz.ply");
  } catch (const limber::Error&) {
  }
  return 0;
}
