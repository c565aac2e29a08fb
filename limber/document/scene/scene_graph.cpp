// Builds the node tree without recursion: a hostile file may nest nodes as deep as it likes.
#include "limber/document/scene/scene_graph.h"

#include "limber/core/transform.h"

namespace limber {

Affine nodeTransform(const gltf::Node& node) {
  if (node.matrix) {
    Affine result;
    result.matrix() = *node.matrix;
    result.makeAffine();
    return result;
  }
  Transform transform;
  if (node.translation) transform.translation = *node.translation;
  if (node.rotation) {
    transform.rotation.coeffs() = *node.rotation;
    const double length = transform.rotation.norm();
    transform.rotation = length > 0 ? transform.rotation.normalized() : Quat::Identity();
  }
  if (node.scale) transform.scale = *node.scale;
  return transform.toAffine();
}

namespace {

// Depth first from `roots`; children in file order. A node met twice (which checkAsset forbids) is taken once.
std::vector<Index> depthFirst(const std::vector<gltf::Node>& nodes, const std::vector<Index>& roots) {
  std::vector<Index> order;
  std::vector<bool> met(nodes.size(), false);
  std::vector<Index> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const Index node = stack.back();
    stack.pop_back();
    if (met[node]) continue;
    met[node] = true;
    order.push_back(node);
    stack.insert(stack.end(), nodes[node].children.rbegin(), nodes[node].children.rend());
  }
  return order;
}

}  // namespace

std::vector<Index> rootsOf(const SceneGraph& graph) {
  std::vector<Index> roots;
  for (Index n = 0; n < graph.nodeCount(); ++n) {
    if (!graph.parent[n]) roots.push_back(n);
  }
  return roots;
}

bool isPlacedByJoints(const gltf::Node& node) {
  return node.skin && node.children.empty();
}

std::vector<bool> animatedNodes(const gltf::Document& document) {
  std::vector<bool> animated(document.nodes.size(), false);
  for (const gltf::Animation& animation : document.animations) {
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const gltf::AnimationChannel::Target& target = channel.target;
      if (target.node && !target.path.empty() && target.path != "weights") animated[*target.node] = true;
    }
  }
  return animated;
}

std::vector<Index> sceneNodes(const gltf::Document& document, Index scene) {
  return depthFirst(document.nodes, document.scenes[scene].nodes);
}

SceneGraph readSceneGraph(const gltf::Document& document) {
  const Index count = document.nodeCount();
  SceneGraph graph;
  graph.parent.resize(count);
  graph.local.resize(count);
  for (Index n = 0; n < count; ++n) {
    graph.local[n] = nodeTransform(document.nodes[n]);
    for (const Index child : document.nodes[n].children) graph.parent[child] = n;
  }

  graph.allNodes = depthFirst(document.nodes, rootsOf(graph));
  graph.world = graph.local;
  for (const Index n : graph.allNodes) {
    if (graph.parent[n]) graph.world[n] = graph.world[*graph.parent[n]] * graph.local[n];
  }

  graph.order = document.scenes.empty() ? graph.allNodes : sceneNodes(document, document.scene.value_or(0));
  graph.shown.assign(count, false);
  for (const Index n : graph.order) graph.shown[n] = true;
  return graph;
}

}  // namespace limber
