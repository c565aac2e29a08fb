#include "limber/asset/check_asset.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

void checkNames(std::initializer_list<JsonView> sections) {
  for (const JsonView& section : sections) {
    for (std::size_t i = 0; i < section.size(); ++i) {
      section[i].text("name");
      section[i].object("extensions");
    }
  }
}

void checkStrings(const JsonView& array) {
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (!array[i].json().is_string()) array[i].fail("must be a string");
  }
}

// What the rest of limber computes in float must fit it.
void checkNumbers(const JsonView& owner, std::string_view key, std::size_t count) {
  const JsonView array = owner.array(key);
  if (!array.exists()) return;
  if (array.size() != count) array.fail(fmt::format("must have {} numbers and has {}", count, array.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(array[i].asNumber()) > std::numeric_limits<float>::max()) array[i].fail("is too large for a float");
  }
}

void checkTransform(const JsonView& node) {
  checkNumbers(node, "matrix", 16);
  checkNumbers(node, "translation", 3);
  checkNumbers(node, "rotation", 4);
  checkNumbers(node, "scale", 3);
  const JsonView rotation = node.array("rotation");
  if (node.array("matrix").exists() &&
      (rotation.exists() || node.array("translation").exists() || node.array("scale").exists())) {
    node.fail("has both a matrix and a translation, rotation or scale");
  }
  if (!rotation.exists()) return;
  double squared = 0;
  for (std::size_t i = 0; i < 4; ++i) squared += rotation[i].asNumber() * rotation[i].asNumber();
  if (squared < 1e-12) rotation.fail("is zero, which is no rotation");
}

// The parent of each node, kNoIndex for roots.
std::vector<Index> checkParents(const JsonView& nodes) {
  std::vector<Index> parent(nodes.size(), kNoIndex);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const JsonView children = nodes[i].array("children");
    for (std::size_t c = 0; c < children.size(); ++c) {
      const Index child = children[c].asIndex(nodes.size());
      if (parent[child] != kNoIndex) {
        children[c].fail(fmt::format("is node {}, which is a child of node {} already", child, parent[child]));
      }
      parent[child] = static_cast<Index>(i);
    }
  }
  return parent;
}

// With one parent at most, a node that no root leads to hangs on a cycle.
void checkNoCycle(const JsonView& nodes, const std::vector<Index>& parent) {
  std::vector<bool> reached(parent.size(), false);
  std::vector<Index> open;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    if (parent[i] == kNoIndex) open.push_back(static_cast<Index>(i));
  }
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    reached[node] = true;
    const JsonView children = nodes[node].array("children");
    for (std::size_t c = 0; c < children.size(); ++c) open.push_back(children[c].asIndex(nodes.size()));
  }
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost != reached.end()) nodes[static_cast<std::size_t>(lost - reached.begin())].fail("is its own ancestor");
}

void checkScenes(const JsonView& root, const Sections& sections, const std::vector<Index>& parent) {
  std::vector<std::size_t> listedIn(parent.size(), sections.scenes.size());
  for (std::size_t s = 0; s < sections.scenes.size(); ++s) {
    const JsonView nodes = sections.scenes[s].array("nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Index node = nodes[i].asIndex(parent.size());
      if (parent[node] != kNoIndex) nodes[i].fail(fmt::format("is node {}, which is no root", node));
      if (listedIn[node] == s) nodes[i].fail(fmt::format("is node {}, which the scene has already", node));
      listedIn[node] = s;
    }
  }
  root.index("scene", sections.scenes.size());
}

void checkNodes(const Sections& sections) {
  for (std::size_t i = 0; i < sections.nodes.size(); ++i) {
    const JsonView node = sections.nodes[i];
    node.index("mesh", sections.meshes.size());
    node.index("skin", sections.skins.size());
    node.index("camera", sections.cameras.size());
    checkTransform(node);
  }
}

void checkAnimations(const Sections& sections) {
  for (std::size_t a = 0; a < sections.animations.size(); ++a) {
    const JsonView animation = sections.animations[a];
    const JsonView samplers = animation.array("samplers"), channels = animation.array("channels");
    for (std::size_t i = 0; i < samplers.size(); ++i) {
      samplers[i].requireIndex("input", sections.accessors.size());
      samplers[i].requireIndex("output", sections.accessors.size());
      samplers[i].text("interpolation");
    }
    for (std::size_t i = 0; i < channels.size(); ++i) {
      channels[i].requireIndex("sampler", samplers.size());
      const JsonView target = channels[i].object("target");
      if (!target.exists()) target.fail("is missing");
      target.index("node", sections.nodes.size());
      target.text("path");
    }
  }
}

void checkMaterials(const Sections& sections) {
  for (std::size_t i = 0; i < sections.images.size(); ++i) {
    sections.images[i].index("bufferView", sections.bufferViews.size());
    sections.images[i].text("uri");
    sections.images[i].text("mimeType");
  }
  for (std::size_t i = 0; i < sections.textures.size(); ++i) {
    sections.textures[i].index("source", sections.images.size());
    sections.textures[i].index("sampler", sections.samplers.size());
  }
  const auto checkTexture = [&](const JsonView& owner, std::string_view key) {
    const JsonView info = owner.object(key);
    if (info.exists()) info.requireIndex("index", sections.textures.size());
  };
  for (std::size_t i = 0; i < sections.materials.size(); ++i) {
    const JsonView material = sections.materials[i];
    for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) checkTexture(material, key);
    const JsonView metallicRoughness = material.object("pbrMetallicRoughness");
    for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"}) checkTexture(metallicRoughness, key);
    checkNumbers(metallicRoughness, "baseColorFactor", 4);
  }
}

}  // namespace

Sections::Sections(const Asset& asset)
    : accessors(JsonView(asset).array("accessors")),
      animations(JsonView(asset).array("animations")),
      bufferViews(JsonView(asset).array("bufferViews")),
      buffers(JsonView(asset).array("buffers")),
      cameras(JsonView(asset).array("cameras")),
      images(JsonView(asset).array("images")),
      materials(JsonView(asset).array("materials")),
      meshes(JsonView(asset).array("meshes")),
      nodes(JsonView(asset).array("nodes")),
      samplers(JsonView(asset).array("samplers")),
      scenes(JsonView(asset).array("scenes")),
      skins(JsonView(asset).array("skins")),
      textures(JsonView(asset).array("textures")) {}

void checkAsset(const Asset& asset) {
  const JsonView root(asset);
  const Sections sections(asset);
  checkStrings(root.array("extensionsUsed"));
  checkStrings(root.array("extensionsRequired"));
  checkNames({sections.accessors, sections.animations, sections.bufferViews, sections.buffers, sections.cameras,
              sections.images, sections.materials, sections.meshes, sections.nodes, sections.samplers, sections.scenes,
              sections.skins, sections.textures});
  checkNodes(sections);
  const std::vector<Index> parent = checkParents(sections.nodes);
  checkNoCycle(sections.nodes, parent);
  checkScenes(root, sections, parent);
  checkAnimations(sections);
  checkMaterials(sections);
  checkData(asset, sections);
}

}  // namespace limber
