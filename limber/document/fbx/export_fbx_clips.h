// A document's clips as FBX' animation stacks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/fbx/export_fbx_geometry.h"
#include "limber/document/fbx/export_fbx_objects.h"
#include "limber/document/fbx/export_fbx_scene.h"
#include "limber/document/fbx/export_fbx_space.h"

namespace limber {

struct FbxStack {
  std::string name;
  double duration = 0;  // seconds
  double rate = 0;      // frames a second that show its keys and what lies between them, 20 at least
};

// What moves: the scene's models, and the geometries of those that show a mesh (null for others).
struct FbxMovable {
  const FbxScenePlan& scene;
  const std::vector<FbxId>& models;
  const std::vector<const FbxGeometry*>& geometries;
};

// Writes a stack for each of the clips, with curves at its own keys, and between where a straight line is not what the
// clip says: closer than 0.005 degree for rotations, a ten-thousandth of what the curve spans for all others. Steps are
// flagged as such, and have a key a ten-thousandth of a second before the next for readers that do not look. Keys
// before 0 are kept.
std::vector<FbxStack> writeFbxClips(const Asset& asset, const std::vector<Index>& clips, const FbxMovable& movable,
                                    const FbxSpace& space, FbxObjectWriter& objects, Warnings& warnings);

}  // namespace limber
