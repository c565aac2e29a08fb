// Curves through the middle of a body and of what branches off it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

// A curve through the middle of a part, from where it hangs to its end.
struct BodyCurve {
  struct Point {
    Vec3 position =
        Vec3::Zero();     // body space, but for its unit: the mesh's, so that what is low counts like what is high
    double radius = 0;    // how deep it lies, mesh
    double area = 0;      // of the section across the part, mesh squared
    double flatness = 1;  // how many times wider than thick the section is
  };
  std::vector<Point>
      points;  // two or more of a branch, a few grid cells apart; of a branch the first lies on its carrier
  std::optional<std::size_t> carrier;  // the curve that it hangs on; none: the trunk
  std::size_t at = 0;                  // the carrier's point there
  bool isPaired = false;               // there is one on either side; this is the left one
  double length = 0;

  const Vec3& end() const { return points.back().position; }
  // Of a branch: where it comes out of its carrier, halfway into the flesh, as far to the side as it comes out.
  Vec3 root() const;
  // The points' in the middle, of the outer two thirds.
  double flatness() const;
  double meanRadius() const;
};

// The level sets of the path length through the inside from one end of the body have as many components as the body has
// parts there; their centres make a tree of curves (Verroust, Lazarus: Extracting skeletal curves from 3D scattered
// data, 2000). Only parts that are on both sides count; the trunk runs between left and right. Branches that are short
// for the thickness of the body at their root are left out.
//
// frame  of a symmetric body
// The trunk comes first, from one end to the other; which end is which is not known yet. A carrier comes before the
// curves attached to it. Empty where nothing lies between left and right. Cost: a few shortest-path searches through
// the grid.
std::vector<BodyCurve> bodyCurves(const BodyVolume& body, const AnatomicalFrame& frame);

}  // namespace limber
