// A body's surface as a network reads it: points spread over it, with their normals and how thick the body is there.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/reading/arithmetic.h"

namespace limber {

struct SurfaceSample {
  Vec3 position;                 // in the mesh's space
  Vec3 normal;                   // of the triangle; out of the body, whichever way round the mesh has its triangles
  double innerRadius = 0;        // of the largest ball that touches the surface here from inside
  double componentFraction = 0;  // area of the connected component it lies on, over all area
  Index triangle = 0;            // of the mesh, on which it lies
};

struct SurfaceSamples {
  std::vector<SurfaceSample> samples;  // each as far from those before it as can be
  Vec3 center = Vec3::Zero();          // mean of the positions
  double scale = 1;                    // root mean square of their distances from it
  bool normalsFlipped = false;         // the mesh is inside out as a whole

  Vec3 toNetwork(const Vec3& position) const { return (position - center) / scale; }
  Vec3 toMesh(const Vec3& position) const { return scale * position + center; }
};

// The first random points, of which samples are chosen, and with which a ball may not be filled.
inline constexpr std::size_t kSurfacePoints = 4096;

// Random points by area, from a fixed seed; of these `count`, farthest first. Inner balls are measured against all
// random points, and are at most a quarter of their box's diagonal in radius.
//
// mesh   welded, indices in range; triangles without area are left out
// count  1 to kSurfacePoints
// Same bits for any number of threads. Throws Error kBadData where the mesh has no area, or no finite one, and
// kBadArgument for another count.
// Cost: O(#V + #F + count * kSurfacePoints), 28 ms on one core for 512.
SurfaceSamples sampleSurface(const TriMesh& mesh, std::size_t count = 512);

// The samples of the body moved by a rotation or a reflection: a matrix whose inverse is its transpose.
SurfaceSamples transformed(SurfaceSamples samples, const Mat3& matrix);

// The mirror image in the plane x = 0.
SurfaceSamples mirrored(const SurfaceSamples& samples);

// What a network is given of each sample, a row for each: position, normal, centre of the inner ball, its radius,
// component's fraction, then sine and cosine of the position at three frequencies. Positions and radii are centred and
// scaled.
inline constexpr std::size_t kSampleFeatures = 29;
FloatMatrix sampleFeatures(const SurfaceSamples& samples);

}  // namespace limber
