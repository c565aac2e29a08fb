// The triangles of an Asset's scene in world space, with a map back to each vertex.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber {

// One primitive of one mesh as one node shows it. An instanced mesh gives several.
struct PrimitiveInstance {
  Index node = 0, mesh = 0, primitive = 0;
  Index copy = 0;                          // which of the node's instances, with EXT_mesh_gpu_instancing
  Index firstVertex = 0, vertexCount = 0;  // range in Geometry::positions
  Affine toWorld = Affine::Identity();     // vertex as stored (after dequantising) -> world
  double quantisation = 0;                 // of its vertices in world space (StoredVertices)
};

struct Geometry {
  std::vector<Vec3f>
      positions;  // #S, world space (skinned parts: in their bind pose), in file order within an instance
  std::vector<Triangle> triangles;
  std::vector<PrimitiveInstance> instances;
};

// All meshes under the nodes of the default scene (of all root nodes where there is no scene), in the order of the
// scene's tree. Triangle strips and fans become triangles; points and lines give vertices only; a primitive without
// positions is passed over. Under a mirroring transform triangles are turned round, so that outside stays outside.
//
// A skinned node's vertices are placed by its skin's bind pose: the mesh's own space mapped so that the skin's joints
// stand where their inverse bind matrices say. A mesh without a skin below a joint moves there with the joint.
//
// Throws Error kLimit above 2^32-2 vertices, where instances of one mesh add more than 4 million vertices to those of
// the file, or above 262144 instances more than the file has nodes; kBadData where a vertex is not finite or nothing
// has a triangle; where() begins with the asset's name. Cost: O(#S + #F).
Geometry collectGeometry(const Asset& asset);

// How exactly the positions of its instances are known, for prepareMesh.
std::vector<StoredVertices> storedVertices(const Geometry& geometry);

// prepareMesh of the geometry: where its instances meet, vertices are welded as exactly as their numbers are known.
// triangles  geometry.triangles, or some of them
PreparedMesh prepareGeometry(const Geometry& geometry, std::span<const Triangle> triangles);

}  // namespace limber
