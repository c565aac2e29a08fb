// A young fox, 0.62 m high at the ears, with a bushy tail.
#include "limber/samples/model_recipe.h"

namespace limber {

namespace {

void addQuadrupedTrunk(Sculpture& s) {
  s.add(ellipsoid({0, 0.335, 0.130}, {0.092, 0.105, 0.125}), 0.02);             // chest
  s.add(roundCone({0, 0.335, 0.080}, 0.090, {0, 0.345, -0.150}, 0.080), 0.06);  // back and belly
  s.add(ellipsoid({0, 0.345, -0.170}, {0.086, 0.092, 0.105}), 0.05);            // rump
  s.add(roundCone({0, 0.365, 0.180}, 0.078, {0, 0.480, 0.235}, 0.062), 0.06);   // neck
  s.add(ellipsoid({0, 0.345, 0.225}, {0.062, 0.080, 0.050}), 0.05);             // ruff
}

void addQuadrupedHead(Sculpture& s) {
  s.add(ellipsoid({0, 0.535, 0.265}, {0.092, 0.080, 0.085}), 0.04);
  s.add(ellipsoid({0.052, 0.510, 0.280}, {0.050, 0.042, 0.050}), 0.04);                 // cheeks
  s.add(roundCone({0, 0.515, 0.320}, 0.047, {0, 0.502, 0.395}, 0.022), 0.04);           // muzzle
  s.add(ellipsoid({0, 0.512, 0.414}, {0.017, 0.014, 0.014}), 0.006);                    // nose
  s.add(roundCone({0.052, 0.590, 0.245}, 0.040, {0.086, 0.705, 0.225}, 0.011), 0.025);  // ears
  s.carve(roundCone({0.060, 0.600, 0.290}, 0.016, {0.088, 0.686, 0.254}, 0.006), 0.014);
}

void addQuadrupedTail(Sculpture& s) {
  const Vec3 root(0, 0.385, -0.245), low(0, 0.365, -0.365), middle(0, 0.425, -0.470), high(0, 0.535, -0.525),
      tip(0, 0.640, -0.520);
  s.add(roundCone(root, 0.034, low, 0.048), 0.04);
  s.add(roundCone(low, 0.048, middle, 0.070), 0.04);
  s.add(roundCone(middle, 0.070, high, 0.072), 0.04);
  s.add(roundCone(high, 0.072, tip, 0.016), 0.03);
}

void addForeleg(Sculpture& s) {
  s.add(roundCone({0.060, 0.340, 0.150}, 0.062, {0.074, 0.225, 0.155}, 0.043), 0.05);
  s.add(roundCone({0.074, 0.225, 0.155}, 0.041, {0.076, 0.060, 0.165}, 0.028), 0.02);
  s.add(ellipsoid({0.077, 0.022, 0.182}, {0.034, 0.026, 0.046}), 0.025);
}

void addHindLeg(Sculpture& s) {
  s.add(ellipsoid({0.066, 0.290, -0.165}, {0.050, 0.098, 0.082}), 0.05);  // thigh
  s.add(roundCone({0.076, 0.240, -0.140}, 0.052, {0.080, 0.150, -0.205}, 0.035), 0.03);
  s.add(roundCone({0.080, 0.150, -0.205}, 0.034, {0.080, 0.055, -0.185}, 0.027), 0.02);
  s.add(ellipsoid({0.081, 0.022, -0.160}, {0.034, 0.026, 0.048}), 0.025);
}

}  // namespace

ModelRecipe quadrupedCharacter() {
  ModelRecipe c;
  c.name = "quadruped";
  c.cube = 0.0085;
  c.edge = 0.0135;
  c.materials = {{"fur", {218, 122, 52}, 0.8},
                 {"white fur", {244, 234, 220}, 0.8},
                 {"dark fur", {74, 50, 44}, 0.8},
                 {"nose and eyes", {28, 24, 26}, 0.25}};
  addQuadrupedTrunk(c.shape);
  addQuadrupedHead(c.shape);
  addQuadrupedTail(c.shape);
  addForeleg(c.shape);
  addHindLeg(c.shape);
  c.shape.cutBelow(0, 0.008);
  c.details = {{ellipsoid({0, 0.512, 0.405}, {0.03, 0.03, 0.03}), 0.0065},
               {ellipsoid({0.045, 0.545, 0.335}, {0.022, 0.024, 0.026}), 0.0050},
               {roundCone({0.070, 0.640, 0.240}, 0.02, {0.086, 0.705, 0.225}, 0.015), 0.0075}};
  c.paints = {{ellipsoid({0, 0.380, 0.300}, {0.072, 0.165, 0.130}), 1},             // bib and chin
              {ellipsoid({0.070, 0.475, 0.330}, {0.075, 0.040, 0.100}), 1},         // cheeks
              {roundCone({0, 0.245, 0.220}, 0.042, {0, 0.245, -0.190}, 0.036), 1},  // belly
              {ellipsoid({0, 0.660, -0.520}, {0.095, 0.100, 0.095}), 1},            // tip of the tail
              {roundCone({0.076, -0.05, 0.165}, 0.125, {0.076, 0.060, 0.165}, 0.060), 2},
              {roundCone({0.080, -0.05, -0.170}, 0.125, {0.080, 0.050, -0.185}, 0.060), 2},
              {ellipsoid({0.092, 0.725, 0.220}, {0.050, 0.058, 0.050}), 2},  // tips of the ears
              {ellipsoid({0, 0.514, 0.419}, {0.019, 0.0155, 0.015}), 3},
              {ellipsoid({0.047, 0.547, 0.345}, {0.0125, 0.0165, 0.03}), 3}};
  return c;
}

}  // namespace limber
