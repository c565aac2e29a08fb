// Which triangle is seen at each sample of a picture, tile by tile.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "limber/core/grouped.h"
#include "limber/preview/camera.h"

namespace limber {

inline constexpr int kTileSize = 32;        // pixels
inline constexpr int kSamplesPerPixel = 8;  // positions in a pixel, one in each of eight rows and columns

// Offsets of the samples inside their pixel, in 1/16 pixel.
inline constexpr std::array<std::array<int, 2>, kSamplesPerPixel> kSampleOffsets = {
    {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};

// Triangles projected by a camera and sorted into the tiles that they touch.
class ProjectedMesh {
 public:
  // The triangles behind the camera are left out. Keeps no reference to its arguments but `triangles`.
  ProjectedMesh(std::span<const Vec3f> positions, std::span<const Triangle> triangles, const Camera& camera);

  struct Vertex {
    std::int32_t x = 0, y = 0;  // 1/256 pixel
    float inverseDepth = 0;     // 0: behind the camera
  };
  std::span<const Vertex> vertices() const { return vertices_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  // Numbers of the triangles that may cover that tile, ascending.
  std::span<const Index> inTile(int column, int row) const;

  // Weights of a triangle's corners at a position (1/256 pixel), corrected for perspective.
  Vec3 barycentric(Index triangle, std::int32_t x, std::int32_t y) const;

 private:
  bool tilesOf(const Triangle& triangle, std::array<int, 4>& range) const;

  std::vector<Vertex> vertices_;
  std::span<const Triangle> triangles_;
  int columns_ = 0, rows_ = 0;
  Grouped<Index> inTile_;  // by row, then by column
};

// The samples of one tile: index ((y * kTileSize) + x) * kSamplesPerPixel + sample.
struct TileSamples {
  std::vector<float> inverseDepth;  // 0 where there is nothing
  std::vector<Index> triangle;      // kNoIndex where there is nothing

  TileSamples();
  void clear();
};

// Whether there is anything of a triangle at one of a pixel's samples, whose position is (x, y) in 1/256 pixel.
using SampleCover = std::function<bool(Index triangle, std::int32_t x, std::int32_t y, std::size_t sample)>;

// Draws the mesh's triangles of that tile. The nearest wins, the lower number where two are equally near.
// covers  asked for samples inside a triangle that nothing hides so far; empty: yes
void rasterizeTile(const ProjectedMesh& mesh, int column, int row, TileSamples& samples,
                   const SampleCover& covers = {});

}  // namespace limber
