// Corners that are alike are joined by the bits of all attributes together, which takes a hash table.
#include "limber/document/mesh/plain_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/document/scene/joined_primitive.h"
#include "limber/geometry/mesh/normals.h"

namespace limber {

namespace {

constexpr Index kPoints = 0, kLines = 1;  // primitive modes

bool allFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

// Which vertex it is, only the reader knows: many have split the file's own at corners.
void checkPositions(const std::vector<float>& positions) {
  if (!allFinite(positions)) throw Error(ErrorCode::kBadData, "a vertex has a position that is not a finite number");
}

Vec3 at(const std::vector<float>& values, Index row) {
  return Eigen::Map<const Vec3f>(&values[3 * std::size_t{row}]).cast<double>();
}

// areaNormals of the mesh's triangles.
std::vector<Vec3> triangleNormals(const PlainMesh& mesh) {
  const std::vector<float>& positions = mesh.attributes[0].values;
  const std::vector<Index>& corners = mesh.corners[2];
  return areaNormals<Vec3f>({reinterpret_cast<const Vec3f*>(positions.data()), positions.size() / 3},
                            {reinterpret_cast<const Triangle*>(corners.data()), corners.size() / 3});
}

// Normals of unit length; those that have no direction are made from the triangles.
void makeUnitLong(Asset& asset, const PlainMesh& mesh, std::vector<float>& normals) {
  std::vector<Index> broken;
  for (Index v = 0; v < normals.size() / 3; ++v) {
    const Vec3 normal = at(normals, v);
    const double length = normal.norm();
    if (!(length > 1e-12) || !std::isfinite(length)) broken.push_back(v);
    const Vec3 unit = std::abs(length - 1) < 1e-6 ? normal : Vec3(normal / length);
    for (int i = 0; i < 3; ++i) normals[3 * std::size_t{v} + i] = static_cast<float>(unit[i]);
  }
  if (broken.empty()) return;
  asset.warnings.add("invalid-normals", "normals without a direction are made anew", mesh.name, broken.size());
  const std::vector<Vec3> made = triangleNormals(mesh);
  for (const Index v : broken) {
    const double length = made[v].norm();
    const Vec3f unit = length > 0 && std::isfinite(length) ? Vec3f((made[v] / length).cast<float>()) : Vec3f::UnitY();
    for (int i = 0; i < 3; ++i) normals[3 * std::size_t{v} + i] = unit[i];
  }
}

void makeSound(Asset& asset, PlainMesh& mesh) {
  checkPositions(mesh.attributes[0].values);
  for (VertexAttribute& attribute : mesh.attributes) {
    if (attribute.name == "NORMAL") makeUnitLong(asset, mesh, attribute.values);
  }
  std::vector<VertexAttribute> sound;
  for (VertexAttribute& attribute : mesh.attributes) {
    if (allFinite(attribute.values)) {
      sound.push_back(std::move(attribute));
    } else {
      asset.warnings.add("invalid-attributes", "vertex attributes that are not finite are left out",
                         mesh.name + " " + attribute.name);
    }
  }
  mesh.attributes = std::move(sound);
}

// Each vertex as one row: all of its attributes and influences.
VertexRows rowsOf(const std::vector<VertexAttribute>& attributes, const SkinWeights& weights, std::size_t count) {
  std::size_t width = 2 * std::size_t{weights.slots};
  for (const VertexAttribute& attribute : attributes) width += attribute.components;
  VertexRows rows(count, width);
  for (std::size_t v = 0; v < count; ++v) {
    for (const VertexAttribute& attribute : attributes) {
      for (std::size_t i = v * attribute.components; i < (v + 1) * attribute.components; ++i) {
        rows.add(attribute.values[i]);
      }
    }
    for (std::size_t i = v * weights.slots; i < (v + 1) * weights.slots; ++i) {
      rows.add(weights.joints[i]);
      rows.add(weights.weights[i]);
    }
  }
  return rows;
}

}  // namespace

std::vector<gltf::Primitive> addPlainMesh(Asset& asset, PlainMesh mesh) {
  const std::size_t count = mesh.attributes[0].values.size() / 3;
  if (count == 0) return {};
  makeSound(asset, mesh);
  const JoinedVertices joined = joinVertices(rowsOf(mesh.attributes, mesh.weights, count));

  gltf::Primitive primitive;
  primitive.attributes = addJoinedAttributes(asset, mesh.attributes, mesh.weights, mesh.skinJointCount, joined.kept);

  std::vector<gltf::Primitive> primitives;
  constexpr std::array<Index, 3> kModes = {kPoints, kLines, gltf::kTriangles};
  for (int kind = 2; kind >= 0; --kind) {
    if (mesh.corners[kind].empty()) continue;
    primitive.indices = addJoinedCorners(asset, std::move(mesh.corners[kind]), joined);
    primitive.mode = kModes[kind];
    primitives.push_back(primitive);
  }
  if (primitives.empty()) {
    primitive.mode = kPoints;
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

}  // namespace limber
