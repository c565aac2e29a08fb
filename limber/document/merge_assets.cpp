#include "limber/document/merge_assets.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/references.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

// Lists that an extension keeps for the whole document, and that others refer to by number.
struct ExtensionList {
  const char *extension, *list;
};
constexpr std::array<ExtensionList, 2> kExtensionLists = {
    {{"KHR_lights_punctual", "lights"}, {"KHR_materials_variants", "variants"}}};

// Erases the extension from all objects within `value`.
void eraseExtensionWithin(Json& value, const std::string& name) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("extensions") && value["extensions"].is_object()) {
    value["extensions"].erase(name);
    if (value["extensions"].empty()) value.erase("extensions");
  }
  for (Json& inner : value) eraseExtensionWithin(inner, name);
}

// What no other part must be mixed up with, and cannot be taken over; and what refers to it.
void dropDocumentExtensions(gltf::Document& document, Warnings& warnings) {
  if (!document.extensions.exists()) return;
  std::vector<std::string> dropped;
  for (const auto& [name, content] : document.extensions->items()) {
    const bool isList = std::any_of(kExtensionLists.begin(), kExtensionLists.end(),
                                    [&, &known = name](const ExtensionList& of) { return known == of.extension; });
    if (!isList) dropped.push_back(name);
  }
  for (const std::string& name : dropped) {
    warnings.add("scene-extensions", "what an extension says of a whole model is left out of a scene", name);
    forEachObject(document, [&](gltf::Object& object) {
      eraseExtension(object, name.c_str());
      for (gltf::KeptJson* kept : {&object.extensions, &object.extras, &object.asRead}) {
        if (kept->exists()) eraseExtensionWithin(kept->change(), name);
      }
    });
    undeclareExtension(document, name);
  }
}

// Images of two parts may have one name.
void renameSideFiles(Asset& asset, const std::vector<Asset::SideFile>& taken, std::size_t part) {
  for (Asset::SideFile& file : asset.sideFiles) {
    const bool clashes =
        std::any_of(taken.begin(), taken.end(), [&](const Asset::SideFile& other) { return other.uri == file.uri; });
    if (!clashes) continue;
    const std::string renamed = fmt::format("{}/{}", part, file.uri);
    for (gltf::Image& image : asset.document.images) {
      if (image.uri == file.uri) image.uri = renamed;
    }
    file.uri = renamed;
  }
}

template <typename Element>
void appendAll(std::vector<Element>& to, std::vector<Element>& from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void appendNames(std::vector<std::string>& to, const std::vector<std::string>& from) {
  for (const std::string& name : from) {
    if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(name);
  }
}

std::vector<Index> rootsOf(const gltf::Document& document) {
  const SceneGraph graph = readSceneGraph(document);
  std::vector<Index> roots;
  std::copy_if(graph.order.begin(), graph.order.end(), std::back_inserter(roots),
               [&](Index node) { return !graph.parent[node]; });
  return roots;
}

void makeUnique(gltf::Element& element, UniqueNames& names) {
  if (!element.name.empty()) element.name = names.add(element.name);
}

class Merger {
 public:
  Merger() {
    merged_.document.about.generator = "limber";
    merged_.format = "glb";
  }

  void add(AssetPart& part) {
    Asset& asset = part.asset;
    gltf::Document &to = merged_.document, &from = asset.document;
    dropDocumentExtensions(from, merged_.warnings);
    renameSideFiles(asset, merged_.sideFiles, firstNode_.size());
    const std::vector<Index> roots = rootsOf(from);
    changeReferences(from, [&](ElementKind kind, Index& number) { number += elementCount(to, kind); });
    firstNode_.push_back(to.nodeCount());
    appendAll(to.nodes, from.nodes);
    appendAll(to.cameras, from.cameras);
    appendAll(to.meshes, from.meshes);
    appendAll(to.skins, from.skins);
    appendAll(to.animations, from.animations);
    appendAll(to.materials, from.materials);
    appendAll(to.textures, from.textures);
    appendAll(to.images, from.images);
    appendAll(to.samplers, from.samplers);
    appendAll(to.accessors, from.accessors);
    appendAll(to.bufferViews, from.bufferViews);
    appendAll(to.buffers, from.buffers);
    for (const ExtensionList& of : kExtensionLists) appendExtensionList(from, of);
    appendNames(to.extensionsUsed, from.extensionsUsed);
    appendNames(to.extensionsRequired, from.extensionsRequired);
    appendAll(merged_.buffers, asset.buffers);
    appendAll(merged_.sideFiles, asset.sideFiles);
    merged_.warnings.append(asset.warnings);
    hang(part, roots);
  }

  // Once all parts are there, those that others carry can be hung on them.
  Asset finish(const std::vector<AssetPart>& parts) {
    gltf::Document& document = merged_.document;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].carrier) {
        roots_.push_back(top_[p]);
        continue;
      }
      const Index carrier = firstNode_[parts[p].carrier->part] + parts[p].carrier->node;
      document.nodes[carrier].children.push_back(top_[p]);
    }
    document.scenes.resize(1);
    document.scenes[0].nodes = std::move(roots_);
    document.scene = 0;
    nameParts(document.nodes);
    UniqueNames animations;
    for (gltf::Animation& animation : document.animations) makeUnique(animation, animations);
    return std::move(merged_);
  }

 private:
  void appendExtensionList(const gltf::Document& from, const ExtensionList& of) {
    const Json* content = extensionOf(from, of.extension);
    const Json* list = content != nullptr ? member(*content, of.list) : nullptr;
    if (list == nullptr || list->empty()) return;
    Json& all = changeExtension(merged_.document, of.extension)[of.list];
    for (const Json& element : *list) all.push_back(element);
  }

  void hang(const AssetPart& part, const std::vector<Index>& roots) {
    std::vector<gltf::Node>& nodes = merged_.document.nodes;
    gltf::Node top;
    top.name = part.name;
    for (const Index root : roots) {
      const Index node = firstNode_.back() + root;
      (isPlacedByJoints(nodes[node]) ? roots_ : top.children).push_back(node);
    }
    setNodeTransform(top, part.transform, true);
    top_.push_back(addElement(nodes, std::move(top)));
  }

  // The nodes of the parts keep the names that were asked for, as far as they can.
  void nameParts(std::vector<gltf::Node>& nodes) const {
    UniqueNames names;
    for (const Index top : top_) makeUnique(nodes[top], names);
    for (Index n = 0; n < nodes.size(); ++n) {
      if (std::find(top_.begin(), top_.end(), n) == top_.end()) makeUnique(nodes[n], names);
    }
  }

  Asset merged_;
  std::vector<Index> firstNode_;  // of each part, in the merged document
  std::vector<Index> top_;        // the node of each part
  std::vector<Index> roots_;
};

}  // namespace

Asset mergeAssets(std::vector<AssetPart> parts) {
  Merger merger;
  for (AssetPart& part : parts) merger.add(part);
  return merger.finish(parts);
}

}  // namespace limber
