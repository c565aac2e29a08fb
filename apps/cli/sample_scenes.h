// The project's example scenes (samples/scenes), which the program carries with it.
#pragma once

#include <span>
#include <string_view>

namespace limber::cli {

struct SampleScene {
  std::string_view name;      // "dancing-stool"
  std::string_view commands;  // JSON, as `limber session replay` takes it
};

// By name.
std::span<const SampleScene> sampleScenes();

}  // namespace limber::cli
