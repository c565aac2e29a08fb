// How much a deformation stretches and squeezes a surface, and the texture on it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// The singular values of the affine map of one triangle onto another: by how much lengths grow along the direction in
// which they grow the most, and along the one at right angles to it. most >= least >= 0; 1 where nothing is stretched.
struct TriangleStretch {
  double most = 1, least = 1;

  // The isometric distortion (Sorkine et al. 2002, Bounded-distortion piecewise mesh parameterization): the larger of
  // `most` and 1 / `least`, at least 1. At most kMostDistortion, which a triangle squeezed flat has.
  double distortion() const;
};
inline constexpr double kMaxDistortion = 10;

// Nothing where the first triangle has no area.
std::optional<TriangleStretch> triangleStretch(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to);

// #F distortions of the triangles; 1 where a triangle has no area at rest. Both spans hold the #V positions.
std::vector<double> triangleDistortions(std::span<const Vec3f> rest, std::span<const Vec3f> posed,
                                        std::span<const Triangle> triangles);

// Distortion above 1 over the area at rest: 0.1 is a tenth too long or too short.
struct SurfaceStretch {
  double mean = 0, p95 = 0;  // p95: a twentieth of the area is stretched more
};
SurfaceStretch surfaceStretch(std::span<const Vec3f> rest, std::span<const Vec3f> posed,
                              std::span<const Triangle> triangles);

// The L2 stretch of a texture on a surface (Sander, Snyder, Gortler, Hoppe 2001, Texture mapping progressive meshes):
// the root mean square over the surface of the singular values of the map from the texture, by the mean scale of that
// map. 1 where texels are equal squares everywhere, else more. Triangles without an area in the texture do not count;
// nothing where all have none, or none has one on the surface.
//
// uvs  #V
std::optional<double> textureStretch(std::span<const Vec2f> uvs, std::span<const Vec3f> positions,
                                     std::span<const Triangle> triangles);

}  // namespace limber
