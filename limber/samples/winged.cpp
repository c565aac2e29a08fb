// A small dragon on four legs with its wings spread.
#include "limber/samples/model_recipe.h"

namespace limber {

namespace {

void addWingedTrunk(Sculpture& s) {
  s.add(ellipsoid({0, 0.400, 0.100}, {0.120, 0.130, 0.150}), 0.02);             // chest
  s.add(roundCone({0, 0.395, 0.050}, 0.118, {0, 0.370, -0.180}, 0.100), 0.06);  // belly
  s.add(ellipsoid({0, 0.370, -0.200}, {0.108, 0.110, 0.120}), 0.05);            // rump
  s.add(roundCone({0, 0.440, 0.170}, 0.092, {0, 0.570, 0.270}, 0.070), 0.06);   // neck
  s.add(roundCone({0, 0.570, 0.270}, 0.070, {0, 0.690, 0.300}, 0.062), 0.04);
}

void addWingedHead(Sculpture& s) {
  s.add(ellipsoid({0, 0.745, 0.325}, {0.098, 0.088, 0.100}), 0.05);
  s.add(roundCone({0, 0.725, 0.390}, 0.062, {0, 0.705, 0.475}, 0.046), 0.05);           // snout
  s.add(ellipsoid({0.028, 0.735, 0.497}, {0.015, 0.012, 0.014}), 0.020);                // nostrils
  s.add(ellipsoid({0.056, 0.795, 0.372}, {0.034, 0.022, 0.034}), 0.025);                // brows
  s.add(roundCone({0.055, 0.810, 0.290}, 0.027, {0.085, 0.890, 0.215}, 0.017), 0.018);  // horns
  s.add(roundCone({0.085, 0.890, 0.215}, 0.017, {0.092, 0.955, 0.175}, 0.009), 0.010);
  s.add(roundCone({0.080, 0.745, 0.285}, 0.026, {0.150, 0.770, 0.225}, 0.010), 0.020);  // ears
}

void addWingedTail(Sculpture& s) {
  const Vec3 root(0, 0.365, -0.270), low(0, 0.260, -0.430), middle(0, 0.185, -0.600), high(0, 0.200, -0.775),
      tip(0, 0.290, -0.910);
  s.add(roundCone(root, 0.088, low, 0.064), 0.05);
  s.add(roundCone(low, 0.064, middle, 0.046), 0.04);
  s.add(roundCone(middle, 0.046, high, 0.032), 0.03);
  s.add(roundCone(high, 0.032, tip, 0.020), 0.02);
  s.add(plate({0, 0.270, -0.880}, 0.014, {0, 0.410, -0.930}, 0.010, {0, 0.320, -1.020}, 0.010), 0.020);  // its leaf
}

// Small plates along the spine.
void addCrest(Sculpture& s) {
  const Vec3 spine[] = {{0, 0.640, 0.205},  {0, 0.560, 0.150},  {0, 0.520, 0.050},  {0, 0.500, -0.060},
                        {0, 0.480, -0.170}, {0, 0.420, -0.290}, {0, 0.320, -0.410}, {0, 0.240, -0.540}};
  for (const Vec3& foot : spine) {
    s.add(roundCone(foot + Vec3(0, -0.025, 0.025), 0.030, foot + Vec3(0, 0.050, -0.035), 0.009), 0.020);
  }
}

void addLegs(Sculpture& s) {
  s.add(roundCone({0.090, 0.370, 0.130}, 0.072, {0.125, 0.225, 0.120}, 0.050), 0.05);
  s.add(roundCone({0.125, 0.225, 0.120}, 0.048, {0.130, 0.070, 0.150}, 0.038), 0.02);
  s.add(ellipsoid({0.132, 0.030, 0.180}, {0.050, 0.036, 0.062}), 0.03);
  s.add(ellipsoid({0.095, 0.310, -0.205}, {0.068, 0.110, 0.095}), 0.05);
  s.add(roundCone({0.120, 0.245, -0.160}, 0.062, {0.130, 0.150, -0.225}, 0.044), 0.03);
  s.add(roundCone({0.130, 0.150, -0.225}, 0.042, {0.132, 0.065, -0.200}, 0.038), 0.02);
  s.add(ellipsoid({0.134, 0.030, -0.168}, {0.052, 0.036, 0.064}), 0.03);
  for (const double z : {0.0, -0.348}) {
    for (const double x : {-0.030, 0.0, 0.030}) {
      s.add(ellipsoid({0.132 + x, 0.022, 0.236 + z - 8 * x * x}, {0.015, 0.020, 0.022}), 0.012);  // toes
    }
  }
}

// The arm of a wing, three fingers that spread from its wrist, and the skin between them.
void addWing(Sculpture& s) {
  const Vec3 shoulder(0.070, 0.490, 0.060), elbow(0.235, 0.640, 0.000), wrist(0.420, 0.770, 0.060);
  const Vec3 tips[] = {{0.870, 0.780, -0.060}, {0.740, 0.630, -0.240}, {0.500, 0.520, -0.330}};
  const Vec3 flank(0.095, 0.470, -0.050);
  s.add(roundCone(shoulder, 0.048, elbow, 0.032), 0.04);
  s.add(roundCone(elbow, 0.032, wrist, 0.026), 0.02);
  s.add(roundCone(wrist, 0.022, wrist + Vec3(0.020, 0.075, 0.030), 0.009), 0.012);  // claw
  for (const Vec3& tip : tips) s.add(roundCone(wrist, 0.023, tip, 0.0115), 0.014);
  constexpr double kSkin = 0.0088;
  // Each web hangs between two fingers; its free edge is drawn in towards the wrist.
  const auto web = [&](const Vec3& root, const Vec3& a, const Vec3& b) {
    const Vec3 drawn = 0.5 * (a + b) + 0.20 * (root - 0.5 * (a + b));
    s.add(plate(root, kSkin + 0.003, a, kSkin, drawn, kSkin), 0.016);
    s.add(plate(root, kSkin + 0.003, b, kSkin, drawn, kSkin), 0.016);
  };
  web(wrist, tips[0], tips[1]);
  web(wrist, tips[1], tips[2]);
  web(wrist, tips[2], flank);
  s.add(plate(wrist, kSkin + 0.003, elbow, kSkin + 0.003, flank, kSkin + 0.002), 0.016);
  s.add(plate(shoulder, 0.020, elbow, kSkin + 0.003, flank, kSkin + 0.002), 0.020);
}

}  // namespace

ModelRecipe wingedCharacter() {
  ModelRecipe c;
  c.name = "winged";
  c.cube = 0.0110;
  c.edge = 0.0230;
  c.materials = {{"scales", {72, 148, 96}, 0.55}, {"belly", {232, 214, 150}, 0.7}, {"wing skin", {226, 128, 72}, 0.7},
                 {"horn", {238, 226, 198}, 0.5},  {"crest", {40, 104, 84}, 0.6},   {"eyes", {26, 24, 28}, 0.2}};
  addWingedTrunk(c.shape);
  addWingedHead(c.shape);
  addWingedTail(c.shape);
  addCrest(c.shape);
  addLegs(c.shape);
  addWing(c.shape);
  c.shape.cutBelow(0, 0.010);
  c.details = {{ellipsoid({0.074, 0.764, 0.392}, {0.026, 0.030, 0.030}), 0.0075}};
  const Vec3 wrist(0.420, 0.770, 0.060);
  c.paints = {
      // Wings but for their arms.
      {plate(wrist + Vec3(0.02, -0.06, -0.11), 0.080, {0.90, 0.76, -0.16}, 0.080, {0.42, 0.44, -0.36}, 0.080), 2},
      {plate(wrist + Vec3(-0.02, -0.06, -0.11), 0.080, {0.42, 0.44, -0.36}, 0.080, {0.175, 0.52, -0.10}, 0.055), 2},
      {roundCone({0, 0.280, 0.150}, 0.075, {0, 0.255, -0.170}, 0.060), 1},  // belly
      {roundCone({0, 0.330, 0.270}, 0.085, {0, 0.520, 0.350}, 0.060), 1},   // throat
      {roundCone({0, 0.520, 0.350}, 0.060, {0, 0.655, 0.400}, 0.040), 1},
      {roundCone({0.062, 0.850, 0.256}, 0.036, {0.100, 0.980, 0.150}, 0.040), 3},  // horns
      {ellipsoid({0.132, -0.005, 0.250}, {0.075, 0.042, 0.036}), 3},               // claws
      {ellipsoid({0.132, -0.005, -0.098}, {0.075, 0.042, 0.036}), 3},
      {roundCone(wrist + Vec3(0.012, 0.050, 0.020), 0.022, wrist + Vec3(0.026, 0.100, 0.040), 0.026), 3},
      {plate({0, 0.285, -0.925}, 0.025, {0, 0.430, -0.930}, 0.040, {0, 0.320, -1.040}, 0.040), 4},
      {ellipsoid({0.088, 0.768, 0.392}, {0.026, 0.0215, 0.0185}), 5}};
  return c;
}

}  // namespace limber
