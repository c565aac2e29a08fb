// Builds the node tree without recursion: a hostile file may nest nodes as deep as it likes.
#include "limber/asset/scene_graph.h"

#include <nlohmann/json.hpp>

#include "limber/core/transform.h"

namespace limber {

const Json* member(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<Index> indexMember(const Json& object, const char* key) {
  const Json* value = member(object, key);
  if (!value || !value->is_number()) return std::nullopt;
  const double index = value->get<double>();  // some writers give whole numbers as 3.0
  if (!(index >= 0 && index < kNoIndex)) return std::nullopt;
  return static_cast<Index>(index);
}

std::string nameOf(const Json& object) {
  const Json* name = member(object, "name");
  return name && name->is_string() ? name->get<std::string>() : std::string();
}

const Json& elements(const Asset& asset, const char* kind) {
  static const Json kNone = Json::array();
  const Json* list = member(asset.json(), kind);
  return list ? *list : kNone;
}

Index elementCount(const Asset& asset, const char* kind) {
  return static_cast<Index>(elements(asset, kind).size());
}

Affine nodeTransform(const Json& node) {
  if (const Json* matrix = member(node, "matrix")) {
    Affine result;
    for (int i = 0; i < 16; ++i) result.matrix()(i % 4, i / 4) = (*matrix)[i].get<double>();
    result.makeAffine();
    return result;
  }
  Transform transform;
  if (const Json* t = member(node, "translation")) {
    for (int i = 0; i < 3; ++i) transform.translation[i] = (*t)[i].get<double>();
  }
  if (const Json* r = member(node, "rotation")) {
    for (int i = 0; i < 4; ++i) transform.rotation.coeffs()[i] = (*r)[i].get<double>();
    const double length = transform.rotation.norm();
    transform.rotation = length > 0 ? transform.rotation.normalized() : Quat::Identity();
  }
  if (const Json* s = member(node, "scale")) {
    for (int i = 0; i < 3; ++i) transform.scale[i] = (*s)[i].get<double>();
  }
  return transform.toAffine();
}

namespace {

// Depth first from `roots`; children in file order. A node met twice (which checkAsset forbids) is taken once.
std::vector<Index> depthFirst(const Json& nodes, const std::vector<Index>& roots) {
  std::vector<Index> order;
  std::vector<bool> met(nodes.size(), false);
  std::vector<Index> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const Index node = stack.back();
    stack.pop_back();
    if (met[node]) continue;
    met[node] = true;
    order.push_back(node);
    if (const Json* children = member(nodes[node], "children")) {
      for (auto child = children->rbegin(); child != children->rend(); ++child) stack.push_back(child->get<Index>());
    }
  }
  return order;
}

std::vector<Index> rootsOf(const SceneGraph& graph) {
  std::vector<Index> roots;
  for (Index n = 0; n < graph.nodeCount(); ++n) {
    if (!graph.parent[n]) roots.push_back(n);
  }
  return roots;
}

}  // namespace

std::vector<Index> sceneNodes(const Asset& asset, Index scene) {
  std::vector<Index> roots;
  if (const Json* list = member(elements(asset, "scenes")[scene], "nodes")) {
    for (const Json& root : *list) roots.push_back(root.get<Index>());
  }
  return depthFirst(elements(asset, "nodes"), roots);
}

SceneGraph readSceneGraph(const Asset& asset) {
  const Json& nodes = elements(asset, "nodes");
  const Index count = elementCount(asset, "nodes");
  SceneGraph graph;
  graph.parent.resize(count);
  graph.local.resize(count);
  for (Index n = 0; n < count; ++n) {
    graph.local[n] = nodeTransform(nodes[n]);
    if (const Json* children = member(nodes[n], "children")) {
      for (const Json& child : *children) graph.parent[child.get<Index>()] = n;
    }
  }

  graph.allNodes = depthFirst(nodes, rootsOf(graph));
  graph.world = graph.local;
  for (const Index n : graph.allNodes) {
    if (graph.parent[n]) graph.world[n] = graph.world[*graph.parent[n]] * graph.local[n];
  }

  const bool hasScene = elementCount(asset, "scenes") > 0;
  graph.order = hasScene ? sceneNodes(asset, indexMember(asset.json(), "scene").value_or(0)) : graph.allNodes;
  graph.shown.assign(count, false);
  for (const Index n : graph.order) graph.shown[n] = true;
  return graph;
}

}  // namespace limber
