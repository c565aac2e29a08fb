// What is in a file: the figures that `limber info` prints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/character/anatomy/skeleton_size.h"
#include "limber/character/character.h"

namespace limber {

// Skin weights as the file stores them.
struct SkinWeightInfo {
  Index vertices = 0;             // with at least one influence
  Index withoutWeights = 0;       // of the scene's other vertices
  float least = 0, greatest = 0;  // of all weights that are not zero
  double largestSumError = 0;     // the largest |sum - 1| of a vertex with weights
  Index maxInfluences = 0;        // of one vertex
};

struct ClipInfo {
  std::string name;
  double seconds = 0;  // its last key's time
  Index channels = 0;
};

// The scene's mesh after welding vertices at equal positions.
struct SurfaceInfo {
  Index weldedVertices = 0, triangles = 0;  // without degenerate triangles
  Index pieces = 0;                         // that have a triangle
  Index openEdges = 0, crowdedEdges = 0;    // with one triangle; with more than two
  bool watertight() const { return openEdges == 0 && crowdedEdges == 0; }
};

struct AssetInfo {
  std::string format;
  std::size_t storedVertices = 0;      // over the POSITION accessors that primitives use
  Index sceneVertices = 0;             // as the scene shows them: an instanced mesh counts each time
  std::optional<SurfaceInfo> surface;  // none where the scene has no triangle
  Box bounds;                          // of the scene, metres
  Index nodes = 0, meshes = 0, primitives = 0, materials = 0, textures = 0, images = 0, skins = 0;
  std::vector<std::string> joints;
  std::vector<Vec3> jointPositions;       // #joints, of the rest pose in the scene's space, metres
  std::optional<SkeletonSize> bodySize;   // in rest pose, metres; none without a skeleton
  std::optional<Anatomy> anatomy;         // of its skeleton, in rest pose; none without one
  std::optional<SkinWeightInfo> weights;  // none without a skin
  std::vector<ClipInfo> clips;
  std::vector<std::string> extensions;  // used ones
  Warnings warnings;                    // of reading, and of a body's unlikely size
};

// The document must have passed checkAsset. Throws Error kLimit where the scene is too large to be collected.
// Cost: O(n log n) in its vertices and triangles.
AssetInfo inspectAsset(const Character& character);

}  // namespace limber
