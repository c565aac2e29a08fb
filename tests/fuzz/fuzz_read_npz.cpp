// Archives of arrays: any bytes are a body, a motion that keeps its rules, or an Error.
#include <cstddef>
#include <cstdint>

#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_body.h"
#include "limber/document/smpl/smpl_motion.h"

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
