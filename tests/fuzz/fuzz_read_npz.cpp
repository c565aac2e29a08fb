// Archives of arrays: any bytes are a body or an Error.
#include <cstddef>
#include <cstdint>

#include "limber/asset/stored_archive.h"
#include "limber/core/error.h"
#include "limber/pipeline/smpl_body.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    limber::smplBody(limber::readStoredArchive({data, size}, "fuzz.npz"), "fuzz.npz");
  } catch (const limber::Error&) {
  }
  return 0;
}
