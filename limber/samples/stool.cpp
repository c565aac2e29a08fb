// A stool of 0.5 m: a round seat on four splayed legs with a ring of rungs.
#include "limber/samples/character.h"

namespace limber {

Character stoolCharacter() {
  Character c;
  c.name = "stool";
  c.cube = 0.0080;
  c.edge = 0.0140;
  c.materials = {{"wood", {196, 142, 88}, 0.6}, {"cushion", {178, 62, 58}, 0.85}, {"feet", {58, 52, 50}, 0.7}};
  c.shape.add(ellipsoid({0, 0.458, 0}, {0.186, 0.036, 0.186}), 0.01);
  c.shape.add(ellipsoid({0, 0.494, 0}, {0.180, 0.046, 0.180}), 0.004);
  constexpr double kTop = 0.098, kBottom = 0.165;
  for (const double front : {1.0, -1.0}) {
    c.shape.add(roundCone({kTop, 0.455, front * kTop}, 0.023, {kBottom, 0.0, front * kBottom}, 0.0180), 0.020);
    c.shape.add(roundCone({-0.140, 0.17, front * 0.140}, 0.0130, {0.140, 0.17, front * 0.140}, 0.0130), 0.012);
  }
  c.shape.add(roundCone({0.134, 0.21, 0.134}, 0.0130, {0.134, 0.21, -0.134}, 0.0130), 0.012);
  c.shape.cutBelow(0, 0.006);
  c.paints = {{ellipsoid({0, 0.530, 0}, {0.60, 0.0560, 0.60}), 1},
              {roundCone({kBottom, -0.04, kBottom}, 0.075, {kBottom, -0.04, -kBottom}, 0.075), 2}};
  return c;
}

}  // namespace limber
