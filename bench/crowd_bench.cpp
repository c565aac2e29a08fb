// Bytes and seconds of crowds over growing counts of bodies: numbers must not grow with these.
#include <benchmark/benchmark.h>

#include <vector>

#include "limber/crowd/crowd.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/samples.h"

namespace {

using namespace limber;

void crowd(benchmark::State& state) {
  std::vector<Asset> characters;
  characters.push_back(makeSample("flying"));
  const std::vector<Motion> motions = {makeSampleMotion("flap")};
  CrowdOptions options;
  options.bodies = static_cast<Index>(state.range(0));
  for (auto _ : state) {
    Progress progress;
    const Crowd made = makeCrowd(characters, motions, options, progress);
    state.counters["bytes"] = static_cast<double>(made.asset.buffers[0].bytes.size());
  }
}

BENCHMARK(crowd)->RangeMultiplier(4)->Range(16, 1024)->Unit(benchmark::kMillisecond);

}  // namespace
