// How thick a character is about its bones.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limber/character/matching/body_skin.h"
#include "limber/character/matching/retarget_setup.h"

namespace limber {

// The skin that one joint carries, as a radius about an axis: by how far along it and by the angle about it.
class SkinTube {
 public:
  // None where a joint carries too little, or along no line. The axis goes from the joint towards the middle of its
  // skin, the tube from the first sample along it to the last.
  static std::optional<SkinTube> about(Index joint, const BodySkin& skin);

  struct Depth {
    double depth = 0;          // metres below the surface; negative outside
    Vec3 out = Vec3::UnitZ();  // the direction out, away from the axis
  };
  // Of a point of the person's space; none beyond the tube's ends.
  std::optional<Depth> depthOf(const Vec3& point, const BodyFrame& frame) const;
  // Mean over all sides, metres.
  double thickness() const;

 private:
  // Pieces; 3 to 10 along the axis, 8 to 24 about it (a cell needs some of a joint's samples); set by hand.
  static constexpr int kRings = 5, kSectors = 12;
  static constexpr std::size_t kCells = std::size_t{kRings} * kSectors;

  // Of a direction across the axis, in sectors: 0 to 2 kSectors.
  static double sectorAt(double x, double z);
  double radiusAt(double along, double sector) const;

  Index joint_ = 0;
  Vec3 axis_ = Vec3::UnitY(), side_ = Vec3::UnitX(), ahead_ = Vec3::UnitZ();  // in the joint's frame
  double begin_ = 0, end_ = 0;                                                // along the axis, metres
  std::array<double, kCells> radius_ = {};
};

}  // namespace limber
