// A two-legged dinosaur, 0.95 m high and 1.7 m long: a heavy tail that balances the trunk, small arms.
#include "limber/samples/model_recipe.h"

namespace limber {

namespace {

void addTheropodTrunk(Sculpture& s) {
  s.add(ellipsoid({0, 0.530, -0.050}, {0.112, 0.125, 0.165}), 0.02);            // hips
  s.add(roundCone({0, 0.525, -0.060}, 0.112, {0, 0.540, 0.160}, 0.116), 0.06);  // belly
  s.add(ellipsoid({0, 0.555, 0.190}, {0.112, 0.132, 0.140}), 0.05);             // chest
  s.add(roundCone({0, 0.605, 0.265}, 0.088, {0, 0.725, 0.350}, 0.066), 0.06);   // neck
  s.add(roundCone({0, 0.725, 0.350}, 0.066, {0, 0.835, 0.375}, 0.060), 0.05);
}

void addTheropodHead(Sculpture& s) {
  s.add(ellipsoid({0, 0.880, 0.415}, {0.074, 0.070, 0.092}), 0.05);
  s.add(roundCone({0, 0.875, 0.460}, 0.056, {0, 0.856, 0.590}, 0.041), 0.05);  // snout
  s.add(ellipsoid({0.040, 0.842, 0.450}, {0.034, 0.036, 0.060}), 0.04);        // cheeks
  s.add(roundCone({0, 0.824, 0.455}, 0.038, {0, 0.812, 0.570}, 0.027), 0.02);  // jaw
  // The mouth, along both sides of the snout.
  s.carve(roundCone({0.056, 0.836, 0.478}, 0.004, {0.046, 0.828, 0.580}, 0.006), 0.006);
  s.carve(roundCone({0.046, 0.828, 0.580}, 0.006, {0.0, 0.826, 0.628}, 0.006), 0.006);
  s.add(ellipsoid({0.048, 0.925, 0.450}, {0.024, 0.018, 0.044}), 0.022);  // brows
  s.add(ellipsoid({0.020, 0.888, 0.600}, {0.013, 0.010, 0.014}), 0.016);  // nostrils
}

void addTheropodTail(Sculpture& s) {
  const Vec3 root(0, 0.530, -0.180), low(0, 0.510, -0.390), middle(0, 0.500, -0.620), high(0, 0.520, -0.840),
      tip(0, 0.560, -1.030);
  s.add(roundCone(root, 0.112, low, 0.084), 0.06);
  s.add(roundCone(low, 0.084, middle, 0.056), 0.05);
  s.add(roundCone(middle, 0.056, high, 0.034), 0.04);
  s.add(roundCone(high, 0.034, tip, 0.016), 0.02);
}

void addTheropodArm(Sculpture& s) {
  const Vec3 shoulder(0.088, 0.530, 0.265), elbow(0.130, 0.435, 0.235), wrist(0.118, 0.395, 0.325);
  s.add(roundCone(shoulder, 0.040, elbow, 0.027), 0.03);
  s.add(roundCone(elbow, 0.026, wrist, 0.021), 0.012);
  for (const double x : {-0.018, 0.018}) {
    const Vec3 knuckle = wrist + Vec3(x, -0.014, 0.020);
    s.add(roundCone(wrist, 0.019, knuckle, 0.015), 0.010);
    s.add(roundCone(knuckle, 0.0145, knuckle + Vec3(0.25 * x, -0.030, 0.016), 0.0100), 0.006);
  }
}

void addTheropodLeg(Sculpture& s) {
  const Vec3 hip(0.098, 0.500, -0.040), knee(0.130, 0.325, 0.070), ankle(0.134, 0.160, -0.070),
      ball(0.136, 0.045, 0.015);
  s.add(roundCone(hip, 0.104, knee, 0.066), 0.06);
  s.add(roundCone(knee, 0.060, ankle, 0.037), 0.025);
  s.add(roundCone(ankle, 0.035, ball, 0.034), 0.015);
  s.add(ellipsoid(ball + Vec3(0, -0.012, 0.012), {0.046, 0.034, 0.050}), 0.025);
  for (const double x : {-0.040, 0.0, 0.040}) {
    const double reach = 0.105 - 14 * x * x;
    s.add(roundCone(ball + Vec3(0.6 * x, -0.018, 0.02), 0.025, ball + Vec3(1.15 * x, -0.024, reach), 0.020), 0.012);
    s.add(roundCone(ball + Vec3(1.15 * x, -0.024, reach), 0.018, ball + Vec3(1.25 * x, -0.032, reach + 0.034), 0.010),
          0.006);
  }
}

}  // namespace

ModelRecipe theropodCharacter() {
  ModelRecipe c;
  c.name = "theropod";
  c.cube = 0.0090;
  c.edge = 0.0190;
  c.materials = {{"hide", {88, 128, 142}, 0.65},
                 {"belly", {230, 218, 186}, 0.75},
                 {"stripes", {44, 78, 100}, 0.65},
                 {"claws", {58, 50, 48}, 0.4},
                 {"eyes", {24, 22, 26}, 0.2}};
  addTheropodTrunk(c.shape);
  addTheropodHead(c.shape);
  addTheropodTail(c.shape);
  addTheropodArm(c.shape);
  addTheropodLeg(c.shape);
  c.shape.cutBelow(0, 0.008);
  c.details = {{ellipsoid({0.062, 0.895, 0.480}, {0.026, 0.030, 0.032}), 0.0070},
               {roundCone({0.118, 0.395, 0.325}, 0.040, {0.118, 0.350, 0.360}, 0.036), 0.0095},
               {roundCone({0.136, 0.020, 0.090}, 0.075, {0.136, 0.010, 0.160}, 0.060), 0.0120}};
  c.paints = {{roundCone({0, 0.400, 0.240}, 0.070, {0, 0.385, -0.120}, 0.052), 1},  // belly
              {roundCone({0, 0.430, 0.260}, 0.080, {0, 0.600, 0.370}, 0.062), 1},   // breast
              {roundCone({0, 0.600, 0.370}, 0.062, {0, 0.770, 0.440}, 0.040), 1},   // throat
              {roundCone({0, 0.795, 0.460}, 0.034, {0, 0.790, 0.590}, 0.036), 1},   // chin
              {roundCone({0, 0.385, -0.120}, 0.052, {0, 0.420, -0.420}, 0.045), 1}};
  // Across the back, from the neck to the end of the tail.
  const struct {
    Vec3 at;
    double width;
  } stripes[] = {{{0, 0.760, 0.290}, 0.034},  {{0, 0.715, 0.180}, 0.055},  {{0, 0.695, 0.080}, 0.060},
                 {{0, 0.685, -0.020}, 0.060}, {{0, 0.675, -0.120}, 0.058}, {{0, 0.650, -0.220}, 0.054},
                 {{0, 0.620, -0.320}, 0.050}, {{0, 0.595, -0.430}, 0.045}, {{0, 0.575, -0.540}, 0.040},
                 {{0, 0.565, -0.650}, 0.035}, {{0, 0.565, -0.760}, 0.030}};
  for (const auto& [at, width] : stripes) {
    c.paints.push_back({ellipsoid(at, {2.0 * width, 1.9 * width, 0.42 * width}), 2});
  }
  c.paints.push_back({ellipsoid({0, 0.560, -1.000}, {0.06, 0.06, 0.110}), 2});
  for (const double x : {-0.050, 0.0, 0.050}) {
    c.paints.push_back({ellipsoid({0.136 + x, 0.006, 0.166 - 16 * x * x}, {0.020, 0.024, 0.026}), 3});
  }
  c.paints.push_back({ellipsoid({0.118, 0.350, 0.366}, {0.050, 0.020, 0.030}), 3});
  c.paints.push_back({ellipsoid({0.064, 0.898, 0.484}, {0.022, 0.0165, 0.0165}), 4});
  return c;
}

}  // namespace limber
