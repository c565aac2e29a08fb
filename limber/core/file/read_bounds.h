// What a file may ask for when it is read: one table, which every reader asks. A few kilobytes must not cost gigabytes
// or minutes, whatever they name again and again, and no honest file is refused.
#pragma once

#include <algorithm>
#include <cstdint>

namespace limber {

// So much for any file, and so much more for each unit that the file stores.
struct ReadBound {
  std::uint64_t free = 0, perStored = 0;

  constexpr std::uint64_t of(std::uint64_t stored) const { return free + perStored * stored; }
  constexpr std::uint64_t larger(std::uint64_t stored) const { return std::max(free, perStored * stored); }
};

namespace read_bounds {

inline constexpr std::uint64_t kMega = 1 << 20;

// Memory, in bytes for each byte of the file.

// Attributes, indices and blend shapes as numbers of four bytes, each time that they are named. Files may store bytes,
// share accessors, and leave out zeros.
inline constexpr ReadBound kVertexData = {192 * kMega, 8};
// What Draco unpacks to.
inline constexpr ReadBound kDraco = {32 * kMega, 64};
// What meshopt unpacks to, the larger of the two. Smooth meshes of millions of vertices reach 8, an index of 12 bytes
// takes one at least; zeros would give 64.
inline constexpr ReadBound kMeshopt = {32 * kMega, 12};
// Files of an archive. NumPy's arrays and texts of models are packed some ten times.
inline constexpr ReadBound kArchive = {64 * kMega, 32};
// Arrays of an FBX file. Blender's densest files stay below 20; deflate itself would allow 1032.
inline constexpr ReadBound kFbxArrays = {16 * kMega, 32};
// Files beside a glTF, from the second time on that they are named.
inline constexpr ReadBound kRepeatedFiles = {64 * kMega, 0};
// Assimp's process, the larger of the two. A text of a megabyte takes it 6 to 12 megabytes.
inline constexpr ReadBound kAssimp = {224 * kMega, 14};
// And that much more for each byte of a picture beside the file, since the picture is copied while it is read.
inline constexpr std::uint64_t kAssimpPicture = 4;

// Elements of an accessor without data, which are zeros; the larger of the two, for each byte of the longest buffer.
inline constexpr ReadBound kZeros = {4096, 1};

// Numbers of four bytes that are made of an FBX file, for each byte.
inline constexpr ReadBound kFbxNumbers = {64 * kMega, 16};

// Objects in the lists of a glTF (nodes, meshes, ...), all together, for each 16 bytes of its JSON.
inline constexpr ReadBound kListed = {65536, 1};
inline constexpr std::uint64_t kBytesListed = 16;

// Meshes that Assimp makes of a file, and changes of an OBJ file's object, group or material, for each 512 bytes. Each
// takes some seven kilobytes until it is written; scenes of a box for each object have one in a kilobyte.
inline constexpr ReadBound kImportedMeshes = {16384, 1};
inline constexpr std::uint64_t kBytesImportedMesh = 512;

// What the scene shows more often than the file stores it.

inline constexpr ReadBound kShownVertices = {4'000'000, 1};  // for each vertex
inline constexpr ReadBound kShownInstances = {262'144, 1};   // for each node
inline constexpr ReadBound kRebound = {16'000'000, 0};       // vertices and shapes of meshes that several skins share
inline constexpr ReadBound kShapeWeights = {16'000'000, 0};  // of all nodes that show blend shapes
inline constexpr ReadBound kFbxShapeVertices = {64 * kMega, 0};  // vertices times blend shapes: 768 megabytes

// What clips say.

// As often as channels name them; the larger of the two, for each number.
inline constexpr ReadBound kClipNumbers = {4 * kMega, 16};
inline constexpr ReadBound kFbxClipNumbers = {4 * kMega, 16};  // of FBX; for each key of a curve
inline constexpr ReadBound kFbxAddedKeys = {kMega, 16};        // between the file's own; for each key of a curve
inline constexpr ReadBound kFbxMoved = {1 << 16, 4};           // models, as often as clips move them; for each object
inline constexpr ReadBound kShapeKeys = {128'000'000, 0};      // numbers of blend shapes in one clip
inline constexpr ReadBound kMovedTimes = {16'000'000, 0};      // of clips with keys before 0 s, which get copies
inline constexpr ReadBound kSamples = {2'000'000, 0};          // of joints below nodes that move
inline constexpr ReadBound kSampledNodes = {64 * kMega, 0};    // transforms of these nodes

}  // namespace read_bounds
}  // namespace limber
