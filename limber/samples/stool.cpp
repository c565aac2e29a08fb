// Stools of half a metre: a round seat on four splayed legs, with a ring of rungs and without.
#include "limber/samples/model_recipe.h"

namespace limber {

ModelRecipe stoolCharacter() {
  ModelRecipe c;
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

ModelRecipe footstoolCharacter() {
  ModelRecipe c;
  c.name = "footstool";
  c.cube = 0.0090;
  c.edge = 0.0150;
  c.materials = {{"wood", {150, 98, 62}, 0.55}, {"cushion", {52, 110, 140}, 0.9}, {"feet", {58, 52, 50}, 0.7}};
  c.shape.add(ellipsoid({0, 0.416, 0}, {0.196, 0.034, 0.196}), 0.01);
  c.shape.add(ellipsoid({0, 0.458, 0}, {0.186, 0.056, 0.186}), 0.006);
  const Vec3 top(0.112, 0.410, 0.112), knee(0.132, 0.215, 0.132), foot(0.168, 0.0, 0.168);
  for (const double front : {1.0, -1.0}) {
    const auto placed = [&](const Vec3& p) { return Vec3(p.x(), p.y(), front * p.z()); };
    c.shape.add(roundCone(placed(top), 0.036, placed(knee), 0.027), 0.024);
    c.shape.add(roundCone(placed(knee), 0.027, placed(foot), 0.020), 0.010);
  }
  c.shape.cutBelow(0, 0.006);
  c.paints = {{ellipsoid({0, 0.500, 0}, {0.60, 0.0675, 0.60}), 1}};
  for (const double z : {foot.z(), -foot.z()})
    c.paints.push_back({ellipsoid({foot.x(), 0, z}, {0.06, 0.035, 0.06}), 2});
  return c;
}

}  // namespace limber
