// Meshes without a rig to OBJ, STL and PLY: for 3D printing, and for programs that read nothing newer.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// A run of triangles with one material: a primitive as one node shows it.
struct ExportPart {
  std::string name;
  std::size_t firstTriangle = 0, triangleCount = 0;
  std::optional<Index> material;  // into ExportMesh::materials
};

struct ExportMaterial {
  std::string name;              // unique, without white space
  Vec4f color = Vec4f::Ones();   // base colour with alpha
  std::optional<Index> texture;  // into ExportMesh::textures
};

// An image file to lie beside the mesh.
struct ExportTexture {
  std::string file;
  Bytes bytes;
};

// positions  #S points in world space, Y up, metres
// normals    #S unit vectors (zero where no triangle meets)
// uvs        #S with v growing upwards as in OBJ (glTF's grow downwards); (0, 0) where a part has none; empty if none
// has
struct ExportMesh {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<Triangle> triangles;
  std::vector<ExportPart> parts;
  std::vector<ExportMaterial> materials;
  std::vector<ExportTexture> textures;
};

// The geometry of an asset with its materials, base colour textures and texture coordinates. `geometry` is
// collectGeometry(asset), or the same with moved positions. Normals are made from the triangles, weighted by area; they
// are smooth at a position where the file's own normals agree. Cost: O(#S + #F).
ExportMesh exportMesh(const Asset& asset, const Geometry& geometry);

// Does writeMesh know that extension (".obj", ".stl", ".ply", in any case)?
bool isMeshFormat(const std::filesystem::path& path);

// OBJ (with an .mtl and the textures beside), binary STL or binary PLY by the extension of `path`. All files or none.
// Throws Error kBadArgument for another extension or for OBJ to standard output, kFile.
void writeMesh(const ExportMesh& mesh, const std::filesystem::path& path);

// The bytes of the files. `materialFile` is the name of the .mtl, empty for none. Numbers are written so that they read
// back equal. STL keeps positions and triangles only, PLY normals and texture coordinates too.
Bytes encodeObj(const ExportMesh& mesh, std::string_view materialFile);
Bytes encodeMtl(const ExportMesh& mesh);
Bytes encodeStl(const ExportMesh& mesh);
Bytes encodePly(const ExportMesh& mesh);

}  // namespace limber
