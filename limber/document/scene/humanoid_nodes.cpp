#include "limber/document/scene/humanoid_nodes.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

std::string_view boneOfVrm0(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kThumbs = {
      {{"leftThumbProximal", "leftThumbMetacarpal"},
       {"leftThumbIntermediate", "leftThumbProximal"},
       {"rightThumbProximal", "rightThumbMetacarpal"},
       {"rightThumbIntermediate", "rightThumbProximal"}}};
  const auto* found =
      std::find_if(kThumbs.begin(), kThumbs.end(), [&](const auto& pair) { return pair.first == name; });
  return found == kThumbs.end() ? name : found->second;
}

std::vector<HumanoidNode> humanoidNodes(const gltf::Document& document, const char* extension) {
  const Json* content = extensionOf(document, extension);
  const Json* humanoid = content != nullptr ? member(*content, "humanoid") : nullptr;
  const Json* bones = humanoid != nullptr ? member(*humanoid, "humanBones") : nullptr;
  if (bones == nullptr) return {};
  std::map<std::string, Index, std::less<>> nodeOf;
  std::set<Index> used;
  const auto add = [&](std::string_view bone, const Json& holder) {
    const Json* node = member(holder, "node");
    if (node == nullptr || !node->is_number()) return;
    const double number = node->get<double>();
    if (!(number >= 0 && number < document.nodeCount())) return;
    const auto index = static_cast<Index>(number);
    if (nodeOf.count(bone) == 0 && used.insert(index).second) nodeOf.emplace(bone, index);
  };
  if (bones->is_object()) {
    for (const auto& [bone, holder] : bones->items()) add(bone, holder);
  } else if (bones->is_array()) {
    for (const Json& holder : *bones) {
      const Json* bone = member(holder, "bone");
      if (bone != nullptr && bone->is_string()) add(boneOfVrm0(bone->get_ref<const std::string&>()), holder);
    }
  }
  std::vector<HumanoidNode> nodes;
  for (const std::string_view bone : humanoidBones()) {
    if (const auto found = nodeOf.find(bone); found != nodeOf.end()) nodes.push_back({bone, found->second});
  }
  return nodes;
}

std::vector<HumanoidNode> declaredBones(const gltf::Document& document) {
  for (const char* extension : {kVrmName, kVrm0Name, kVrmAnimationName}) {
    std::vector<HumanoidNode> nodes = humanoidNodes(document, extension);
    if (!nodes.empty()) return nodes;
  }
  return {};
}

std::vector<std::string_view> declaredBoneOfNode(const gltf::Document& document) {
  std::vector<std::string_view> bones(document.nodes.size());
  for (const HumanoidNode& node : declaredBones(document)) bones[node.node] = node.bone;
  return bones;
}

}  // namespace limber
