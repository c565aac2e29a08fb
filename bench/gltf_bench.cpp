// Reading and writing glTF: bytes a second of models that are mostly vertices, and of documents that are mostly nodes.
// The floor of reading vertices is a copy of the file's bytes (gltfCopy); that of nodes is parsing their JSON
// (gltfParseNodes).
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench_models.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/read.h"
#include "limber/document/write.h"

namespace limber {
namespace {

Bytes modelOf(Index vertices) {
  return writeGlb(meshAsset(bench::robot(vertices)));
}

// A chain of nodes with a name, a translation and a rotation each, as skeletons have them.
std::string nodesText(int count) {
  std::string text = R"({"asset":{"version":"2.0"},"nodes":[)";
  for (int n = 0; n < count; ++n) {
    text += fmt::format(R"({}{{"name":"joint_{}","translation":[0.125,{},0.5],"rotation":[0,0.6,0,0.8])",
                        n > 0 ? "," : "", n, 0.001 * n);
    text += n % 100 < 99 && n + 1 < count ? fmt::format(R"(,"children":[{}]}})", n + 1) : std::string("}");
  }
  return text + "]}";
}

void gltfCopy(benchmark::State& state) {
  const Bytes file = modelOf(static_cast<Index>(state.range(0)));
  for (auto _ : state) {
    Bytes copy = file;
    benchmark::DoNotOptimize(copy.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}
BENCHMARK(gltfCopy)->Arg(50'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void gltfRead(benchmark::State& state) {
  const Bytes file = modelOf(static_cast<Index>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(readAsset(file, "bench.glb"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}
BENCHMARK(gltfRead)->Arg(50'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void gltfWrite(benchmark::State& state) {
  const Bytes file = modelOf(static_cast<Index>(state.range(0)));
  const Asset asset = readAsset(file, "bench.glb");
  for (auto _ : state) benchmark::DoNotOptimize(writeGlb(asset));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(file.size()));
}
BENCHMARK(gltfWrite)->Arg(50'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void gltfParseNodes(benchmark::State& state) {
  const std::string text = nodesText(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    Warnings warnings;
    benchmark::DoNotOptimize(parseJson(text, warnings));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(gltfParseNodes)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

void gltfReadNodes(benchmark::State& state) {
  const std::string text = nodesText(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(readAsset(asBytes(text), "bench.gltf"));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(gltfReadNodes)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

void gltfWriteNodes(benchmark::State& state) {
  const std::string text = nodesText(static_cast<int>(state.range(0)));
  const Asset asset = readAsset(asBytes(text), "bench.gltf");
  for (auto _ : state) benchmark::DoNotOptimize(writeGlb(asset));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(gltfWriteNodes)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limber
