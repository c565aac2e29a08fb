#include "limber/asset/merge_assets.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/extensions.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/unique_names.h"

namespace limber {

namespace {

constexpr std::array<const char*, 13> kLists = {"buffers",    "bufferViews", "accessors", "images", "samplers",
                                                "textures",   "materials",   "meshes",    "skins",  "cameras",
                                                "animations", "nodes",       "scenes"};

// Lists that an extension keeps for the whole document, and that others refer to by number.
struct ExtensionList {
  const char *extension, *list;
};
constexpr ExtensionList kLights = {"KHR_lights_punctual", "lights"}, kVariants = {"KHR_materials_variants", "variants"};
constexpr std::array<ExtensionList, 2> kExtensionLists = {kLights, kVariants};

bool isPlacedByJoints(const Json& node) {
  return node.contains("skin") && !node.contains("children");
}

Json* find(Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

Json* extension(Json& owner, const char* name) {
  Json* all = find(owner, "extensions");
  return all ? find(*all, name) : nullptr;
}

// Where the lists of one part begin in the merged document; renumbers what refers to them.
class Offsets {
 public:
  explicit Offsets(Json& merged) {
    for (const char* list : kLists) start_[list] = merged.contains(list) ? merged[list].size() : 0;
    for (const ExtensionList& of : kExtensionLists) {
      const Json* extensionOfAll = extension(merged, of.extension);
      const Json* list = extensionOfAll ? member(*extensionOfAll, of.list) : nullptr;
      start_[of.list] = list ? list->size() : 0;
    }
  }

  Index node(Index number) const { return number + static_cast<Index>(start_.at("nodes")); }

  void renumber(Json& json) const {
    each(json, "bufferViews", [&](Json& view) {
      one(view, "buffer", "buffers");
      for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        if (Json* packed = extension(view, name)) one(*packed, "buffer", "buffers");
      }
    });
    each(json, "accessors", [&](Json& accessor) {
      one(accessor, "bufferView", "bufferViews");
      Json* sparse = find(accessor, "sparse");
      for (const char* part : {"indices", "values"}) {
        if (Json* of = sparse ? find(*sparse, part) : nullptr) one(*of, "bufferView", "bufferViews");
      }
    });
    each(json, "images", [&](Json& image) { one(image, "bufferView", "bufferViews"); });
    each(json, "textures", [&](Json& texture) {
      one(texture, "sampler", "samplers");
      one(texture, "source", "images");
      if (Json* others = find(texture, "extensions")) {
        for (Json& other : *others) one(other, "source", "images");
      }
    });
    each(json, "materials", [&](Json& material) { textures(material); });
    each(json, "meshes", [&](Json& mesh) { each(mesh, "primitives", [&](Json& part) { primitive(part); }); });
    each(json, "skins", [&](Json& skin) {
      one(skin, "inverseBindMatrices", "accessors");
      one(skin, "skeleton", "nodes");
      many(skin, "joints", "nodes");
    });
    each(json, "animations", [&](Json& animation) { animate(animation); });
    each(json, "nodes", [&](Json& node) { nodeOf(node); });
  }

 private:
  template <class Act>
  static void each(Json& owner, const char* list, const Act& act) {
    if (Json* elements = find(owner, list)) {
      for (Json& element : *elements) act(element);
    }
  }
  void shift(Json& number, const char* list) const {
    if (number.is_number_integer()) number = number.get<std::size_t>() + start_.at(list);
  }
  void one(Json& owner, const char* key, const char* list) const {
    if (Json* number = find(owner, key)) shift(*number, list);
  }
  void many(Json& owner, const char* key, const char* list) const {
    each(owner, key, [&](Json& number) { shift(number, list); });
  }

  // "baseColorTexture": {"index": 3}, wherever in a material it stands.
  void textures(Json& value) const {
    if (!value.is_structured()) return;
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
      constexpr std::string_view kEnd = "Texture";
      if (value.is_object() && entry->is_object() && entry.key().size() >= kEnd.size() &&
          std::string_view(entry.key()).substr(entry.key().size() - kEnd.size()) == kEnd) {
        one(*entry, "index", "textures");
      }
      textures(*entry);
    }
  }
  void primitive(Json& part) const {
    one(part, "indices", "accessors");
    one(part, "material", "materials");
    each(part, "attributes", [&](Json& accessor) { shift(accessor, "accessors"); });
    each(part, "targets", [&](Json& target) {
      for (Json& accessor : target) shift(accessor, "accessors");
    });
    if (Json* draco = extension(part, "KHR_draco_mesh_compression")) one(*draco, "bufferView", "bufferViews");
    if (Json* variants = extension(part, kVariants.extension)) {
      each(*variants, "mappings", [&](Json& mapping) {
        one(mapping, "material", "materials");
        many(mapping, "variants", "variants");
      });
    }
  }
  void animate(Json& animation) const {
    each(animation, "samplers", [&](Json& sampler) {
      one(sampler, "input", "accessors");
      one(sampler, "output", "accessors");
    });
    each(animation, "channels", [&](Json& channel) {
      Json* target = find(channel, "target");
      if (!target) return;
      one(*target, "node", "nodes");
      if (Json* by = extension(*target, "KHR_animation_pointer")) {
        if (Json* pointer = find(*by, "pointer")) movePointer(*pointer);
      }
    });
  }
  // "/materials/3/emissiveFactor", "/extensions/KHR_lights_punctual/lights/0/color"
  void movePointer(Json& pointer) const {
    if (!pointer.is_string()) return;
    const std::string path = pointer.get<std::string>();
    for (const auto& [list, start] : start_) {
      const std::string key = fmt::format("/{}/", list);
      const std::size_t at = path.find(key), number = at + key.size();
      const bool ofDocument = at == 0 || path.rfind("/extensions/", 0) == 0;
      if (at == std::string::npos || !ofDocument) continue;
      std::size_t end = number, value = 0;
      for (; end < path.size() && path[end] >= '0' && path[end] <= '9' && value < kNoIndex; ++end) {
        value = 10 * value + static_cast<std::size_t>(path[end] - '0');
      }
      if (end == number) continue;
      pointer = fmt::format("{}{}{}", path.substr(0, number), value + start, path.substr(end));
      return;
    }
  }
  void nodeOf(Json& node) const {
    one(node, "mesh", "meshes");
    one(node, "skin", "skins");
    one(node, "camera", "cameras");
    many(node, "children", "nodes");
    if (Json* light = extension(node, kLights.extension)) one(*light, "light", "lights");
    if (Json* lod = extension(node, "MSFT_lod")) many(*lod, "ids", "nodes");
    if (Json* constraint = extension(node, "VRMC_node_constraint")) {
      each(*constraint, "constraint", [&](Json& kind) { one(kind, "source", "nodes"); });
    }
    if (Json* copies = extension(node, "EXT_mesh_gpu_instancing")) {
      each(*copies, "attributes", [&](Json& accessor) { shift(accessor, "accessors"); });
    }
  }

  std::map<std::string, std::size_t, std::less<>> start_;
};

// Wherever it stands in there.
void eraseExtensionWithin(Json& value, const char* name) {
  if (!value.is_structured()) return;
  if (value.is_object()) eraseExtension(value, name);
  for (Json& inner : value) eraseExtensionWithin(inner, name);
}

// What no other part must be mixed up with, and cannot be taken over; and what refers to it.
void dropDocumentExtensions(Json& json, Warnings& warnings) {
  Json* all = find(json, "extensions");
  if (!all) return;
  const auto isList = [](const std::string& name) {
    return std::any_of(kExtensionLists.begin(), kExtensionLists.end(),
                       [&](const ExtensionList& of) { return name == of.extension; });
  };
  std::vector<std::string> dropped;
  for (const auto& [name, content] : all->items()) {
    if (!isList(name)) dropped.push_back(name);
  }
  for (const std::string& name : dropped) {
    warnings.add("scene-extensions", "what an extension says of a whole model is left out of a scene", name);
    eraseExtensionWithin(json, name.c_str());
    undeclareExtension(json, name.c_str());
  }
}

// Images of two parts may have one name.
void renameSideFiles(Asset& asset, const std::vector<Asset::SideFile>& taken, std::size_t part) {
  for (Asset::SideFile& file : asset.sideFiles) {
    const bool clashes =
        std::any_of(taken.begin(), taken.end(), [&](const Asset::SideFile& other) { return other.uri == file.uri; });
    if (!clashes) continue;
    const std::string renamed = fmt::format("{}/{}", part, file.uri);
    if (Json* images = find(asset.json(), "images")) {
      for (Json& image : *images) {
        if (Json* uri = find(image, "uri"); uri && *uri == file.uri) *uri = renamed;
      }
    }
    file.uri = renamed;
  }
}

void appendList(Json& to, Json& from, const char* key) {
  Json* list = find(from, key);
  if (!list || list->empty()) return;
  if (!to.contains(key)) to[key] = Json::array();
  for (Json& element : *list) to[key].push_back(std::move(element));
}

void appendNames(Json& to, const Json& from, const char* key) {
  const Json* list = member(from, key);
  if (!list) return;
  for (const Json& name : *list) {
    if (!to.contains(key)) to[key] = Json::array();
    if (std::find(to[key].begin(), to[key].end(), name) == to[key].end()) to[key].push_back(name);
  }
}

Json rootsOf(const Asset& asset) {
  const SceneGraph graph = readSceneGraph(asset);
  Json roots = Json::array();
  for (const Index node : graph.order) {
    if (!graph.parent[node]) roots.push_back(node);
  }
  return roots;
}

void makeUnique(Json& element, UniqueNames& names) {
  if (const std::string name = nameOf(element); !name.empty()) element["name"] = names.add(name);
}

class Merger {
 public:
  void add(AssetPart& part) {
    Asset& asset = part.asset;
    Json& json = asset.json();
    dropDocumentExtensions(json, merged_.warnings);
    renameSideFiles(asset, merged_.sideFiles, offsets_.size());
    offsets_.emplace_back(merged_.json());
    const Json roots = rootsOf(asset);
    offsets_.back().renumber(json);
    for (const char* list : kLists) {
      if (std::string_view(list) != "scenes") appendList(merged_.json(), json, list);
    }
    for (const ExtensionList& of : kExtensionLists) {
      if (Json* from = extension(json, of.extension)) {
        appendList(merged_.json()["extensions"][of.extension], *from, of.list);
      }
    }
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) appendNames(merged_.json(), json, list);
    std::move(asset.buffers.begin(), asset.buffers.end(), std::back_inserter(merged_.buffers));
    std::move(asset.sideFiles.begin(), asset.sideFiles.end(), std::back_inserter(merged_.sideFiles));
    merged_.warnings.append(asset.warnings);
    hang(part, roots);
  }

  // Once all parts are there, those that others carry can be hung on them.
  Asset finish(const std::vector<AssetPart>& parts) {
    Json& json = merged_.json();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].carrier) {
        roots_.push_back(top_[p]);
        continue;
      }
      Json& carrier = json["nodes"][offsets_[parts[p].carrier->part].node(parts[p].carrier->node)];
      if (!carrier.contains("children")) carrier["children"] = Json::array();
      carrier["children"].push_back(top_[p]);
    }
    json["scenes"] = Json::array({{{"nodes", std::move(roots_)}}});
    json["scene"] = 0;
    nameParts(json["nodes"]);
    UniqueNames animations;
    if (json.contains("animations")) {
      for (Json& animation : json["animations"]) makeUnique(animation, animations);
    }
    return std::move(merged_);
  }

 private:
  void hang(const AssetPart& part, const Json& roots) {
    Json& nodes = merged_.json()["nodes"];
    Json below = Json::array();
    for (const Json& root : roots) {
      const Index node = offsets_.back().node(root.get<Index>());
      (isPlacedByJoints(nodes[node]) ? roots_ : below).push_back(node);
    }
    Json node = {{"name", part.name}};
    if (!below.empty()) node["children"] = std::move(below);
    setNodeTransform(node, part.place, true);
    top_.push_back(static_cast<Index>(nodes.size()));
    nodes.push_back(std::move(node));
  }

  // The nodes of the parts keep the names that were asked for, as far as they can.
  void nameParts(Json& nodes) const {
    UniqueNames names;
    for (const Index top : top_) makeUnique(nodes[top], names);
    for (Index n = 0; n < nodes.size(); ++n) {
      if (std::find(top_.begin(), top_.end(), n) == top_.end()) makeUnique(nodes[n], names);
    }
  }

  Asset merged_ = emptyAsset();
  std::vector<Offsets> offsets_;  // of each part
  std::vector<Index> top_;        // the node of each part
  Json roots_ = Json::array();

  static Asset emptyAsset() {
    Asset asset;
    asset.json() = {{"asset", {{"version", "2.0"}, {"generator", "limber"}}}};
    asset.format = "glb";
    return asset;
  }
};

}  // namespace

Asset mergeAssets(std::vector<AssetPart> parts) {
  Merger merger;
  for (AssetPart& part : parts) merger.add(part);
  return merger.finish(parts);
}

}  // namespace limber
