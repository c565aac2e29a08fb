#include "model_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber::testing {

namespace {

constexpr double kNear = 1e-4;  // of the longest side of the model's box

Box boxOf(const std::vector<Vec3f>& positions) {
  Box box;
  for (const Vec3f& position : positions) box.add(position.cast<double>());
  return box;
}

// Points in cells of a little more than the tolerance, so that a neighbour within it is in one of 27 cells.
class PointGrid {
 public:
  PointGrid(const std::vector<Vec3>& points, double tolerance) : points_(points), tolerance_(tolerance) {
    for (Index i = 0; i < points.size(); ++i) cells_[cellOf(points[i])].push_back(i);
  }

  // The nearest point within the tolerance.
  std::optional<Index> find(const Vec3& point) const {
    const auto [x, y, z] = cellOf(point);
    std::optional<Index> nearest;
    double best = tolerance_;
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        for (long dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find({x + dx, y + dy, z + dz});
          if (cell == cells_.end()) continue;
          for (const Index i : cell->second) {
            const double distance = (points_[i] - point).norm();
            if (distance > best) continue;
            best = distance;
            nearest = i;
          }
        }
    return nearest;
  }

 private:
  using Cell = std::tuple<long, long, long>;
  Cell cellOf(const Vec3& p) const {
    const double size = 1.01 * tolerance_;
    return {std::lround(p.x() / size), std::lround(p.y() / size), std::lround(p.z() / size)};
  }

  const std::vector<Vec3>& points_;
  double tolerance_;
  std::map<Cell, std::vector<Index>> cells_;
};

Vec3 mirrored(const Vec3& point) {
  return {-point.x(), point.y(), point.z()};
}

// Has each welded vertex and each triangle its mirror image?
bool isMirrorSymmetric(const TriMesh& mesh) {
  std::vector<Vec3> points;
  for (Index v = 0; v < mesh.vertexCount(); ++v) points.push_back(mesh.position(v));
  const PointGrid grid(points, kNear);
  std::vector<Index> image(points.size());
  for (Index v = 0; v < points.size(); ++v) {
    const auto found = grid.find(mirrored(points[v]));
    if (!found) return false;
    image[v] = *found;
  }
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::set<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) triangles.insert(sorted(t));
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return triangles.count(sorted({image[t[0]], image[t[1]], image[t[2]]})) > 0;
  });
}

bool isSkinAttribute(const std::string& name) {
  return name.rfind("JOINTS_", 0) == 0 || name.rfind("WEIGHTS_", 0) == 0;
}

Json without(Json object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) object.erase(key);
  return object;
}

Json withoutSkinAttributes(Json mesh) {
  for (Json& primitive : mesh["primitives"]) {
    Json kept = Json::object();
    for (const auto& [name, accessor] : primitive["attributes"].items())
      if (!isSkinAttribute(name)) kept[name] = accessor;
    primitive["attributes"] = kept;
  }
  return mesh;
}

// Where a mesh goes to another node, so does what drives its morph targets.
Json withoutMorphTargetsNodes(Json animation) {
  for (Json& channel : animation["channels"])
    if (channel["target"]["path"] == "weights") channel["target"].erase("node");
  return animation;
}

const Json& arrayOf(const Json& document, const char* key) {
  static const Json kEmpty = Json::array();
  const auto found = document.find(key);
  return found == document.end() ? kEmpty : *found;
}

void expectSameAccessor(const Asset& before, const Json& indexBefore, const Asset& after, const Json& indexAfter,
                        const std::string& where) {
  EXPECT_TRUE(readFloats(before, indexBefore.get<Index>()) == readFloats(after, indexAfter.get<Index>()))
      << where << " has other values";
}

void expectSamePrimitive(const Asset& before, const Json& a, const Asset& after, const Json& b,
                         const std::string& where) {
  for (const auto& [name, accessor] : a.at("attributes").items()) {
    if (isSkinAttribute(name)) continue;
    ASSERT_TRUE(b.at("attributes").contains(name)) << where << " lost " << name;
    expectSameAccessor(before, accessor, after, b.at("attributes").at(name), where + " " + name);
  }
  ASSERT_EQ(a.contains("indices"), b.contains("indices")) << where;
  if (a.contains("indices")) expectSameAccessor(before, a["indices"], after, b["indices"], where + " indices");
  const auto rest = [](const Json& primitive) {
    return without(primitive, {"attributes", "indices", "targets", "extensions"});
  };
  EXPECT_TRUE(rest(a) == rest(b)) << where << " has changed";
  ASSERT_EQ(arrayOf(a, "targets").size(), arrayOf(b, "targets").size()) << where;
  for (std::size_t t = 0; t < arrayOf(a, "targets").size(); ++t)
    for (const auto& [name, accessor] : a["targets"][t].items())
      expectSameAccessor(before, accessor, after, b["targets"][t].at(name), where + " target " + name);
}

// A GLB's JSON and its binary chunk, taken apart without the library's own reader.
struct GlbParts {
  Json json;
  ByteSpan binary;
};

std::uint32_t wordAt(ByteSpan bytes, std::size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

GlbParts splitGlb(ByteSpan bytes) {
  GlbParts parts;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::uint32_t length = wordAt(bytes, at), kind = wordAt(bytes, at + 4);
    const ByteSpan chunk = bytes.subspan(at + 8, length);
    if (kind == 0x4E4F534A) parts.json = Json::parse(chunk.begin(), chunk.end());
    if (kind == 0x004E4942) parts.binary = chunk;
    at += 8 + length;
  }
  return parts;
}

// Each element of the first array, but the `replaced` ones, is, after `reduce`, the element of the second at the same
// index.
template <typename Reduce>
void expectPrefix(const Json& before, const Json& after, const char* key, const Reduce& reduce,
                  const std::set<std::size_t>& replaced = {}) {
  ASSERT_LE(arrayOf(before, key).size(), arrayOf(after, key).size()) << key;
  for (std::size_t i = 0; i < arrayOf(before, key).size(); ++i) {
    const bool same = replaced.count(i) > 0 || reduce(before[key][i]) == reduce(after[key][i]);
    EXPECT_TRUE(same) << key << "[" << i << "] has changed";
  }
}

// The accessors of joints and weights, which new weights replace.
std::set<std::size_t> skinAccessors(const Json& document) {
  std::set<std::size_t> result;
  for (const Json& mesh : arrayOf(document, "meshes"))
    for (const Json& primitive : mesh["primitives"])
      for (const auto& [name, accessor] : primitive["attributes"].items())
        if (isSkinAttribute(name)) result.insert(accessor.get<std::size_t>());
  return result;
}

}  // namespace

Rigged rigged(const Asset& asset, const AutoRigOptions& options) {
  Asset copy = asset.clone();
  Progress progress;
  Rigged result;
  result.report = autoRig(copy, options, progress);
  result.glb = writeGlb(copy);
  return result;
}

void expectJointCount(const AssetSkeleton& rig, Index handles) {
  const Index found = rig.skeleton.jointCount();
  if (found == handles) return;
  ASSERT_EQ(found, handles + 1);
  const auto roots = std::count_if(rig.skeleton.joints.begin(), rig.skeleton.joints.end(),
                                   [](const Joint& joint) { return !joint.parent; });
  EXPECT_EQ(roots, 1) << "the one joint more than asked for must be a common root";
}

bool expectSymmetricWhereMeshIs(const Geometry& geometry, const Skeleton& skeleton) {
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  if (!isMirrorSymmetric(prepared.mesh)) return false;
  std::vector<Vec3> positions;
  for (const Affine& global : restGlobals(skeleton))
    positions.push_back(prepared.frame.toWorking(global.translation()));
  const PointGrid grid(positions, 10 * kNear);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const auto partner = grid.find(mirrored(positions[j]));
    EXPECT_TRUE(partner) << skeleton.joints[j].name << " has no mirror image";
    if (!partner) continue;
    const double tolerance = 10 * kNear * prepared.frame.scale;
    EXPECT_NEAR(skeleton.joints[j].radius, skeleton.joints[*partner].radius, tolerance) << skeleton.joints[j].name;
  }
  return true;
}

void expectSoundWeights(const SkinWeights& weights, Index vertexCount, Index jointCount, Index maxInfluences) {
  ASSERT_EQ(weights.vertexCount(), vertexCount);
  for (Index v = 0; v < vertexCount; ++v) {
    double sum = 0;
    std::set<Index> joints;
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const float weight = weights.weightsOf(v)[slot];
      ASSERT_TRUE(weight >= 0 && weight <= 1) << "vertex " << v << " has the weight " << weight;
      if (weight == 0) continue;
      sum += weight;
      ASSERT_LT(weights.jointsOf(v)[slot], jointCount) << "vertex " << v;
      ASSERT_TRUE(joints.insert(weights.jointsOf(v)[slot]).second) << "vertex " << v << " names a joint twice";
    }
    ASSERT_NEAR(sum, 1, 1e-5) << "vertex " << v;
    ASSERT_LE(joints.size(), maxInfluences) << "vertex " << v;
  }
}

void expectSameShape(const Geometry& before, const Geometry& after) {
  ASSERT_EQ(before.positions.size(), after.positions.size());
  ASSERT_EQ(before.triangles.size(), after.triangles.size());
  const Box a = boxOf(before.positions), b = boxOf(after.positions);
  const double tolerance = kNear * a.longestSide();
  EXPECT_LE((a.min - b.min).norm(), tolerance);
  EXPECT_LE((a.max - b.max).norm(), tolerance);
  Vec3 difference = Vec3::Zero();
  for (std::size_t i = 0; i < before.positions.size(); ++i)
    difference += before.positions[i].cast<double>() - after.positions[i].cast<double>();
  EXPECT_LE(difference.norm() / before.positions.size(), tolerance);
}

void expectSameContent(const Asset& before, const Asset& after) {
  const Json a = documentJson(before), b = documentJson(after);
  for (const char* key : {"materials", "textures", "samplers", "cameras", "extras"})
    EXPECT_TRUE(arrayOf(a, key) == arrayOf(b, key)) << key << " has changed";
  EXPECT_EQ(arrayOf(a, "images").size(), arrayOf(b, "images").size());
  ASSERT_LE(arrayOf(a, "meshes").size(), arrayOf(b, "meshes").size());
  for (std::size_t m = 0; m < arrayOf(a, "meshes").size(); ++m) {
    const Json &primitivesBefore = a["meshes"][m]["primitives"], &primitivesAfter = b["meshes"][m]["primitives"];
    ASSERT_EQ(primitivesBefore.size(), primitivesAfter.size());
    for (std::size_t p = 0; p < primitivesBefore.size(); ++p)
      expectSamePrimitive(before, primitivesBefore[p], after, primitivesAfter[p],
                          "mesh " + std::to_string(m) + " primitive " + std::to_string(p));
  }
}

void expectOnlyAdditions(ByteSpan before, ByteSpan after, const AutoRigReport& report) {
  const GlbParts a = splitGlb(before), b = splitGlb(after);
  const auto whole = [](const Json& element) { return element; };
  for (const auto& [key, value] : a.json.items()) {
    static const std::set<std::string> kComparedBelow = {
        "accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes", "skins", "animations", "extensionsUsed"};
    EXPECT_TRUE(kComparedBelow.count(key) > 0 || value == arrayOf(b.json, key.c_str())) << key << " has changed";
  }
  expectPrefix(a.json, b.json, "accessors", whole, skinAccessors(a.json));
  expectPrefix(a.json, b.json, "bufferViews", whole);
  const auto& warnings = report.warnings.items();
  const bool wrongRoot = std::any_of(warnings.begin(), warnings.end(),
                                     [](const Warning& warning) { return warning.kind == "skeleton-root"; });
  expectPrefix(a.json, b.json, "skins",
               [&](const Json& skin) { return wrongRoot ? without(skin, {"skeleton"}) : skin; });
  expectPrefix(a.json, b.json, "meshes", withoutSkinAttributes);
  expectPrefix(a.json, b.json, "nodes", [](const Json& node) { return without(node, {"mesh", "skin", "children"}); });
  expectPrefix(a.json, b.json, "scenes", [](const Json& scene) { return without(scene, {"nodes"}); });
  expectPrefix(a.json, b.json, "animations", withoutMorphTargetsNodes);
  expectPrefix(a.json, b.json, "buffers", [](const Json& buffer) { return without(buffer, {"byteLength"}); });
  if (arrayOf(a.json, "buffers").empty()) return;
  const std::size_t length = a.json["buffers"][0]["byteLength"].get<std::size_t>();
  ASSERT_LE(length, b.binary.size());
  EXPECT_TRUE(std::equal(a.binary.begin(), a.binary.begin() + length, b.binary.begin()))
      << "the bytes of the input's buffer have changed";
}

}  // namespace limber::testing
