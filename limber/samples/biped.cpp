// A person of 1.7 m in A-pose, with stylised hands and boots.
#include "limber/samples/model_recipe.h"

namespace limber {

namespace {

void addBipedTrunk(Sculpture& s) {
  s.add(ellipsoid({0, 0.945, -0.008}, {0.150, 0.115, 0.108}), 0.02);
  s.add(ellipsoid({0, 1.080, 0.000}, {0.126, 0.160, 0.092}), 0.09);
  s.add(ellipsoid({0, 1.255, -0.008}, {0.158, 0.150, 0.108}), 0.07);
  s.add(ellipsoid({0.070, 1.285, 0.044}, {0.085, 0.066, 0.052}), 0.07);                 // chest
  s.add(ellipsoid({0.075, 0.915, -0.060}, {0.085, 0.090, 0.070}), 0.06);                // seat
  s.add(roundCone({0.02, 1.400, -0.024}, 0.050, {0.160, 1.350, -0.020}, 0.058), 0.06);  // shoulders
  s.add(roundCone({0, 1.380, -0.022}, 0.056, {0, 1.500, 0.000}, 0.047), 0.06);          // neck
}

void addBipedHead(Sculpture& s) {
  s.add(ellipsoid({0, 1.614, 0.000}, {0.096, 0.108, 0.106}), 0.03);
  s.add(ellipsoid({0, 1.556, 0.036}, {0.066, 0.058, 0.066}), 0.06);             // jaw
  s.add(roundCone({0, 1.596, 0.102}, 0.008, {0, 1.576, 0.114}, 0.012), 0.025);  // nose
  s.add(ellipsoid({0.097, 1.590, -0.002}, {0.013, 0.028, 0.020}), 0.015);       // ears
  s.add(ellipsoid({0, 1.650, -0.030}, {0.108, 0.098, 0.112}), 0.006);           // hair
  s.add(ellipsoid({0, 1.585, -0.060}, {0.088, 0.075, 0.062}), 0.03);
  s.add(ellipsoid({0, 1.712, -0.085}, {0.048, 0.046, 0.048}), 0.012);  // bun
}

void addArm(Sculpture& s) {
  const Vec3 shoulder(0.174, 1.346, -0.020), elbow(0.384, 1.184, -0.028), wrist(0.572, 1.020, 0.000);
  s.add(roundCone(shoulder, 0.060, elbow, 0.041), 0.05);
  s.add(ellipsoid({0.262, 1.284, -0.012}, {0.045, 0.048, 0.080}, elbow - shoulder), 0.04);  // biceps
  s.add(roundCone(elbow, 0.040, wrist, 0.029), 0.03);
  s.add(ellipsoid(elbow + 0.3 * (wrist - elbow), {0.044, 0.040, 0.080}, wrist - elbow), 0.03);

  const Vec3 along = Vec3(0.72, -0.685, 0.10).normalized();  // from the wrist to the fingertips
  const Vec3 wide = (Vec3(0.05, 0.10, 1) - Vec3(0.05, 0.10, 1).dot(along) * along).normalized();
  const Vec3 back = wide.cross(along);  // of the hand
  const Vec3 palm = wrist + 0.062 * along, knuckles = wrist + 0.090 * along;
  for (const double side : {1.0, -1.0}) {
    s.add(roundCone(wrist + 0.02 * along + side * 0.012 * wide, 0.026, palm + side * 0.022 * wide, 0.026), 0.03);
    const Vec3 bent = knuckles + 0.045 * along + side * 0.022 * wide - 0.004 * back;
    s.add(roundCone(palm + side * 0.022 * wide, 0.025, bent, 0.0215), 0.02);
    s.add(roundCone(bent, 0.0215, bent + 0.034 * along - side * 0.003 * wide - 0.016 * back, 0.0185), 0.016);
  }
  const Vec3 thumbRoot = wrist + 0.034 * along + 0.026 * wide, thumbJoint = thumbRoot + 0.026 * along + 0.036 * wide;
  s.add(roundCone(thumbRoot, 0.023, thumbJoint, 0.0195), 0.018);
  s.add(roundCone(thumbJoint, 0.0195, thumbJoint + 0.030 * along + 0.010 * wide - 0.006 * back, 0.0165), 0.01);
}

void addLeg(Sculpture& s) {
  const Vec3 hip(0.088, 0.890, -0.005), knee(0.106, 0.490, 0.008), ankle(0.114, 0.095, -0.030);
  s.add(roundCone(hip, 0.084, knee, 0.054), 0.07);
  s.add(ellipsoid({0.100, 0.700, 0.022}, {0.070, 0.160, 0.068}), 0.05);  // thigh
  s.add(roundCone(knee, 0.052, ankle, 0.037), 0.03);
  s.add(ellipsoid({0.112, 0.365, -0.026}, {0.052, 0.125, 0.052}), 0.04);                // calf
  s.add(ellipsoid({0.106, 0.500, 0.032}, {0.038, 0.045, 0.032}), 0.03);                 // kneecap
  s.add(roundCone({0.114, 0.048, -0.052}, 0.048, {0.124, 0.036, 0.085}, 0.044), 0.04);  // boot
  s.add(roundCone({0.116, 0.090, -0.020}, 0.046, {0.122, 0.048, 0.060}, 0.044), 0.03);
  s.add(ellipsoid({0.127, 0.030, 0.110}, {0.052, 0.038, 0.062}), 0.03);  // toes
}

}  // namespace

ModelRecipe bipedCharacter() {
  ModelRecipe c;
  c.name = "biped";
  c.cube = 0.0120;
  c.edge = 0.0190;
  c.materials = {{"suit", {64, 132, 140}, 0.8}, {"skin", {226, 172, 138}, 0.6}, {"boots", {92, 62, 52}, 0.6},
                 {"hair", {74, 48, 38}, 0.85},  {"eyes", {34, 30, 34}, 0.2},    {"belt", {214, 166, 84}, 0.5}};
  addBipedTrunk(c.shape);
  addBipedHead(c.shape);
  addArm(c.shape);
  addLeg(c.shape);
  c.shape.cutBelow(0, 0.012);

  c.details = {{ellipsoid({0, 1.59, 0.08}, {0.06, 0.04, 0.05}), 0.009},
               {ellipsoid({0.038, 1.606, 0.095}, {0.022, 0.026, 0.026}), 0.0055},
               {ellipsoid({0.655, 0.930, 0.03}, {0.06, 0.06, 0.05}), 0.0115}};
  const Vec3 forearm = Vec3(0.187, -0.172, 0.028).normalized();
  c.paints = {{ellipsoid({0, 1.640, 0.010}, {0.18, 0.185, 0.19}), 1},
              {ellipsoid({0.69, 0.905, 0.015}, {0.16, 0.16, 0.175}, forearm), 1},
              {roundCone({0.120, -0.02, 0.05}, 0.22, {0.120, -0.02, -0.05}, 0.22), 2},
              {plate({0.25, 0.990, -0.25}, 0.018, {0.25, 0.990, 0.25}, 0.018, {-0.60, 0.990, 0}, 0.018), 5},
              {ellipsoid({0, 1.650, -0.030}, {0.112, 0.102, 0.1155}), 3},
              {ellipsoid({0, 1.590, -0.072}, {0.094, 0.088, 0.072}), 3},
              {ellipsoid({0, 1.712, -0.085}, {0.060, 0.056, 0.060}), 3},
              {ellipsoid({0.038, 1.604, 0.100}, {0.0135, 0.0185, 0.03}), 4}};
  return c;
}

}  // namespace limber
