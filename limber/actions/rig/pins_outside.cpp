#include "limber/actions/rig/pins_outside.h"

#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

// In longest sides of the model, 0 to 1. A hand is 0.016 of the stature thick (28 of 1750 mm, DIN 33402-2): what is
// farther out was not meant for the surface beside it. 0.36 m of 1.7 m, a hand's position in another pose, is 0.21.
constexpr double kTolerance = 0.02;

constexpr double kInside = 0.5;  // winding number: 1 inside, 0 outside

}  // namespace

void warnPinsOutside(const PreparedMesh& mesh, std::span<const JointPin> pins, Warnings& warnings) {
  if (pins.empty() || mesh.mesh.triangles.empty()) return;
  const Bvh surface(mesh.mesh);
  const double tolerance = kTolerance * modelBox(mesh.mesh).longestSide();
  std::optional<WindingNumber> winding;  // only where a pin is far from the surface
  const JointPin* farthest = nullptr;
  double distance = 0;
  std::size_t count = 0;
  std::string names;
  for (const JointPin& pin : pins) {
    const Vec3 position = mesh.frame.toWorking(pin.position);
    const double away = surface.nearestPoint(position).distance;
    if (away <= tolerance) continue;
    if (!winding) winding.emplace(mesh.mesh);
    if (std::abs(winding->at(position)) > kInside) continue;
    ++count;
    names += (names.empty() ? "" : ", ") + pin.joint;
    if (farthest && away <= distance) continue;
    farthest = &pin;
    distance = away;
  }
  if (!farthest) return;
  const double metres = distance * mesh.frame.scale;
  warnings.add("pins-outside",
               count == 1 ? fmt::format("pin {} is {:.3g} m outside the surface", farthest->joint, metres)
                          : fmt::format("pins are outside the surface, {} by {:.3g} m", farthest->joint, metres),
               names, count);
}

}  // namespace limber
