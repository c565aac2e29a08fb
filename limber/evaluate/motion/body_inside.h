// Where a body ends, whatever surfaces it has within: pieces that overlap, clothes over skin.
#pragma once

#include <optional>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

// Inside is where the surface winds round a point by more than a half. Keeps no reference to the mesh. Cost: as of Bvh
// and WindingNumber.
class BodyInside {
 public:
  explicit BodyInside(const TriMesh& mesh);

  bool contains(const Vec3& point) const;

  // How far from a point inside the body ends along a unit vector: at the first surface that has no inside behind it.
  // Nothing where there is none.
  std::optional<double> exitFrom(const Vec3& point, const Vec3& direction) const;

  // A step off the surface that leads across it and no farther.
  double step() const { return step_; }

 private:
  Bvh surface_;
  WindingNumber winding_;
  double step_;
};

}  // namespace limber
