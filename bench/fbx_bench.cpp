// Reading and writing FBX: of a rigged model of so many vertices, a vertex each corner of its own as FBX has them. The
// floor of reading is the file's records, with their arrays inflated (fbxRecords).
#include <benchmark/benchmark.h>

#include "bench_models.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/core/progress.h"
#include "limber/document/fbx/export_fbx.h"
#include "limber/document/fbx/records/fbx_parse.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/read.h"

namespace limber {
namespace {

Asset rigged(Index vertices) {
  Progress progress;
  Asset asset = meshAsset(bench::robot(vertices));
  autoRig(asset, {}, progress);
  return asset;
}

void fbxRecords(benchmark::State& state) {
  const Bytes file = encodeFbx(rigged(static_cast<Index>(state.range(0)))).bytes;
  for (auto _ : state) benchmark::DoNotOptimize(parseFbx(file));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}
BENCHMARK(fbxRecords)->Arg(50'000)->Unit(benchmark::kMillisecond);

void fbxRead(benchmark::State& state) {
  const Bytes file = encodeFbx(rigged(static_cast<Index>(state.range(0)))).bytes;
  for (auto _ : state) benchmark::DoNotOptimize(readAsset(file, "bench.fbx"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}
BENCHMARK(fbxRead)->Arg(50'000)->Unit(benchmark::kMillisecond);

void fbxWrite(benchmark::State& state) {
  const Asset asset = rigged(static_cast<Index>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(encodeFbx(asset).bytes);
}
BENCHMARK(fbxWrite)->Arg(50'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limber
