#include "limber/document/gltf/check_asset.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "limber/document/gltf/document_errors.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

void checkNodes(const gltf::Document& document) {
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const gltf::Node& node = document.nodes[i];
    const auto locationOf = [&](const char* key) { return fmt::format("nodes[{}].{}", i, key); };
    requireElement(node.mesh, document.meshes.size(), [&] { return locationOf("mesh"); });
    requireElement(node.skin, document.skins.size(), [&] { return locationOf("skin"); });
    requireElement(node.camera, document.cameras.size(), [&] { return locationOf("camera"); });
    if (node.matrix && (node.translation || node.rotation || node.scale)) {
      failAt(fmt::format("nodes[{}]", i), "has both a matrix and a translation, rotation or scale");
    }
    if (node.rotation && node.rotation->squaredNorm() < kMinSquaredRotation) {
      failAt(locationOf("rotation"), "is zero, which is no rotation");
    }
  }
}

// The parent of each node, kNoIndex for roots.
std::vector<Index> checkParents(const std::vector<gltf::Node>& nodes) {
  std::vector<Index> parent(nodes.size(), kNoIndex);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t c = 0; c < nodes[i].children.size(); ++c) {
      const Index child = nodes[i].children[c];
      const auto location = [&] { return fmt::format("nodes[{}].children[{}]", i, c); };
      requireElement(child, nodes.size(), location);
      if (parent[child] != kNoIndex) {
        failAt(location(), fmt::format("is node {}, which is a child of node {} already", child, parent[child]));
      }
      parent[child] = static_cast<Index>(i);
    }
  }
  return parent;
}

// With one parent at most, a node that no root leads to hangs on a cycle.
void checkNoCycle(const std::vector<gltf::Node>& nodes, const std::vector<Index>& parent) {
  std::vector<bool> reached(parent.size(), false);
  std::vector<Index> open;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    if (parent[i] == kNoIndex) open.push_back(static_cast<Index>(i));
  }
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    reached[node] = true;
    open.insert(open.end(), nodes[node].children.begin(), nodes[node].children.end());
  }
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost != reached.end()) failAt(fmt::format("nodes[{}]", lost - reached.begin()), "is its own ancestor");
}

void checkScenes(const gltf::Document& document, const std::vector<Index>& parent) {
  const std::vector<gltf::Scene>& scenes = document.scenes;
  std::vector<std::size_t> listedIn(parent.size(), scenes.size());
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    for (std::size_t i = 0; i < scenes[s].nodes.size(); ++i) {
      const Index node = scenes[s].nodes[i];
      const auto location = [&] { return fmt::format("scenes[{}].nodes[{}]", s, i); };
      requireElement(node, parent.size(), location);
      if (parent[node] != kNoIndex) failAt(location(), fmt::format("is node {}, which is no root", node));
      if (listedIn[node] == s) failAt(location(), fmt::format("is node {}, which the scene has already", node));
      listedIn[node] = s;
    }
  }
  requireElement(document.scene, scenes.size(), [] { return "scene"; });
}

void checkAnimations(const gltf::Document& document) {
  for (std::size_t a = 0; a < document.animations.size(); ++a) {
    const gltf::Animation& animation = document.animations[a];
    for (std::size_t i = 0; i < animation.samplers.size(); ++i) {
      const auto locationOf = [&](const char* key) { return fmt::format("animations[{}].samplers[{}].{}", a, i, key); };
      requireElement(animation.samplers[i].input, document.accessors.size(), [&] { return locationOf("input"); });
      requireElement(animation.samplers[i].output, document.accessors.size(), [&] { return locationOf("output"); });
    }
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
      const gltf::AnimationChannel& channel = animation.channels[i];
      const auto locationOf = [&](const char* key) { return fmt::format("animations[{}].channels[{}].{}", a, i, key); };
      requireElement(channel.sampler, animation.samplers.size(), [&] { return locationOf("sampler"); });
      requireElement(channel.target.node, document.nodes.size(), [&] { return locationOf("target.node"); });
      requireElement(channelTarget(channel).node, document.nodes.size(), [&] { return locationOf("target"); });
    }
  }
}

void checkMaterials(const gltf::Document& document) {
  for (std::size_t i = 0; i < document.images.size(); ++i) {
    requireElement(document.images[i].bufferView, document.bufferViews.size(),
                   [&] { return fmt::format("images[{}].bufferView", i); });
  }
  for (std::size_t i = 0; i < document.textures.size(); ++i) {
    requireElement(document.textures[i].source, document.images.size(),
                   [&] { return fmt::format("textures[{}].source", i); });
    requireElement(document.textures[i].sampler, document.samplers.size(),
                   [&] { return fmt::format("textures[{}].sampler", i); });
  }
  for (std::size_t i = 0; i < document.materials.size(); ++i) {
    const gltf::Material& material = document.materials[i];
    const auto check = [&](const std::optional<gltf::TextureUse>& use, const char* key) {
      if (!use) return;
      requireElement(use->index, document.textures.size(),
                     [&] { return fmt::format("materials[{}].{}.index", i, key); });
    };
    check(material.normalTexture, "normalTexture");
    check(material.occlusionTexture, "occlusionTexture");
    check(material.emissiveTexture, "emissiveTexture");
    if (!material.pbrMetallicRoughness) continue;
    check(material.pbrMetallicRoughness->baseColorTexture, "pbrMetallicRoughness.baseColorTexture");
    check(material.pbrMetallicRoughness->metallicRoughnessTexture, "pbrMetallicRoughness.metallicRoughnessTexture");
  }
}

}  // namespace

void checkAsset(const Asset& asset) {
  const gltf::Document& document = asset.document;
  checkNodes(document);
  const std::vector<Index> parent = checkParents(document.nodes);
  checkNoCycle(document.nodes, parent);
  checkScenes(document, parent);
  checkAnimations(document);
  checkMaterials(document);
  checkData(asset);
}

}  // namespace limber
