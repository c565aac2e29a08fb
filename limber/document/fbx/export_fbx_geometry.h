// A document's meshes as FBX geometries, with their blend shapes and skins.
#pragma once

#include <vector>

#include "limber/document/asset.h"
#include "limber/document/fbx/export_fbx_objects.h"
#include "limber/document/fbx/export_fbx_scene.h"
#include "limber/document/fbx/export_fbx_space.h"

namespace limber {

struct FbxGeometry {
  FbxId id = 0;
  // The document's material of each of the geometry's material numbers; none: the default. Empty: it names no
  // materials.
  std::vector<std::optional<Index>> materials;
  std::vector<FbxId> shapeChannels;  // one for each blend shape
  std::vector<Index> vertexStart;    // of each primitive of the mesh, in the geometry's vertices; kNoIndex: left out
  Index vertexCount = 0;
};

// Writes the geometry of a mesh: all its primitives in one, vertices in their order (primitives that share them still
// do), normals, UV sets (v upwards), colours (sRGB), a material number for each triangle, and blend shapes with the
// weights that the node has. Throws Error kBadData where a vertex is not finite.
FbxGeometry writeFbxGeometry(const Asset& asset, Index mesh, Index node, const FbxSpace& space,
                             FbxObjectWriter& objects);

// Writes the skin of a model: a cluster for each joint, with the bind-pose transforms of the joint and the mesh.
// `models` are the objects of the scene's models.
void writeFbxSkin(const Asset& asset, const FbxScenePlan& scene, const FbxModelPlan& model, const FbxGeometry& geometry,
                  const std::vector<FbxId>& models, const FbxSpace& space, FbxObjectWriter& objects);

}  // namespace limber
