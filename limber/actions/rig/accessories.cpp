#include "limber/actions/rig/accessories.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "limber/character/anatomy/names/humanoid_words.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/bvh.h"

namespace limber {

namespace {

constexpr double kMaxSurfaceFraction = 0.5;
constexpr double kNearestPart = 0.1;  // of an accessory's vertices, which tell what it hangs on

// Not among them is what a head can be hidden in: helmets, hoods, masks, hair.
constexpr std::array<std::string_view, 47> kStiffWords = {
    "sword",    "axe",        "shield",  "staff",   "wand",       "gun",    "rifle", "pistol",   "bow",    "crossbow",
    "arrow",    "arrows",     "quiver",  "knife",   "dagger",     "spear",  "lance", "mug",      "cup",    "bottle",
    "book",     "spellbook",  "torch",   "lantern", "hammer",     "mace",   "club",  "scythe",   "shovel", "pickaxe",
    "weapon",   "weapons",    "prop",    "props",   "hat",        "cap",    "crown", "backpack", "bag",    "pouch",
    "umbrella", "sunglasses", "glasses", "goggles", "headphones", "basket", "guitar"};
constexpr std::array<std::string_view, 10> kHangingWords = {"cape",   "cloak",  "scarf",    "banner", "flag",
                                                            "ribbon", "tassel", "ponytail", "braid",  "pigtail"};

struct AccessoryName {
  std::string name, word;
  bool hangs = false;
};

template <std::size_t n>
bool has(const std::array<std::string_view, n>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<AccessoryName> readAccessoryName(const std::string& name) {
  AccessoryName result{name, {}, false};
  std::string rest;
  for (const std::string& word : detail::wordsOfName(name)) {
    if (has(kStiffWords, word) || has(kHangingWords, word)) {
      if (result.word.empty()) result.word = word;
    } else {
      rest.append(rest.empty() ? "" : "_").append(word);
    }
  }
  if (result.word.empty() || detail::readBodyName(rest).word != detail::BodyWord::kNone) return std::nullopt;
  result.hangs = has(kHangingWords, result.word);
  return result;
}

// The first name of the instance that names an accessory: its node's, mesh's or material's.
std::optional<AccessoryName> accessoryName(const Asset& asset, const PrimitiveInstance& instance) {
  const gltf::Document& document = asset.document;
  const gltf::Mesh& mesh = document.meshes[instance.mesh];
  std::vector<std::string> names = {document.nodes[instance.node].name, mesh.name};
  if (const std::optional<Index> material = mesh.primitives[instance.primitive].material) {
    names.push_back(document.materials[*material].name);
  }
  for (const std::string& name : names) {
    if (std::optional<AccessoryName> found = readAccessoryName(name)) return found;
  }
  return std::nullopt;
}

double areaOf(const Geometry& geometry, const Triangle& t) {
  const auto corner = [&](std::size_t k) { return Vec3(geometry.positions[t[k]].cast<double>()); };
  return triangleArea(corner(0), corner(1), corner(2));
}

// The vertices of prepared.mesh that belong to accessories alone, by accessory.
std::vector<std::vector<Index>> ownVertices(const Geometry& geometry, const PreparedMesh& prepared,
                                            const Accessories& accessories) {
  std::vector<Index> owner(prepared.mesh.vertexCount(), kNoIndex);
  std::vector<bool> ofBody(prepared.mesh.vertexCount(), false);
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
    for (const Index source : geometry.triangles[t]) {
      const Index v = prepared.weldedVertex[source];
      if (accessories.ofTriangle[t] == kNoIndex) {
        ofBody[v] = true;
      } else {
        owner[v] = accessories.ofTriangle[t];
      }
    }
  }
  std::vector<std::vector<Index>> vertices(accessories.names.size());
  for (Index v = 0; v < owner.size(); ++v) {
    if (owner[v] != kNoIndex && !ofBody[v]) vertices[owner[v]].push_back(v);
  }
  return vertices;
}

}  // namespace

Accessories findAccessories(const Asset& asset, const Geometry& geometry) {
  std::vector<Index> ofVertex(geometry.positions.size(), kNoIndex);
  std::map<std::tuple<Index, Index, std::string>, Index> known;  // by node, copy and name
  Accessories result;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const std::optional<AccessoryName> name = accessoryName(asset, instance);
    if (!name) continue;
    const auto [entry, isNew] =
        known.emplace(std::tuple(instance.node, instance.copy, name->name), static_cast<Index>(result.names.size()));
    if (isNew) {
      result.names.push_back(name->name);
      result.words.push_back(name->word);
      result.hangs.push_back(name->hangs);
    }
    std::fill_n(ofVertex.begin() + instance.firstVertex, instance.vertexCount, entry->second);
  }
  if (result.empty()) return result;
  double all = 0, ofAccessories = 0;
  for (const Triangle& t : geometry.triangles) {
    result.ofTriangle.push_back(ofVertex[t[0]]);
    const double area = areaOf(geometry, t);
    all += area;
    if (result.ofTriangle.back() != kNoIndex) ofAccessories += area;
  }
  return ofAccessories < kMaxSurfaceFraction * all ? result : Accessories();
}

std::vector<Triangle> bodyTriangles(const Geometry& geometry, const Accessories& accessories) {
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
    if (accessories.ofTriangle[t] == kNoIndex) triangles.push_back(geometry.triangles[t]);
  }
  return triangles;
}

std::vector<HungAccessory> hangAccessories(const Geometry& geometry, const PreparedMesh& prepared,
                                           const Accessories& accessories, SkinWeights& weights) {
  const TriMesh& mesh = prepared.mesh;
  const std::vector<std::vector<Index>> vertices = ownVertices(geometry, prepared, accessories);
  std::vector<bool> isOwn(mesh.vertexCount(), false);
  for (const std::vector<Index>& own : vertices) {
    for (const Index v : own) isOwn[v] = true;
  }
  std::vector<Index> body;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (std::none_of(triangle.begin(), triangle.end(), [&](Index v) { return isOwn[v]; })) body.push_back(t);
  }
  if (body.empty()) return {};
  const Bvh surface(mesh, body);
  std::vector<HungAccessory> result;
  for (const std::vector<Index>& own : vertices) {
    HungAccessory& hung = result.emplace_back();
    if (own.empty()) continue;
    hung.vertices = own;
    std::vector<SurfacePoint> nearest;
    std::vector<double> distances;
    for (const Index v : own) {
      nearest.push_back(surface.nearestPoint(mesh.position(v)));
      distances.push_back(nearest.back().distance);
    }
    const auto last = distances.begin() + static_cast<std::ptrdiff_t>(kNearestPart * static_cast<double>(own.size()));
    std::nth_element(distances.begin(), last, distances.end());
    const double reach = *last;
    std::map<Index, double> weightByJoint;  // by joint
    double count = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const SurfacePoint& point = nearest[i];
      if (point.distance > reach) continue;
      hung.position += mesh.position(own[i]);
      ++count;
      for (int corner = 0; corner < 3; ++corner) {
        const Index v = mesh.triangles[point.triangle][corner];
        for (Index slot = 0; slot < weights.slots; ++slot) {
          weightByJoint[weights.jointsOf(v)[slot]] += point.weights[corner] * weights.weightsOf(v)[slot];
        }
      }
    }
    hung.position /= count;
    hung.joint = std::max_element(weightByJoint.begin(), weightByJoint.end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
                 })->first;
    for (const Index v : own) bindTo(hung.joint, v, weights);
  }
  return result;
}

}  // namespace limber
