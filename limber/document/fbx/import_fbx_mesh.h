// An FBX geometry as glTF primitives.
#pragma once

#include <string>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/fbx/import_fbx_budget.h"
#include "limber/document/fbx/import_fbx_objects.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// One target of a blend shape: what it adds to control points, in the geometry's own space.
struct FbxShapeTarget {
  std::string name;
  std::vector<Index> points;  // control points, ascending
  std::vector<Vec3> moves;    // #points
  std::vector<Vec3> normals;  // #points; empty: none
};

struct FbxMeshPlan {
  Affine placement = Affine::Identity();  // from control points to what the document gets
  SkinWeights weights;                    // #control points; no slots for a rigid mesh
  Index jointCount = 0;
  std::vector<FbxShapeTarget> shapes;
};

struct FbxPrimitive {
  gltf::Primitive primitive;
  Index material = 0;  // index into the model's materials
};

struct FbxMesh {
  std::vector<FbxPrimitive> primitives;  // none where the geometry has no triangles
  std::vector<std::string> textureSets;  // what the file calls TEXCOORD_0, TEXCOORD_1, ...
};

// How many control points a geometry has.
Index fbxControlPointCount(const FbxNode& geometry);

// One primitive for each material that polygons have, with normals, up to eight sets of texture coordinates and as many
// of colours, which are sRGB in the file and linear in the document. Polygons are triangulated (triangulatePolygon).
// Corners of one control point that are alike are one vertex; vertices keep the order of their control points. Throws
// Error kBadData for a position that is not finite or a polygon that names a point out of range, kLimit beyond the
// budget. Repairs are counted in the asset's warnings.
FbxMesh importFbxMesh(Asset& asset, const FbxNode& geometry, const std::string& name, const FbxMeshPlan& plan,
                      FbxBudget& budget);

}  // namespace limber
