#include "limber/reading/shape_weights.h"

#include <cstdint>
#include <mutex>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/known_error.h"
#include "limber/reading/weights_file.h"

#ifdef __EMSCRIPTEN__
#include <emscripten.h>

#include <cstdlib>

// The bytes that Module.shapeWeights gives (bindings/wasm/limber.mjs), to be freed; null where it gives none.
// clang-format off
EM_JS(std::uint8_t*, limber_page_shape_weights, (std::size_t* size), {
  const bytes = Module["shapeWeights"] && Module["shapeWeights"]();
  if (!bytes) return 0;
  const at = _malloc(bytes.length) >>> 0;
  if (at === 0) return 0;
  HEAPU8.set(bytes, at);
  HEAPU32[size >>> 2] = bytes.length;
  return at;
});
// clang-format on
#else
// The assembler reads the file, so that a megabyte takes no time to compile.
asm(".pushsection .rodata\n"
    ".global limber_shape_weights, limber_shape_weights_end\n"
    ".hidden limber_shape_weights\n"
    ".hidden limber_shape_weights_end\n"
    "limber_shape_weights:\n"
    // clang-format off
    ".incbin \"" LIMBER_SHAPE_WEIGHTS "\"\n"
    // clang-format on
    "limber_shape_weights_end:\n"
    ".byte 0\n"
    ".popsection\n");
extern "C" {
extern const std::uint8_t limber_shape_weights[] __attribute__((visibility("hidden")));
extern const std::uint8_t limber_shape_weights_end[] __attribute__((visibility("hidden")));
}
#endif

namespace limber {

namespace {

std::shared_ptr<const ReadingWeights> parsed(ByteSpan file) {
  return std::make_shared<const ReadingWeights>(readReadingWeights(file));
}

#ifdef __EMSCRIPTEN__
std::shared_ptr<const ReadingWeights> ownWeights() {
  std::size_t size = 0;
  const std::unique_ptr<std::uint8_t, decltype(&std::free)> bytes(limber_page_shape_weights(&size), &std::free);
  if (!bytes) {
    throw Error(ErrorCode::kUnsupported, "the networks that read shapes are not loaded", {},
                "give the engine shapes.lrd first: setShapeWeights");
  }
  return parsed({bytes.get(), size});
}
#else
std::shared_ptr<const ReadingWeights> ownWeights() {
  return parsed({limber_shape_weights, limber_shape_weights_end});
}
#endif

struct SharedWeights {
  std::mutex mutex;
  std::shared_ptr<const ReadingWeights> weights;
};

SharedWeights& sharedWeights() {
  static SharedWeights shared;
  return shared;
}

}  // namespace

std::shared_ptr<const ReadingWeights> shapeWeights() {
  SharedWeights& shared = sharedWeights();
  const std::lock_guard lock(shared.mutex);
  if (!shared.weights) shared.weights = ownWeights();
  return shared.weights;
}

void setShapeWeights(ByteSpan file) {
  std::shared_ptr<const ReadingWeights> weights = parsed(file);
  SharedWeights& shared = sharedWeights();
  const std::lock_guard lock(shared.mutex);
  shared.weights = std::move(weights);
}

std::shared_ptr<const ReadingWeights> readShapeWeights(const std::filesystem::path& path) {
  const Bytes file = readFile(path);
  try {
    return parsed(file);
  } catch (const Error& error) {
    throwWithin(error, path.string());
  }
}

}  // namespace limber
