// Shapes as distance fields: round cones, ellipsoids and plates, melted into one another and mirrored in x.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// A solid with a signed distance, negative inside. Only square roots and the four operations go into it, so that a
// model is the same to the bit wherever it is made.
struct Solid {
  enum class Kind { kRoundCone, kEllipsoid, kPlate };
  Kind kind = Kind::kEllipsoid;
  Vec3 a = Vec3::Zero(), b = Vec3::Zero(), c = Vec3::Zero();  // ends; centre; corners
  double ra = 0, rb = 0, rc = 0;                              // radius at each; an ellipsoid's three radii
  Mat3 axes = Mat3::Identity();                               // of an ellipsoid: rows are its own axes

  double distance(const Vec3& point) const;
};

// The hull of two spheres.
Solid roundCone(const Vec3& a, double ra, const Vec3& b, double rb);
// `forward`, if given, is where the ellipsoid's own z axis points. The distance is approximate away from the surface.
Solid ellipsoid(const Vec3& center, const Vec3& radii, const Vec3& forward = Vec3::UnitZ());
// The hull of three spheres, as long as their radii are small against the triangle.
Solid plate(const Vec3& a, double ra, const Vec3& b, double rb, const Vec3& c, double rc);

// Solids joined in the order in which they are added; each melts into what was there over the width `blend`. A solid
// that is not symmetric in x (told from its points) has its mirror image added with it.
class Sculpture {
 public:
  void add(const Solid& solid, double blend);
  // Takes the solid (and its mirror image) away, with an edge rounded over the width `blend`.
  void carve(const Solid& solid, double blend);
  // Cuts away what is below that height.
  void cutBelow(double height, double blend);

  // Finds out which solids matter where, so that distances take less time. Near the surface they stay the same to the
  // bit; far away, where that of an ellipsoid is approximate anyway, they keep their sign. For a sculpture that is
  // complete: what is added or carved later undoes it. Cost: about that of 20,000 distances.
  void prepare();

  // Even in x: distance(x, y, z) == distance(-x, y, z).
  double distance(const Vec3& point) const;
  // By central differences; and by one-sided ones, for less, where the distance is known.
  Vec3 gradient(const Vec3& point) const;
  Vec3 slope(const Vec3& point, double distanceThere) const;
  // A box that holds the surface.
  Box bounds() const;

 private:
  struct Step {
    Solid solid;
    double blend = 0;
    bool mirrored = false, carved = false;
    Vec3 center = Vec3::Zero();  // of a ball that holds the solid
    double reach = 0;            // its radius
  };
  // Least and greatest.
  struct Range {
    double low = 0, high = 0;
  };
  // A cube that holds all solids, cut into cells; steps[first[cell]] up to steps[first[cell + 1]] are those that matter
  // in it, in their order.
  struct Cells {
    Vec3 origin = Vec3::Zero();
    double size = 0;  // metres, of a cell
    std::vector<std::uint32_t> first, steps;
  };
  static bool near(const Vec3& point, const Step& step, double within);
  static Range rangeOf(const Step& step, const Vec3& middle, double half);
  std::vector<std::uint32_t> mattering(std::span<const std::uint32_t> among, const Vec3& middle, double half) const;
  std::span<const std::uint32_t> stepsAt(const Vec3& point) const;

  std::vector<Step> steps_;
  std::vector<std::uint32_t> all_;  // 0, 1, 2, ...: of steps_
  Cells cells_;
  double floor_ = -1e30, floorBlend_ = 0;
};

}  // namespace limber
