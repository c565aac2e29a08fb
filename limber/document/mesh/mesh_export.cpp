#include "limber/document/mesh/mesh_export.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "limber/core/text/names.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/images.h"
#include "limber/document/scene/texture_coordinates.h"
#include "limber/geometry/mesh/normals.h"

namespace limber {

namespace {

static_assert(std::endian::native == std::endian::little, "binary formats are written as they lie in memory");

// OBJ and MTL separate names by white space.
std::string oneWord(std::string name, std::string_view kind, Index element) {
  if (name.empty()) name = fmt::format("{}_{}", kind, element);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= 0x20 || c == '#' || c == '\\'; }, '_');
  return name;
}

const gltf::Primitive& primitiveOf(const Asset& asset, const PrimitiveInstance& instance) {
  return asset.document.meshes[instance.mesh].primitives[instance.primitive];
}

void copyUvs(const Asset& asset, const PrimitiveInstance& instance, std::vector<Vec2f>& uvs, std::size_t vertexCount) {
  const std::vector<Vec2f> own = readUvs(asset, instance);
  if (own.empty()) return;
  uvs.resize(vertexCount, Vec2f::Zero());
  for (Index v = 0; v < instance.vertexCount; ++v) uvs[instance.firstVertex + v] = {own[v].x(), 1 - own[v].y()};
}

// Vertices that share a position and, where the file has normals, the file's normal: these shade smoothly together.
class SmoothGroups {
 public:
  SmoothGroups(const Asset& asset, const Geometry& rest) : groupOf_(rest.positions.size()) {
    std::vector<std::array<float, 7>> keys(rest.positions.size());
    for (std::size_t i = 0; i < rest.instances.size(); ++i) {
      const PrimitiveInstance& instance = rest.instances[i];
      const std::optional<Index> accessor = primitiveOf(asset, instance).attributes.find("NORMAL");
      const std::vector<float> normals = accessor ? readFloats(asset, *accessor) : std::vector<float>();
      for (Index v = 0; v < instance.vertexCount; ++v) {
        std::array<float, 7>& key = keys[instance.firstVertex + v];
        const Vec3f& p = rest.positions[instance.firstVertex + v];
        key = {static_cast<float>(i), p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f, 0, 0, 0};
        if (accessor) std::copy_n(normals.begin() + 3 * std::size_t{v}, 3, key.begin() + 4);
      }
    }
    std::vector<Index> order(keys.size());
    for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<Index>(v);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return keys[a] < keys[b]; });
    for (std::size_t k = 0; k < order.size(); ++k) {
      const bool same = k > 0 && keys[order[k]] == keys[order[k - 1]];
      groupOf_[order[k]] = same ? groupOf_[order[k - 1]] : order[k];
    }
  }

  // Unit normals from the triangles, one for each vertex.
  std::vector<Vec3f> normals(const Geometry& geometry) const {
    const std::vector<Vec3> own = areaNormals<Vec3f>(geometry.positions, geometry.triangles);
    std::vector<Vec3> sums(groupOf_.size(), Vec3::Zero());
    for (std::size_t v = 0; v < own.size(); ++v) sums[groupOf_[v]] += own[v];
    std::vector<Vec3f> result(groupOf_.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
      const double length = sums[groupOf_[v]].norm();
      result[v] = length > 0 ? (sums[groupOf_[v]] / length).cast<float>() : Vec3f(Vec3f::Zero());
    }
    return result;
  }

 private:
  std::vector<Index> groupOf_;  // #S, the first vertex of the group
};

// The image of a material's base colour texture as a texture of the mesh, each image once.
std::optional<Index> exportTexture(const Asset& asset, const gltf::Material& material, std::map<Index, Index>& known,
                                   ExportMesh& mesh) {
  const std::optional<gltf::MetallicRoughness>& surface = material.pbrMetallicRoughness;
  if (!surface || !surface->baseColorTexture) return std::nullopt;
  const std::optional<Index> source = asset.document.textures[surface->baseColorTexture->index].source;
  if (!source) return std::nullopt;
  if (const auto found = known.find(*source); found != known.end()) return found->second;
  std::optional<Bytes> bytes = imageBytes(asset, *source);
  const std::string_view extension = bytes ? imageFormat(*bytes).extension : std::string_view();
  if (extension.empty()) return std::nullopt;
  const Index index = static_cast<Index>(mesh.textures.size());
  mesh.textures.push_back({fmt::format("texture_{}{}", index, extension), std::move(*bytes)});
  known.emplace(*source, index);
  return index;
}

void exportMaterials(const Asset& asset, ExportMesh& mesh) {
  std::map<Index, Index> known;
  Index count = 0;
  for (const gltf::Material& material : asset.document.materials) {
    ExportMaterial result;
    result.name = fmt::format("{}_{}", oneWord(material.name, "material", count), count);
    const auto& surface = material.pbrMetallicRoughness;
    if (surface && surface->baseColorFactor) result.color = surface->baseColorFactor->cast<float>();
    result.texture = exportTexture(asset, material, known, mesh);
    mesh.materials.push_back(std::move(result));
    ++count;
  }
}

// Triangles of an instance stand together and name vertices of its range only.
void exportParts(const Asset& asset, const Geometry& geometry, ExportMesh& mesh) {
  std::size_t next = 0;
  for (const PrimitiveInstance& instance : geometry.instances) {
    ExportPart part;
    const std::string& node = asset.document.nodes[instance.node].name;
    part.name = fmt::format("{}_{}", oneWord(node, "node", instance.node), instance.primitive);
    part.firstTriangle = next;
    const Index end = instance.firstVertex + instance.vertexCount;
    while (next < geometry.triangles.size() && geometry.triangles[next][0] >= instance.firstVertex &&
           geometry.triangles[next][0] < end) {
      ++next;
    }
    part.triangleCount = next - part.firstTriangle;
    part.material = primitiveOf(asset, instance).material;
    if (part.triangleCount > 0) mesh.parts.push_back(std::move(part));
  }
}

Bytes toBytes(const fmt::memory_buffer& text) {
  return Bytes(text.begin(), text.end());
}

template <typename T>
void put(Bytes& bytes, const T& value) {
  const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), raw, raw + sizeof(T));
}

void put(Bytes& bytes, const Vec3f& v) {
  for (int i = 0; i < 3; ++i) put(bytes, v[i]);
}

}  // namespace

ExportMesh exportMesh(const Asset& asset, const Geometry& geometry) {
  ExportMesh mesh;
  mesh.positions = geometry.positions;
  mesh.triangles = geometry.triangles;
  mesh.normals = SmoothGroups(asset, geometry).normals(geometry);
  for (const PrimitiveInstance& instance : geometry.instances) {
    copyUvs(asset, instance, mesh.uvs, geometry.positions.size());
  }
  exportMaterials(asset, mesh);
  exportParts(asset, geometry, mesh);
  return mesh;
}

bool isMeshFormat(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".obj" || extension == ".stl" || extension == ".ply";
}

void writeMesh(const ExportMesh& mesh, const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  if (extension == ".stl") return writeFile(path, encodeStl(mesh));
  if (extension == ".ply") return writeFile(path, encodePly(mesh));
  if (extension != ".obj") {
    throw Error(ErrorCode::kBadArgument, "is no mesh format that can be written", path.string(),
                "use .obj, .stl or .ply");
  }
  // Textures carry the mesh's own name, so that two models in one folder do not share files.
  const std::string stem = path.stem().string();
  ExportMesh named = mesh;
  for (ExportTexture& texture : named.textures) texture.file = stem + "_" + texture.file;
  std::filesystem::path materialPath = path;
  materialPath.replace_extension(".mtl");
  const bool materials = !named.materials.empty();

  const Bytes obj = encodeObj(named, materials ? materialPath.filename().string() : std::string());
  const Bytes mtl = encodeMtl(named);
  std::vector<OutputFile> files = {{path, obj}};
  if (materials) files.push_back({materialPath, mtl});
  for (const ExportTexture& texture : named.textures)
    files.push_back({path.parent_path() / texture.file, texture.bytes});
  writeFiles(files);
}

Bytes encodeObj(const ExportMesh& mesh, std::string_view materialFile) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (!materialFile.empty()) fmt::format_to(out, "mtllib {}\n", materialFile);
  for (const Vec3f& p : mesh.positions) fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  for (const Vec2f& uv : mesh.uvs) fmt::format_to(out, "vt {} {}\n", uv.x(), uv.y());
  for (const Vec3f& n : mesh.normals) fmt::format_to(out, "vn {} {} {}\n", n.x(), n.y(), n.z());
  for (const ExportPart& part : mesh.parts) {
    fmt::format_to(out, "g {}\n", part.name);
    if (part.material && !materialFile.empty()) fmt::format_to(out, "usemtl {}\n", mesh.materials[*part.material].name);
    for (std::size_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
      text.push_back('f');
      for (const Index v : mesh.triangles[t]) {
        const Index i = v + 1;
        if (mesh.uvs.empty()) {
          fmt::format_to(out, " {}//{}", i, i);
        } else {
          fmt::format_to(out, " {}/{}/{}", i, i, i);
        }
      }
      text.push_back('\n');
    }
  }
  return toBytes(text);
}

Bytes encodeMtl(const ExportMesh& mesh) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const ExportMaterial& material : mesh.materials) {
    const Vec4f& c = material.color;
    fmt::format_to(out, "newmtl {}\nKd {} {} {}\nd {}\n", material.name, c[0], c[1], c[2], c[3]);
    if (material.texture) fmt::format_to(out, "map_Kd {}\n", mesh.textures[*material.texture].file);
  }
  return toBytes(text);
}

Bytes encodeStl(const ExportMesh& mesh) {
  Bytes bytes(80, 0);
  bytes.reserve(84 + 50 * mesh.triangles.size());
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]].cast<double>();
    const Vec3 normal = (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a);
    const double length = normal.norm();
    put(bytes, length > 0 ? Vec3f((normal / length).cast<float>()) : Vec3f(Vec3f::Zero()));
    for (const Index v : t) put(bytes, mesh.positions[v]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

Bytes encodePly(const ExportMesh& mesh) {
  fmt::memory_buffer header;
  const auto out = std::back_inserter(header);
  fmt::format_to(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) fmt::format_to(out, "property float {}\n", name);
  if (!mesh.uvs.empty()) fmt::format_to(out, "property float s\nproperty float t\n");
  fmt::format_to(out, "element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
  Bytes bytes = toBytes(header);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    put(bytes, mesh.positions[v]);
    put(bytes, mesh.normals[v]);
    if (!mesh.uvs.empty()) {
      put(bytes, mesh.uvs[v].x());
      put(bytes, mesh.uvs[v].y());
    }
  }
  for (const Triangle& t : mesh.triangles) {
    put(bytes, std::uint8_t{3});
    for (const Index v : t) put(bytes, static_cast<std::int32_t>(v));
  }
  return bytes;
}

}  // namespace limber
