// Where a surface that was laid on another one stays apart from it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Distances in percent of the body's height.
struct PartGap {
  std::string part;  // "left hand"; "other" for joints of no part
  double area = 0;   // of the target's surface, 0 to 1
  double rms = 0;
  double beyond = 0;  // part of its area that is farther than kGap, 0 to 1
};

struct SurfaceGaps {
  double rms = 0, p95 = 0, worst = 0;
  double beyond = 0;
  std::vector<PartGap> parts;  // that part of their area which lies beyond kGap is largest, first
};

inline constexpr double kGap = 2;  // percent of the height

// points    #V, where each vertex of the target is met by the surface laid on it
// anatomy   names the parts, by the joint that holds a vertex most
// height    of the target, in its space
SurfaceGaps measureGaps(const TriMesh& target, std::span<const SurfacePoint> points, const Anatomy& anatomy,
                        const SkinWeights& weights, double height);

}  // namespace limber
