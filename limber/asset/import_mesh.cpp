// Assimp gives every face corner a vertex of its own for some formats. Joining them here, by the bits of all
// attributes together, takes a hash table; Assimp's own step compares distances and took 4 to 10 times as long.
#include "limber/asset/import_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

#include <assimp/mesh.h>
#include <fmt/format.h>

#include "limber/asset/accessor.h"
#include "limber/asset/import_text.h"
#include "limber/asset/weight_attributes.h"
#include "limber/core/bits.h"

namespace limber {

namespace {

constexpr Index kPoints = 0, kLines = 1;  // primitive modes

// A vertex attribute: #V rows of `components` floats.
struct Attribute {
  std::string name;
  Index components = 0;
  std::vector<float> values;
};

// The faces of a mesh by their number of corners, as flat lists of vertices.
struct Faces {
  std::array<std::vector<Index>, 3> corners;  // of points, lines, triangles
};

Faces facesOf(const aiMesh& mesh) {
  Faces faces;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 1 || face.mNumIndices > 3) continue;  // triangulated before; empty ones mean nothing
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices) {
        throw Error(ErrorCode::kBadData,
                    fmt::format("face {} names vertex {} of {}", f, face.mIndices[i], mesh.mNumVertices));
      }
      faces.corners[face.mNumIndices - 1].push_back(face.mIndices[i]);
    }
  }
  return faces;
}

bool allFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

Attribute positionsOf(const aiMesh& mesh, double scale) {
  Attribute result{"POSITION", 3, {}};
  result.values.reserve(3 * std::size_t{mesh.mNumVertices});
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    for (const float x : {p.x, p.y, p.z}) result.values.push_back(static_cast<float>(scale * x));
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error(ErrorCode::kBadData, fmt::format("vertex {} has a position that is not a finite number", v));
    }
  }
  return result;
}

Vec3 at(const std::vector<float>& values, Index row) {
  return Eigen::Map<const Vec3f>(&values[3 * std::size_t{row}]).cast<double>();
}

// The normals of the triangles round each vertex, weighted by area; not of unit length.
std::vector<Vec3> triangleNormals(const std::vector<float>& positions, const std::vector<Index>& corners) {
  std::vector<Vec3> normals(positions.size() / 3, Vec3::Zero());
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3 a = at(positions, corners[i]), b = at(positions, corners[i + 1]), c = at(positions, corners[i + 2]);
    for (std::size_t k = i; k < i + 3; ++k) normals[corners[k]] += (b - a).cross(c - a);
  }
  return normals;
}

// Normals as the file has them, of unit length; those that have no direction are made from the triangles.
Attribute normalsOf(Asset& asset, const aiMesh& mesh, const std::vector<float>& positions, const Faces& faces) {
  Attribute result{"NORMAL", 3, {}};
  std::vector<Index> broken;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& n = mesh.mNormals[v];
    const Vec3 normal(n.x, n.y, n.z);
    const double length = normal.norm();
    if (!(length > 1e-12) || !std::isfinite(length)) broken.push_back(v);
    const Vec3 unit = std::abs(length - 1) < 1e-6 ? normal : Vec3(normal / length);
    for (int i = 0; i < 3; ++i) result.values.push_back(static_cast<float>(unit[i]));
  }
  if (broken.empty()) return result;
  asset.warnings.add("invalid-normals", "normals without a direction are made anew", textOf(mesh.mName), broken.size());
  const std::vector<Vec3> made = triangleNormals(positions, faces.corners[2]);
  for (const Index v : broken) {
    const double length = made[v].norm();
    const Vec3f unit = length > 0 && std::isfinite(length) ? Vec3f((made[v] / length).cast<float>()) : Vec3f::UnitY();
    for (int i = 0; i < 3; ++i) result.values[3 * std::size_t{v} + i] = unit[i];
  }
  return result;
}

std::vector<Attribute> attributesOf(Asset& asset, const aiMesh& mesh, double scale, const Faces& faces) {
  std::vector<Attribute> attributes = {positionsOf(mesh, scale)};
  if (mesh.HasNormals()) attributes.push_back(normalsOf(asset, mesh, attributes[0].values, faces));
  for (unsigned set = 0; set < mesh.GetNumUVChannels(); ++set) {
    Attribute uv{fmt::format("TEXCOORD_{}", set), 2, {}};
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      uv.values.push_back(mesh.mTextureCoords[set][v].x);
      uv.values.push_back(1 - mesh.mTextureCoords[set][v].y);  // glTF counts v downwards
    }
    attributes.push_back(std::move(uv));
  }
  for (unsigned set = 0; set < mesh.GetNumColorChannels(); ++set) {
    Attribute color{fmt::format("COLOR_{}", set), 4, {}};
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D& c = mesh.mColors[set][v];
      color.values.insert(color.values.end(), {c.r, c.g, c.b, c.a});
    }
    attributes.push_back(std::move(color));
  }
  std::vector<Attribute> sound;
  for (Attribute& attribute : attributes) {
    if (allFinite(attribute.values)) {
      sound.push_back(std::move(attribute));
    } else if (attribute.name == "POSITION") {
      throw Error(ErrorCode::kBadData, "a position is beyond what single precision can hold");
    } else {
      asset.warnings.add("invalid-attributes", "vertex attributes that are not finite are left out",
                         textOf(mesh.mName) + " " + attribute.name);
    }
  }
  return sound;
}

// Each vertex as one row of 32-bit words: all of its attributes and influences.
class VertexRows {
 public:
  VertexRows(const std::vector<Attribute>& attributes, const SkinWeights& weights, std::size_t count) {
    for (const Attribute& attribute : attributes) width_ += attribute.components;
    width_ += 2 * weights.slots;
    words_.reserve(count * width_);
    for (std::size_t v = 0; v < count; ++v) {
      for (const Attribute& attribute : attributes) {
        for (std::size_t i = v * attribute.components; i < (v + 1) * attribute.components; ++i) {
          words_.push_back(bitCast<std::uint32_t>(attribute.values[i] + 0.0f));  // -0 is 0
        }
      }
      for (std::size_t i = v * weights.slots; i < (v + 1) * weights.slots; ++i) {
        words_.push_back(weights.joints[i]);
        words_.push_back(bitCast<std::uint32_t>(weights.weights[i]));
      }
    }
  }

  bool equal(std::size_t a, std::size_t b) const {
    return std::memcmp(&words_[a * width_], &words_[b * width_], width_ * sizeof(std::uint32_t)) == 0;
  }
  std::uint64_t hash(std::size_t v) const {
    std::uint64_t h = 0;
    for (std::size_t i = v * width_; i < (v + 1) * width_; ++i) {
      h = (h ^ words_[i]) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return h;
  }

 private:
  std::size_t width_ = 0;
  std::vector<std::uint32_t> words_;
};

struct Joined {
  std::vector<Index> kept;    // the vertices that stay, ascending
  std::vector<Index> vertex;  // #V, place in `kept`
};

Joined joinVertices(const VertexRows& rows, std::size_t count) {
  Joined result;
  result.vertex.resize(count);
  std::vector<Index> slots(std::bit_ceil(2 * count + 2), kNoIndex);  // open addressing, places in `kept`
  const std::size_t mask = slots.size() - 1;
  for (std::size_t v = 0; v < count; ++v) {
    std::size_t slot = rows.hash(v) & mask;
    while (slots[slot] != kNoIndex && !rows.equal(result.kept[slots[slot]], v)) slot = (slot + 1) & mask;
    if (slots[slot] == kNoIndex) {
      slots[slot] = static_cast<Index>(result.kept.size());
      result.kept.push_back(static_cast<Index>(v));
    }
    result.vertex[v] = slots[slot];
  }
  return result;
}

template <typename T>
std::vector<T> pickRows(const std::vector<T>& values, std::size_t width, const std::vector<Index>& rows) {
  std::vector<T> result;
  result.reserve(rows.size() * width);
  for (const std::size_t row : rows) {
    result.insert(result.end(), values.begin() + row * width, values.begin() + (row + 1) * width);
  }
  return result;
}

template <typename T>
Index addIndices(Asset& asset, const std::vector<Index>& indices, ComponentType type) {
  const std::vector<T> narrow(indices.begin(), indices.end());
  const AccessorInfo info{static_cast<Index>(indices.size()), 1, type, false};
  return addAccessor(asset, info, {reinterpret_cast<const std::uint8_t*>(narrow.data()), narrow.size() * sizeof(T)},
                     kIndexTarget);
}

Index addCorners(Asset& asset, std::vector<Index> corners, const Joined& joined) {
  for (Index& corner : corners) corner = joined.vertex[corner];
  return joined.kept.size() < 0xffff ? addIndices<std::uint16_t>(asset, corners, ComponentType::kU16)
                                     : addIndices<std::uint32_t>(asset, corners, ComponentType::kU32);
}

// JOINTS_n and WEIGHTS_n of the joined vertices.
gltf::Attributes weightAttributes(Asset& asset, const SkinWeights& weights, const Joined& joined,
                                  Index skinJointCount) {
  SkinWeights kept;
  kept.slots = weights.slots;
  kept.joints = pickRows(weights.joints, weights.slots, joined.kept);
  kept.weights = pickRows(weights.weights, weights.slots, joined.kept);
  PrimitiveInstance range;
  range.vertexCount = kept.vertexCount();
  std::vector<Index> identity(skinJointCount);
  std::iota(identity.begin(), identity.end(), 0);
  return addWeightAccessors(asset, range, kept, identity, skinJointCount);
}

}  // namespace

std::vector<gltf::Primitive> importPrimitives(Asset& asset, const aiMesh& mesh, double scale,
                                              const SkinWeights& weights, Index skinJointCount) {
  if (mesh.mNumVertices == 0) return {};
  const Faces faces = facesOf(mesh);
  const std::vector<Attribute> attributes = attributesOf(asset, mesh, scale, faces);
  const Joined joined = joinVertices(VertexRows(attributes, weights, mesh.mNumVertices), mesh.mNumVertices);

  gltf::Primitive primitive;
  for (const Attribute& attribute : attributes) {
    const std::vector<float> values = pickRows(attribute.values, attribute.components, joined.kept);
    primitive.attributes.set(attribute.name, addFloatAccessor(asset, values, attribute.components, kVertexTarget,
                                                              attribute.name == "POSITION"));
  }
  if (weights.slots > 0) {
    for (const auto& [name, accessor] : weightAttributes(asset, weights, joined, skinJointCount)) {
      primitive.attributes.set(name, accessor);
    }
  }

  std::vector<gltf::Primitive> primitives;
  constexpr std::array<Index, 3> kModes = {kPoints, kLines, gltf::kTriangles};
  for (int kind = 2; kind >= 0; --kind) {
    if (faces.corners[kind].empty()) continue;
    primitive.indices = addCorners(asset, faces.corners[kind], joined);
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
