// Reading BVH text: bytes a second over growing files.
#include <cmath>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "limber/document/bvh/bvh_read.h"

namespace limber {
namespace {

// 60 joints in a chain with three rotations each, six decimals, as capture software writes them.
std::string bvhText(int frames) {
  std::string text = "HIERARCHY\n";
  for (int j = 0; j < 60; ++j) {
    text += fmt::format("{} joint{}\n{{\nOFFSET 0 0.1 0\nCHANNELS {} Zrotation Xrotation Yrotation\n",
                        j == 0 ? "ROOT" : "JOINT", j, j == 0 ? "6 Xposition Yposition Zposition" : "3");
  }
  text += std::string(60, '}') + fmt::format("\nMOTION\nFrames: {}\nFrame Time: 0.00833333\n", frames);
  for (int k = 0; k < frames; ++k) {
    for (int i = 0; i < 183; ++i) text += fmt::format("{:.6f} ", 90 * std::sin(0.01 * k + i));
    text += '\n';
  }
  return text;
}

void bvhRead(benchmark::State& state) {
  const std::string text = bvhText(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(readBvh(asBytes(text), "bench.bvh"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(bvhRead)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limber
