#include "limber/actions/parts/part_meshes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "limber/actions/parts/cap_primitive.h"
#include "limber/actions/parts/gathered_vertices.h"
#include "limber/actions/parts/part_triangles.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/references.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber {

namespace {

// Nodes whose meshes become one for each part: one node, or all without morph targets that have the same skin.
struct SplitGroup {
  std::vector<Index> nodes;
  std::optional<Index> skin;
  std::size_t targets = 0;           // morph targets of each primitive
  std::vector<std::size_t> members;  // of Geometry::instances
};

struct NewNode {
  Index part = 0, node = 0;
};

using Primitives = std::vector<gltf::Primitive>;

class Splitter {
 public:
  Splitter(Asset& asset, const Geometry& geometry, const SurfaceParts& parts)
      : asset_(asset), geometry_(geometry), parts_(parts), triangles_(partTriangles(geometry, parts)) {
    for (const PrimitiveInstance& instance : geometry.instances) {
      if (instance.copy > 0) {
        throw Error(ErrorCode::kUnsupported, "shows a mesh by GPU instances, which cannot be taken apart", asset.name,
                    "turn instances into meshes first, or write the parts as materials");
      }
      primitives_.push_back(document_.meshes[instance.mesh].primitives[instance.primitive]);
    }
    for (const gltf::Node& node : document_.nodes) taken_.insert(node.name);
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
      const std::optional<Index> skin = document_.nodes[node].skin;
      const std::size_t targets = primitives_[i].targets.size();
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
    prepared_ = prepareGeometry(geometry_, geometry_.triangles);
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
    std::map<Index, Primitives> primitivesOf;  // by part
    std::vector<Primitives> left(group.nodes.size());
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
    for (std::size_t n = 0; n < group.nodes.size(); ++n) emptyNode(group, group.nodes[n], std::move(left[n]));
  }

  gltf::Primitive partPrimitive(std::size_t instance, const PartTriangles& run) {
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
    gltf::Primitive primitive = gatherVertices(asset_, primitives_[instance], vertices);
    primitive.mode = gltf::kTriangles;
    primitive.indices = addTriangleAccessor(asset_, triangles, static_cast<Index>(vertices.size()));
    return primitive;
  }

  // Those of the part's caps all of whose vertices this group has.
  void addCaps(const SplitGroup& group, Index part, Primitives& primitives) {
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
      gltf::Material material;
      material.name = "cut";
      material.pbrMetallicRoughness.emplace().metallicFactor = 0;
      cutMaterial_ = addElement(document_.materials, std::move(material));
    }
    return *cutMaterial_;
  }

  void addNode(const SplitGroup& group, Index part, Primitives primitives) {
    const std::string& name = parts_.names[part];
    gltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives = std::move(primitives);
    if (group.nodes.size() == 1) {
      const gltf::Mesh& original = document_.meshes[geometry_.instances[group.members[0]].mesh];
      mesh.weights = original.weights;
      mesh.extras = original.extras;
    }
    gltf::Node node;
    node.name = names_.add(taken_.count(name) > 0 ? name + "_part" : name);
    node.mesh = addElement(document_.meshes, std::move(mesh));
    node.skin = group.skin;
    node.weights = document_.nodes[group.nodes[0]].weights;
    const Index number = addElement(document_.nodes, std::move(node));
    newNodes_.push_back({part, number});
    if (group.skin) {
      showInScenes(group.nodes, number);
    } else {
      document_.nodes[group.nodes[0]].children.push_back(number);
    }
    if (group.targets > 0) copyMorphChannels(group.nodes[0], number);
  }

  void findScenes() {
    for (Index s = 0; s < document_.scenes.size(); ++s) {
      for (const Index node : sceneNodes(document_, s)) scenesOf_[node].push_back(s);
    }
  }

  void showInScenes(const std::vector<Index>& beside, Index number) {
    std::set<Index> scenes;
    for (const Index node : beside) {
      const auto known = scenesOf_.find(node);
      if (known != scenesOf_.end()) scenes.insert(known->second.begin(), known->second.end());
    }
    for (const Index s : scenes) document_.scenes[s].nodes.push_back(number);
  }

  void findMorphChannels() {
    for (std::size_t a = 0; a < document_.animations.size(); ++a) {
      for (const gltf::AnimationChannel& channel : document_.animations[a].channels) {
        const gltf::AnimationChannel::Target& target = channel.target;
        if (target.node && target.path == "weights") morphChannels_[*target.node].emplace_back(a, channel);
      }
    }
  }

  void copyMorphChannels(Index from, Index to) {
    const auto known = morphChannels_.find(from);
    if (known == morphChannels_.end()) return;
    for (const auto& [animation, channel] : known->second) {
      document_.animations[animation].channels.emplace_back(channel).target.node = to;
    }
  }

  // Takes the mesh off; what is no triangles stays on a mesh of its own.
  void emptyNode(const SplitGroup& group, Index number, Primitives left) {
    gltf::Node& node = document_.nodes[number];
    if (!left.empty()) {
      gltf::Mesh mesh;
      mesh.primitives = std::move(left);
      node.mesh = addElement(document_.meshes, std::move(mesh));
      return;
    }
    node.mesh.reset();
    node.skin.reset();
    node.weights.clear();
    if (group.targets > 0) emptied_.insert(number);
  }

  // Nodes that carried a skinned mesh and nothing else.
  void dropEmptyNodes() {
    std::vector<bool> keep(document_.nodes.size(), true);
    for (const SplitGroup& group : groups_) {
      if (!group.skin) continue;
      for (const Index number : group.nodes) {
        const gltf::Node& node = document_.nodes[number];
        keep[number] =
            node.mesh || !node.children.empty() || node.camera || node.extensions.exists() || node.extras.exists();
      }
    }
    for (const gltf::Skin& skin : document_.skins) {
      for (const Index joint : skin.joints) keep[joint] = true;
      if (skin.skeleton) keep[*skin.skeleton] = true;
    }
    deleteNodes(asset_, keep);
    std::vector<Index> numberOf(keep.size(), 0);
    for (std::size_t n = 1; n < keep.size(); ++n) numberOf[n] = numberOf[n - 1] + (keep[n - 1] ? 1 : 0);
    for (NewNode& made : newNodes_) made.node = numberOf[made.node];
  }

  // Meshes that a node showed before and none shows now.
  void dropUnusedMeshes() {
    std::set<Index> shown;
    for (const gltf::Node& node : document_.nodes) {
      if (node.mesh) shown.insert(*node.mesh);
    }
    std::set<Index> taken;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      if (shown.count(instance.mesh) == 0) taken.insert(instance.mesh);
    }
    std::vector<gltf::Mesh> kept;
    std::vector<Index> numberOf;
    for (Index m = 0; m < document_.meshes.size(); ++m) {
      numberOf.push_back(static_cast<Index>(kept.size()));
      if (taken.count(m) == 0) kept.push_back(std::move(document_.meshes[m]));
    }
    document_.meshes = std::move(kept);
    changeReferences(document_, [&](ElementKind kind, Index& number) {
      if (kind == ElementKind::kMesh && number < numberOf.size()) number = numberOf[number];
    });
  }

  Asset& asset_;
  gltf::Document& document_ = asset_.document;
  const Geometry& geometry_;
  const SurfaceParts& parts_;
  std::vector<std::vector<PartTriangles>> triangles_;
  Primitives primitives_;  // #instances, as they were
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
  std::map<Index, std::vector<Index>> scenesOf_;  // node -> scenes that show it
  // node -> animations and their channels
  std::map<Index, std::vector<std::pair<std::size_t, gltf::AnimationChannel>>> morphChannels_;
  std::set<Index> emptied_;  // nodes whose morph targets went on
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
