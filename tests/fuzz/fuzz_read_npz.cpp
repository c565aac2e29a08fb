// Archives of arrays: any bytes are a body, a motion that keeps its rules, or an Error.
#include <cstddef>
#include <cstdint>

#include "limber/asset/smpl_arrays.h"
#include "limber/asset/smpl_motion.h"
#include "limber/pipeline/smpl_body.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::NpzFiles files;
  try {
    files = limber::readSmplArrays({data, size}, "fuzz.npz");
  } catch (const limber::Error&) {
    return 0;
  }
  try {
    limber::smplBody(files, "fuzz.npz");
  } catch (const limber::Error&) {
  }
  try {
    limber::checkMotion(limber::readSmplMotion(files, "fuzz.npz"));
  } catch (const limber::Error&) {
  }
  return 0;
}
