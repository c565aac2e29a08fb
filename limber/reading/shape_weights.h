// The networks that read shapes: those that limber comes with, and others in their place.
#pragma once

#include <filesystem>
#include <memory>

#include "limber/core/file/file.h"

namespace limber {

struct ReadingWeights;

// Those that setShapeWeights gave; else those that limber comes with (data/shapes.lrd), parsed by the first call. They are
// part of the library; the WebAssembly engine leaves them out and asks its loader for them (bindings/wasm/limber.mjs).
// Throws Error kUnsupported where that has none, and what readReadingWeights throws. Threads may call it at once.
std::shared_ptr<const ReadingWeights> shapeWeights();

// A file's bytes, for all calls of shapeWeights from now on. Throws as readReadingWeights does; then all is as it was.
void setShapeWeights(ByteSpan file);

// The networks in a file. Throws as readFile and readReadingWeights do, with the path in where().
std::shared_ptr<const ReadingWeights> readShapeWeights(const std::filesystem::path& path);

}  // namespace limber
