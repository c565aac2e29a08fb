// Where a document's nodes stand while it moves, by its nodes and channels alone.
#pragma once

#include <span>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/scene_graph.h"

namespace limber::testing {

// At a key of the document's first animation.
inline std::vector<Vec3> nodesAt(const Asset& asset, std::span<const Index> nodes, double seconds) {
  gltf::Document document = asset.document;
  for (const gltf::AnimationChannel& channel : document.animations[0].channels) {
    const gltf::AnimationSampler& sampler = document.animations[0].samplers[channel.sampler];
    const std::vector<float> times = readFloats(asset, sampler.input), values = readFloats(asset, sampler.output);
    std::size_t key = 0;
    while (key + 1 < times.size() && times[key + 1] <= seconds + 1e-6) ++key;
    gltf::Node& node = document.nodes[*channel.target.node];
    if (channel.target.path == "rotation") {
      node.rotation = Eigen::Map<const Eigen::Vector4f>(&values[4 * key]).cast<double>();
    } else if (channel.target.path == "translation") {
      node.translation = Eigen::Map<const Vec3f>(&values[3 * key]).cast<double>();
    }
  }
  const SceneGraph graph = readSceneGraph(document);
  std::vector<Vec3> positions;
  for (const Index node : nodes) positions.push_back(graph.world[node].translation());
  return positions;
}

}  // namespace limber::testing
