// Cuts through the inside of a body.
#pragma once

#include <array>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

// A cut through the inside of a body.
struct BodySection {
  Vec3 origin = Vec3::Zero(), across = Vec3::UnitX(), along = Vec3::UnitZ();  // of the plane; unit vectors
  Vec3 center = Vec3::Zero();
  double area = 0;                        // square heights
  double low = 0, high = 0;               // extent of the part that was cut, across
  std::vector<std::array<int, 2>> cells;  // of the part, across and along; sorted
  double cell = 0;                        // edge of a cell, in heights

  bool empty() const { return cells.empty(); }
  bool contains(const Vec3& position) const;
  double halfDepth() const;  // half the extent of the part, along
};

// The connected part of the cut square to `normal` (a unit vector) at `seed` that contains the inside position nearest
// to it; empty where none lies within `reach` (heights). For a level cut `across` is x.
BodySection sectionAt(const BodyVolume& body, const AnatomicalFrame& frame, const Vec3& seed, const Vec3& normal,
                      double reach);

}  // namespace limber
