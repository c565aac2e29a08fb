#include "limber/document/vrm/vrm_expressions.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "limber/document/scene/scene_graph.h"
#include "limber/document/scene/shape_name.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 18> kNames = {
    "happy", "angry", "sad",   "relaxed",   "surprised",  "neutral", "aa",       "ih",       "ou",
    "ee",    "oh",    "blink", "blinkLeft", "blinkRight", "lookUp",  "lookDown", "lookLeft", "lookRight"};

}  // namespace

std::span<const std::string_view> vrmExpressionNames() {
  return kNames;
}

Json expressionsByName(const gltf::Document& document) {
  Json preset = Json::object();
  for (const Index n : readSceneGraph(document).order) {
    const std::optional<Index> mesh = document.nodes[n].mesh;
    if (!mesh || document.meshes[*mesh].primitives.empty()) continue;
    const std::size_t shapes = document.meshes[*mesh].primitives.front().targets.size();
    for (std::size_t s = 0; s < shapes; ++s) {
      const std::string name = shapeName(document.meshes[*mesh], s);
      if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) continue;
      preset[name]["morphTargetBinds"].push_back({{"node", n}, {"index", s}, {"weight", 1.0}});
    }
  }
  if (preset.empty()) return nullptr;
  return {{"preset", std::move(preset)}};
}

}  // namespace limber
