#include "limber/document/vrm/vrm0_expressions.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/core/text/names.h"
#include "limber/document/unique_names.h"
#include "limber/document/vrm/loose_json.h"
#include "limber/document/vrm/vrm_expressions.h"

namespace limber {

namespace {

using NamePair = std::pair<std::string_view, const char*>;

constexpr std::array<NamePair, 18> kPresets = {{{"neutral", "neutral"},
                                                {"a", "aa"},
                                                {"i", "ih"},
                                                {"u", "ou"},
                                                {"e", "ee"},
                                                {"o", "oh"},
                                                {"blink", "blink"},
                                                {"blink_l", "blinkLeft"},
                                                {"blink_r", "blinkRight"},
                                                {"joy", "happy"},
                                                {"angry", "angry"},
                                                {"sorrow", "sad"},
                                                {"fun", "relaxed"},
                                                {"surprised", "surprised"},
                                                {"lookup", "lookUp"},
                                                {"lookdown", "lookDown"},
                                                {"lookleft", "lookLeft"},
                                                {"lookright", "lookRight"}}};
constexpr std::array<NamePair, 5> kColors = {{{"_Color", "color"},
                                              {"_EmissionColor", "emissionColor"},
                                              {"_ShadeColor", "shadeColor"},
                                              {"_RimColor", "rimColor"},
                                              {"_OutlineColor", "outlineColor"}}};

template <std::size_t Size>
const char* partnerOf(const std::array<NamePair, Size>& pairs, std::string_view name) {
  const auto* found =
      std::find_if(pairs.begin(), pairs.end(), [&](const NamePair& pair) { return pair.first == name; });
  return found == pairs.end() ? nullptr : found->second;
}

constexpr std::size_t kMaxBinds = 1'000'000;  // many nodes that show one mesh multiply a small file

// In 0.x a bind names a mesh, in 1.0 each node that shows it; weights go up to 100 there.
Json morphBinds(const gltf::Document& document, const std::vector<std::vector<Index>>& nodesOfMesh, const Json& group,
                std::size_t& count) {
  Json binds = Json::array();
  for (const Json& bind : listIn(group, "binds")) {
    const std::optional<Index> mesh = indexIn(bind, "mesh", document.meshes.size());
    if (!mesh || document.meshes[*mesh].primitives.empty()) continue;
    const std::size_t shapes = document.meshes[*mesh].primitives.front().targets.size();
    const std::optional<Index> shape = indexIn(bind, "index", shapes);
    if (!shape) continue;
    count += nodesOfMesh[*mesh].size();
    if (count > kMaxBinds) throw Error(ErrorCode::kLimit, "has more than a million changes of shapes by expressions");
    for (const Index n : nodesOfMesh[*mesh]) {
      binds.push_back({{"node", n}, {"index", *shape}, {"weight", numberIn(bind, "weight", 100) / 100}});
    }
  }
  return binds;
}

// Of the first material of that name; there is no other reference in 0.x.
void addMaterialBinds(const std::map<std::string, Index>& materials, const Json& group, Json& expression,
                      std::size_t& unknown) {
  for (const Json& value : listIn(group, "materialValues")) {
    const std::string name = textIn(value, "materialName"), property = textIn(value, "propertyName");
    const char* color = partnerOf(kColors, property);
    const bool isTextureTransform = property == "_MainTex_ST";
    unknown += color == nullptr && !isTextureTransform ? 1 : 0;
    const std::vector<double> numbers = numbersIn(
        value, "targetValue", isTextureTransform ? std::vector<double>{1, 1, 0, 0} : std::vector<double>{0, 0, 0, 1});
    const auto found = materials.find(name);
    if (found == materials.end()) continue;
    const Index m = found->second;
    if (color != nullptr) {
      expression["materialColorBinds"].push_back({{"material", m}, {"type", color}, {"targetValue", numbers}});
    } else if (isTextureTransform) {  // Unity's v grows upwards
      const Json scale = {numbers[0], numbers[1]}, offset = {numbers[2], 1 - numbers[3] - numbers[1]};
      expression["textureTransformBinds"].push_back({{"material", m}, {"scale", scale}, {"offset", offset}});
    }
  }
}

// What each group is in 1.0, null where it is none of its presets: as its preset says, in any case of letters, else as
// it is called, where no other group says so.
std::vector<const char*> presetsOf(const Json& groups) {
  std::vector<const char*> presets;
  std::set<std::string_view> said;
  for (const Json& group : groups) {
    presets.push_back(partnerOf(kPresets, lowerCase(textIn(group, "presetName"))));
    if (presets.back() != nullptr) said.insert(presets.back());
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (presets[g] != nullptr) continue;
    const char* called = partnerOf(kPresets, lowerCase(textIn(groups[g], "name")));
    if (called != nullptr && said.count(called) == 0) presets[g] = called;
  }
  return presets;
}

}  // namespace

Json expressionsOfVrm0(Asset& asset, const Json& blendShapeMaster) {
  Json preset = Json::object(), custom = Json::object();
  UniqueNames names;
  for (const std::string_view known : vrmExpressionNames()) names.add(std::string(known));
  const gltf::Document& document = asset.document;
  std::map<std::string, Index> materials;
  for (Index m = 0; m < document.materials.size(); ++m) materials.emplace(document.materials[m].name, m);
  std::vector<std::vector<Index>> nodesOfMesh(document.meshes.size());
  for (Index n = 0; n < document.nodeCount(); ++n) {
    if (document.nodes[n].mesh) nodesOfMesh[*document.nodes[n].mesh].push_back(n);
  }
  std::size_t unknown = 0, bindCount = 0;
  const Json& groups = listIn(blendShapeMaster, "blendShapeGroups");
  const std::vector<const char*> presets = presetsOf(groups);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Json& group = groups[g];
    Json expression = Json::object();
    if (flagIn(group, "isBinary")) expression["isBinary"] = true;
    Json binds = morphBinds(document, nodesOfMesh, group, bindCount);
    if (!binds.empty()) expression["morphTargetBinds"] = std::move(binds);
    addMaterialBinds(materials, group, expression, unknown);
    const std::string name = textIn(group, "name");
    if (presets[g] != nullptr && !preset.contains(presets[g])) {
      preset[presets[g]] = std::move(expression);
    } else if (presets[g] != nullptr || !name.empty()) {
      custom[names.add(name.empty() ? presets[g] : name)] = std::move(expression);
    }
  }
  asset.warnings.add("vrm0-expressions",
                     "changes of materials by expressions have no place in VRM 1.0 and are left out", {}, unknown);
  if (preset.empty() && custom.empty()) return nullptr;
  Json expressions = Json::object();
  if (!preset.empty()) expressions["preset"] = std::move(preset);
  if (!custom.empty()) expressions["custom"] = std::move(custom);
  return expressions;
}

}  // namespace limber
