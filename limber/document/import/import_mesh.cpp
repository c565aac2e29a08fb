// Assimp gives every face corner a vertex of its own for some formats. Its own step that joins them compares distances
// and took 4 to 10 times as long as joining them by their bits.
#include "limber/document/import/import_mesh.h"

#include <string>
#include <utility>

#include <assimp/mesh.h>
#include <fmt/format.h>

#include "limber/document/import/import_text.h"
#include "limber/document/mesh/plain_mesh.h"

namespace limber {

namespace {

// The faces of a mesh by their number of corners.
std::array<std::vector<Index>, 3> cornersOf(const aiMesh& mesh) {
  std::array<std::vector<Index>, 3> corners;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 1 || face.mNumIndices > 3) continue;  // triangulated before; empty ones mean nothing
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices) {
        throw Error(ErrorCode::kBadData,
                    fmt::format("face {} names vertex {} of {}", f, face.mIndices[i], mesh.mNumVertices));
      }
      corners[face.mNumIndices - 1].push_back(face.mIndices[i]);
    }
  }
  return corners;
}

VertexAttribute vectorsOf(const char* name, const aiVector3D* vectors, unsigned count, double scale) {
  VertexAttribute result{name, 3, {}};
  result.values.reserve(3 * std::size_t{count});
  for (unsigned v = 0; v < count; ++v) {
    for (const float x : {vectors[v].x, vectors[v].y, vectors[v].z}) {
      result.values.push_back(static_cast<float>(scale * x));
    }
  }
  return result;
}

std::vector<VertexAttribute> attributesOf(const aiMesh& mesh, double scale) {
  std::vector<VertexAttribute> attributes = {vectorsOf("POSITION", mesh.mVertices, mesh.mNumVertices, scale)};
  if (mesh.HasNormals()) attributes.push_back(vectorsOf("NORMAL", mesh.mNormals, mesh.mNumVertices, 1));
  for (unsigned set = 0; set < mesh.GetNumUVChannels(); ++set) {
    VertexAttribute uv{fmt::format("TEXCOORD_{}", set), 2, {}};
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      uv.values.push_back(mesh.mTextureCoords[set][v].x);
      uv.values.push_back(1 - mesh.mTextureCoords[set][v].y);  // glTF counts v downwards
    }
    attributes.push_back(std::move(uv));
  }
  for (unsigned set = 0; set < mesh.GetNumColorChannels(); ++set) {
    VertexAttribute color{fmt::format("COLOR_{}", set), 4, {}};
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D& c = mesh.mColors[set][v];
      color.values.insert(color.values.end(), {c.r, c.g, c.b, c.a});
    }
    attributes.push_back(std::move(color));
  }
  return attributes;
}

}  // namespace

std::vector<gltf::Primitive> importPrimitives(Asset& asset, const aiMesh& mesh, double scale,
                                              const SkinWeights& weights, Index skinJointCount) {
  if (mesh.mNumVertices == 0) return {};
  return addPlainMesh(asset, {textOf(mesh.mName), attributesOf(mesh, scale), cornersOf(mesh), weights, skinJointCount});
}

}  // namespace limber
