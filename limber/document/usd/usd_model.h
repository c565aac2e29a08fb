// What USD can say of a model, taken out of a document.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limber/document/rig/rig_io.h"
#include "limber/document/usd/usd_surface.h"
#include "limber/document/usd/usd_write.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// A blend shape of one mesh: where its vertices go, those that move alone.
struct UsdShape {
  std::string name, label;           // unique in the model each: an identifier, and as the file has it
  std::vector<int> vertices;         // of the mesh
  std::vector<Vec3f> offsets;        // in the world, as many as vertices
  std::vector<Vec3f> normalOffsets;  // as many, or none
  Track<float> weight;               // over time in seconds; one key where it is constant
};

// A primitive as one node shows it, in the world of the bind pose: the vertices that have triangles.
struct UsdMesh {
  std::string name, label;                  // an identifier that is unique in the model, and as the file has it
  std::vector<Vec3f> points, normals;       // normals: as many, or none
  std::map<Index, std::vector<Vec2f>> uvs;  // by their sets, as many of each; v grows upwards
  std::vector<Vec3f> colors;                // as many, one for all, or none; times the material's
  std::vector<float> opacities;             // likewise
  std::vector<int> corners;                 // three for each triangle
  std::optional<Index> material;            // of the document
  int influences = 0;                       // for each vertex; 0: no joint moves the mesh
  std::vector<int> joints;                  // #points * influences
  std::vector<float> weights;               // likewise, summing to 1
  std::vector<UsdShape> shapes;
};

struct UsdModel {
  std::vector<UsdMesh> meshes;
  Skeleton skeleton;                // in bind pose; no joints: no rig
  std::vector<std::string> joints;  // #J paths of identifiers, "root/child"
  std::optional<Clip> clip;         // one that lasts
  Pose stance;                      // #J, how the joints stand without it: as the nodes do, or a clip of no length
  // Of text, so that rounding is at most 2.5 millionths of the model's size, and 1 where joints add theirs up.
  int pointDecimals = 6, moveDecimals = 6;
  Warnings warnings;
};

// `surfaces`: of the document's materials.
UsdModel readUsdModel(const Asset& asset, const std::vector<UsdSurface>& surfaces, const UsdOptions& options);
UsdModel readStillUsdModel(const Asset& asset, const std::vector<UsdSurface>& surfaces, const UsdStillSurface& still);

}  // namespace limber
