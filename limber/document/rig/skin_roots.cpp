#include "limber/document/rig/skin_roots.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "limber/document/scene/scene_graph.h"

namespace limber {

void joinSkinRoots(gltf::Document& document, UniqueNames& names) {
  const SceneGraph graph = readSceneGraph(document);
  std::vector<Index> rootOf(graph.nodeCount());
  for (const Index n : graph.allNodes) rootOf[n] = graph.parent[n] ? rootOf[*graph.parent[n]] : n;
  std::set<Index> joined;
  for (const gltf::Skin& skin : document.skins) {
    std::set<Index> roots;
    for (const Index joint : skin.joints) roots.insert(rootOf[joint]);
    if (roots.size() > 1) joined.insert(roots.begin(), roots.end());
  }
  if (joined.empty()) return;
  gltf::Node node;
  node.name = names.add("Skeleton");
  node.children.assign(joined.begin(), joined.end());
  const Index top = addElement(document.nodes, std::move(node));
  std::vector<Index>& roots = document.scenes.at(document.scene.value()).nodes;
  std::replace_if(
      roots.begin(), roots.end(), [&](Index root) { return root == *joined.begin(); }, top);
  std::erase_if(roots, [&](Index root) { return joined.count(root) > 0; });
}

}  // namespace limber
