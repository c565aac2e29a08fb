#include "limber/parts/part_meshes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "limber/asset/accessor_sweep.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/unique_names.h"
#include "limber/mesh/prepare.h"
#include "limber/parts/cap_primitive.h"
#include "limber/parts/gathered_vertices.h"
#include "limber/parts/part_triangles.h"

namespace limber {

namespace {

// Nodes whose meshes become one for each part: one node, or all without morph targets that share a skin.
struct SplitGroup {
  std::vector<Index> nodes;
  std::optional<Index> skin;
  std::size_t targets = 0;           // morph targets of each primitive
  std::vector<std::size_t> members;  // of Geometry::instances
};

struct NewNode {
  Index part = 0, node = 0;
};

std::size_t targetCount(const Json& primitive) {
  const Json* targets = member(primitive, "targets");
  return targets ? targets->size() : 0;
}

class Splitter {
 public:
  Splitter(Asset& asset, const Geometry& geometry, const SurfaceParts& parts)
      : asset_(asset), geometry_(geometry), parts_(parts), triangles_(partTriangles(geometry, parts)) {
    for (const PrimitiveInstance& instance : geometry.instances) {
      if (instance.copy > 0) {
        throw Error(ErrorCode::kUnsupported, "shows a mesh by GPU instances, which cannot be taken apart", asset.name,
                    "turn instances into meshes first, or write the parts as materials");
      }
      primitives_.push_back(asset.json()["meshes"][instance.mesh]["primitives"][instance.primitive]);
    }
    for (const Json& node : elements(asset, "nodes")) taken_.insert(nameOf(node));
    makeGroups();
    findScenes();
    findMorphChannels();
  }

  std::vector<PartNodes> run(bool caps, Progress& progress) {
    progress.step("caps");
    if (caps) findCaps(progress);
    progress.step("meshes");
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      progress.update(static_cast<double>(g) / static_cast<double>(groups_.size()));
      splitGroup(groups_[g]);
    }
    if (!emptied_.empty()) {
      const auto isEmptied = [&](Index node, std::string_view path) {
        return path == "weights" && emptied_.count(node) > 0;
      };
      removeChannels(asset_, isEmptied);
    }
    if (missedCaps_ > 0) {
      asset_.warnings.add("open-cuts", "edges of cuts could not be closed", {}, missedCaps_);
    }
    dropEmptyNodes();
    dropUnusedMeshes();
    std::vector<PartNodes> result;
    for (const std::string& name : parts_.names) result.push_back({name, {}});
    for (const NewNode& made : newNodes_) result[made.part].nodes.push_back(made.node);
    return result;
  }

 private:
  void makeGroups() {
    std::map<Index, std::size_t> ofNode, ofSkin;
    for (std::size_t i = 0; i < geometry_.instances.size(); ++i) {
      const Index node = geometry_.instances[i].node;
      const std::optional<Index> skin = indexMember(asset_.json()["nodes"][node], "skin");
      const std::size_t targets = targetCount(primitives_[i]);
      auto known = ofNode.find(node);
      if (known == ofNode.end()) {
        std::size_t group = groups_.size();
        if (skin && targets == 0) group = ofSkin.try_emplace(*skin, group).first->second;
        if (group == groups_.size()) groups_.push_back({{}, skin, targets, {}});
        groups_[group].nodes.push_back(node);
        known = ofNode.emplace(node, group).first;
      }
      groups_[known->second].members.push_back(i);
    }
  }

  void findCaps(Progress& progress) {
    prepared_ = prepareMesh(geometry_.positions, geometry_.triangles);
    std::vector<Index> partOf;
    for (std::size_t t = 0; t < geometry_.triangles.size(); ++t) {
      const Triangle& v = geometry_.triangles[t];
      const std::vector<Index>& at = prepared_.weldedVertex;
      if (at[v[0]] != at[v[1]] && at[v[1]] != at[v[2]] && at[v[2]] != at[v[0]]) partOf.push_back(parts_.partOf[t]);
    }
    PartCaps caps = capParts(prepared_.mesh, partOf, parts_.partCount(), progress);
    caps_ = std::move(caps.capsOf);
    missedCaps_ = caps.openEdges;
    for (const std::vector<PartCap>& list : caps_) {
      for (const PartCap& cap : list) missedCaps_ += cap.loop.size();  // less those that are placed
    }
    vertexAt_.resize(prepared_.mesh.vertexCount());
    stampAt_.assign(prepared_.mesh.vertexCount(), 0);
  }

  void splitGroup(const SplitGroup& group) {
    std::map<Index, Json> primitivesOf;  // part -> primitives
    std::vector<Json> left(group.nodes.size(), Json::array());
    for (const std::size_t i : group.members) {
      for (const PartTriangles& run : triangles_[i]) primitivesOf[run.part].push_back(partPrimitive(i, run));
      if (!triangles_[i].empty()) continue;
      const auto node = std::find(group.nodes.begin(), group.nodes.end(), geometry_.instances[i].node);
      left[static_cast<std::size_t>(node - group.nodes.begin())].push_back(primitives_[i]);
    }
    if (primitivesOf.empty()) return;
    if (!caps_.empty()) {
      for (auto& [part, primitives] : primitivesOf) addCaps(group, part, primitives);
    }
    for (auto& [part, primitives] : primitivesOf) addNode(group, part, std::move(primitives));
    for (std::size_t n = 0; n < group.nodes.size(); ++n) emptyNode(group, group.nodes[n], left[n]);
  }

  Json partPrimitive(std::size_t instance, const PartTriangles& run) {
    std::vector<Index> vertices, number(geometry_.instances[instance].vertexCount, kNoIndex);
    for (const Triangle& t : run.triangles) {
      for (const Index v : t) number[v] = 0;
    }
    for (Index v = 0; v < number.size(); ++v) {
      if (number[v] == kNoIndex) continue;
      number[v] = static_cast<Index>(vertices.size());
      vertices.push_back(v);
    }
    std::vector<Triangle> triangles = run.triangles;
    for (Triangle& t : triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
    Json primitive = gatherVertices(asset_, primitives_[instance], vertices);
    primitive.erase("mode");
    primitive["indices"] = addTriangleAccessor(asset_, triangles, static_cast<Index>(vertices.size()));
    return primitive;
  }

  // Those of the part's caps all of whose vertices this group has.
  void addCaps(const SplitGroup& group, Index part, Json& primitives) {
    ++stamp_;
    for (const std::size_t i : group.members) {
      for (const PartTriangles& run : triangles_[i]) {
        if (run.part != part) continue;
        for (const Triangle& t : run.triangles) {
          for (const Index v : t) {
            const Index welded = prepared_.weldedVertex[geometry_.instances[i].firstVertex + v];
            if (stampAt_[welded] == stamp_) continue;
            stampAt_[welded] = stamp_;
            vertexAt_[welded] = {static_cast<Index>(i), v};
          }
        }
      }
    }
    CapPrimitive capped(asset_, geometry_, primitives_);
    for (PartCap& cap : caps_[part]) {
      const auto isHere = [&](Index v) { return stampAt_[v] == stamp_; };
      if (cap.triangles.empty() || !std::all_of(cap.loop.begin(), cap.loop.end(), isHere)) continue;
      std::vector<ModelVertex> loop;
      for (const Index v : cap.loop) loop.push_back(vertexAt_[v]);
      capped.add(cap, loop);
      missedCaps_ -= cap.loop.size();
      cap.triangles.clear();
    }
    if (capped.empty()) return;
    primitives.push_back(capped.write(asset_, cutMaterial(), group.skin.has_value(), group.targets));
  }

  Index cutMaterial() {
    if (!cutMaterial_) {
      Json& materials = asset_.json()["materials"];
      if (!materials.is_array()) materials = Json::array();
      cutMaterial_ = static_cast<Index>(materials.size());
      materials.push_back({{"name", "cut"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}});
    }
    return *cutMaterial_;
  }

  void addNode(const SplitGroup& group, Index part, Json primitives) {
    Json& json = asset_.json();
    const std::string& name = parts_.names[part];
    const Json& original = json["meshes"][geometry_.instances[group.members[0]].mesh];
    Json mesh = {{"name", name}, {"primitives", std::move(primitives)}};
    if (group.nodes.size() == 1) {
      for (const char* key : {"weights", "extras"}) {
        if (const Json* value = member(original, key)) mesh[key] = *value;
      }
    }
    Json node = {{"name", names_.add(taken_.count(name) > 0 ? name + "_part" : name)}, {"mesh", json["meshes"].size()}};
    if (const Json* weights = member(json["nodes"][group.nodes[0]], "weights")) node["weights"] = *weights;
    if (group.skin) node["skin"] = *group.skin;
    json["meshes"].push_back(std::move(mesh));
    const auto number = static_cast<Index>(json["nodes"].size());
    json["nodes"].push_back(std::move(node));
    newNodes_.push_back({part, number});
    if (group.skin) {
      showInScenes(group.nodes, number);
    } else {
      Json& children = json["nodes"][group.nodes[0]]["children"];
      if (!children.is_array()) children = Json::array();
      children.push_back(number);
    }
    if (group.targets > 0) copyMorphChannels(group.nodes[0], number);
  }

  void findScenes() {
    for (Index s = 0; s < elementCount(asset_, "scenes"); ++s) {
      for (const Index node : sceneNodes(asset_, s)) scenesOf_[node].push_back(s);
    }
  }

  void showInScenes(const std::vector<Index>& beside, Index number) {
    std::set<Index> scenes;
    for (const Index node : beside) {
      const auto known = scenesOf_.find(node);
      if (known != scenesOf_.end()) scenes.insert(known->second.begin(), known->second.end());
    }
    for (const Index s : scenes) asset_.json()["scenes"][s]["nodes"].push_back(number);
  }

  void findMorphChannels() {
    const Json& animations = elements(asset_, "animations");
    for (std::size_t a = 0; a < animations.size(); ++a) {
      for (const Json& channel : animations[a]["channels"]) {
        const Json& target = channel.at("target");
        const std::optional<Index> node = indexMember(target, "node");
        if (node && target.value("path", "") == "weights") morphChannels_[*node].emplace_back(a, channel);
      }
    }
  }

  void copyMorphChannels(Index from, Index to) {
    const auto known = morphChannels_.find(from);
    if (known == morphChannels_.end()) return;
    for (const auto& [animation, channel] : known->second) {
      Json& channels = asset_.json()["animations"][animation]["channels"];
      channels.push_back(channel);
      channels.back()["target"]["node"] = to;
    }
  }

  // Takes the mesh off; what is no triangles stays on a mesh of its own.
  void emptyNode(const SplitGroup& group, Index number, const Json& left) {
    Json& json = asset_.json();
    if (!left.empty()) {
      json["nodes"][number]["mesh"] = json["meshes"].size();
      json["meshes"].push_back({{"primitives", left}});
      return;
    }
    for (const char* key : {"mesh", "skin", "weights"}) json["nodes"][number].erase(key);
    if (group.targets > 0) emptied_.insert(number);
  }

  // Nodes that carried a skinned mesh and nothing else.
  void dropEmptyNodes() {
    std::vector<bool> keep(elementCount(asset_, "nodes"), true);
    for (const SplitGroup& group : groups_) {
      if (!group.skin) continue;
      for (const Index node : group.nodes) {
        const Json& json = asset_.json()["nodes"][node];
        const auto has = [&](const char* key) { return json.contains(key); };
        keep[node] = has("mesh") || has("children") || has("camera") || has("extensions") || has("extras");
      }
    }
    for (const Json& skin : elements(asset_, "skins")) {
      for (const Json& joint : skin.at("joints")) keep[joint.get<std::size_t>()] = true;
      if (const std::optional<Index> root = indexMember(skin, "skeleton")) keep[*root] = true;
    }
    deleteNodes(asset_, keep);
    std::vector<Index> numberOf(keep.size(), 0);
    for (std::size_t n = 1; n < keep.size(); ++n) numberOf[n] = numberOf[n - 1] + (keep[n - 1] ? 1 : 0);
    for (NewNode& made : newNodes_) made.node = numberOf[made.node];
  }

  // Meshes that a node showed before and none shows now.
  void dropUnusedMeshes() {
    Json& json = asset_.json();
    std::set<Index> shown;
    for (const Json& node : json["nodes"]) {
      if (const std::optional<Index> mesh = indexMember(node, "mesh")) shown.insert(*mesh);
    }
    std::set<Index> taken;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      if (shown.count(instance.mesh) == 0) taken.insert(instance.mesh);
    }
    Json kept = Json::array();
    std::vector<Index> numberOf;
    for (Index m = 0; m < json["meshes"].size(); ++m) {
      numberOf.push_back(static_cast<Index>(kept.size()));
      if (taken.count(m) == 0) kept.push_back(std::move(json["meshes"][m]));
    }
    json["meshes"] = std::move(kept);
    for (Json& node : json["nodes"]) {
      if (const std::optional<Index> mesh = indexMember(node, "mesh")) node["mesh"] = numberOf[*mesh];
    }
  }

  Asset& asset_;
  const Geometry& geometry_;
  const SurfaceParts& parts_;
  std::vector<std::vector<PartTriangles>> triangles_;
  std::vector<Json> primitives_;  // #instances, as they were
  std::vector<SplitGroup> groups_;
  std::set<std::string> taken_;  // names of nodes that were there, such as joints
  UniqueNames names_;
  PreparedMesh prepared_;
  std::vector<std::vector<PartCap>> caps_;  // #P; those that are placed have no triangles any more
  std::size_t missedCaps_ = 0;              // edges
  std::vector<ModelVertex> vertexAt_;       // #V welded, valid where stampAt_ is stamp_
  std::vector<Index> stampAt_;
  Index stamp_ = 0;
  std::optional<Index> cutMaterial_;
  std::vector<NewNode> newNodes_;
  std::map<Index, std::vector<Index>> scenesOf_;                              // node -> scenes that show it
  std::map<Index, std::vector<std::pair<std::size_t, Json>>> morphChannels_;  // node -> animations and their channels
  std::set<Index> emptied_;                                                   // nodes whose morph targets went on
};

}  // namespace

std::vector<PartNodes> splitParts(Asset& asset, const Geometry& geometry, const SurfaceParts& parts,
                                  const SplitOptions& options, Progress& progress) {
  const AccessorSweep sweep(asset);
  std::vector<PartNodes> nodes = Splitter(asset, geometry, parts).run(options.caps, progress);
  sweep.sweep(asset);
  return nodes;
}

}  // namespace limber
