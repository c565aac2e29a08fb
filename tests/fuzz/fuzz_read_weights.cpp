// Weights of a reading: any bytes are weights, or an Error.
#include <cstddef>
#include <cstdint>

#include "limber/core/error.h"
#include "limber/reading/weights_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    limber::readReadingWeights({data, size});
  } catch (const limber::Error&) {
  }
  return 0;
}
