#include "limber/document/scene/turn_scene.h"

#include <algorithm>
#include <map>

#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

void turnScene(Asset& asset, const Quat& turn, const std::string& name) {
  gltf::Document& document = asset.document;
  if (document.scenes.empty()) document.scenes.emplace_back().nodes = rootsOf(readSceneGraph(document));
  UniqueNames names;
  for (const gltf::Node& node : document.nodes) names.add(node.name);
  std::map<Index, Index> above;  // the turning node of each root that has one
  for (gltf::Scene& scene : document.scenes) {
    std::vector<Index> below, roots;
    const Index top = document.nodeCount();
    for (const Index root : scene.nodes) {
      if (isPlacedByJoints(document.nodes[root])) {
        roots.push_back(root);
        continue;
      }
      const auto [turned, isNew] = above.try_emplace(root, top);
      if (isNew) below.push_back(root);
      if (std::find(roots.begin(), roots.end(), turned->second) == roots.end()) roots.push_back(turned->second);
    }
    scene.nodes = std::move(roots);
    if (below.empty()) continue;
    gltf::Node node;
    node.name = names.add(name);
    node.children = std::move(below);
    setNodeTransform(node, Affine(turn), false);
    document.nodes.push_back(std::move(node));
  }
}

}  // namespace limber
