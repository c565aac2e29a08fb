#include "limber/asset/turn_scene.h"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/unique_names.h"

namespace limber {

namespace {

bool isPlacedByJoints(const Json& node) {
  return node.contains("skin") && !node.contains("children");
}

// What the document shows that has no scene.
Json allRoots(const Asset& asset) {
  const SceneGraph graph = readSceneGraph(asset);
  Json roots = Json::array();
  for (Index n = 0; n < graph.nodeCount(); ++n) {
    if (!graph.parent[n]) roots.push_back(n);
  }
  return roots;
}

}  // namespace

void turnScene(Asset& asset, const Quat& turn, const std::string& name) {
  if (elementCount(asset, "scenes") == 0) asset.json()["scenes"] = Json::array({{{"nodes", allRoots(asset)}}});
  UniqueNames names;
  for (const Json& node : elements(asset, "nodes")) names.add(nameOf(node));
  Json& nodes = asset.json()["nodes"];
  std::map<Index, Index> above;  // the turning node of each root that has one
  for (Json& scene : asset.json()["scenes"]) {
    if (!scene.contains("nodes")) continue;
    Json below = Json::array(), roots = Json::array();
    const auto top = static_cast<Index>(nodes.size());
    for (const Json& entry : scene["nodes"]) {
      const auto root = entry.get<Index>();
      if (isPlacedByJoints(nodes[root])) {
        roots.push_back(root);
        continue;
      }
      const auto [turned, isNew] = above.try_emplace(root, top);
      if (isNew) below.push_back(root);
      const Json node = turned->second;
      if (std::find(roots.begin(), roots.end(), node) == roots.end()) roots.push_back(node);
    }
    scene["nodes"] = std::move(roots);
    if (below.empty()) continue;
    Json node = {{"name", names.add(name)}, {"children", std::move(below)}};
    setNodeTransform(node, Affine(turn), false);
    nodes.push_back(std::move(node));
  }
}

}  // namespace limber
