// Rotation centres against the sum over all triangles, and what they are for: elbows that bend and twist.
#include "limber/deform/rotation_centers.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/deform/deformer.h"

namespace limber {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr Index kRings = 41, kSides = 24;

struct Tube {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  SkinWeights weights;
};

// Radius 0.3 round x from -2 to 2. The weights of three joints, at x = -2, 0 and 1, blend in smooth ramps.
Tube tube() {
  Tube result;
  result.weights.slots = 3;
  const auto ramp = [](double x, double at) { return 1 / (1 + std::exp(-6 * (x - at))); };
  for (Index ring = 0; ring < kRings; ++ring) {
    const double x = -2 + 4.0 * ring / (kRings - 1);
    for (Index side = 0; side < kSides; ++side) {
      const double angle = 2 * kPi * side / kSides;
      result.positions.push_back(Vec3(x, 0.3 * std::cos(angle), 0.3 * std::sin(angle)).cast<float>());
      const double first = ramp(x, 0), second = ramp(x, 1);
      for (const Index joint : {0u, 1u, 2u}) result.weights.joints.push_back(joint);
      for (const double w : {1 - first, first * (1 - second), first * second}) {
        result.weights.weights.push_back(static_cast<float>(w));
      }
    }
  }
  for (Index ring = 0; ring + 1 < kRings; ++ring) {
    for (Index side = 0; side < kSides; ++side) {
      const Index a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
      result.triangles.push_back({a, a + kSides, b});
      result.triangles.push_back({b, a + kSides, b + kSides});
    }
  }
  normalizeWeights(result.weights);
  return result;
}

std::map<Index, double> weightsOf(const Tube& tube, Index v) {
  std::map<Index, double> result;
  for (Index s = 0; s < tube.weights.slots; ++s) result[tube.weights.jointsOf(v)[s]] += tube.weights.weightsOf(v)[s];
  return result;
}

// Equations 1 and 6 of the paper, over every triangle and every ordered pair of joints.
Vec3 bruteForce(const Tube& tube, Index v) {
  std::map<Index, double> w = weightsOf(tube, v);
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  for (const Triangle& t : tube.triangles) {
    std::map<Index, double> u;
    Vec3 centroid = Vec3::Zero();
    for (const Index corner : t) {
      for (const auto& [joint, weight] : weightsOf(tube, corner)) u[joint] += weight / 3;
      centroid += tube.positions[corner].cast<double>() / 3;
    }
    const Vec3 p = tube.positions[t[0]].cast<double>();
    const double area = (tube.positions[t[1]].cast<double>() - p).cross(tube.positions[t[2]].cast<double>() - p).norm();
    for (const auto& [j, wj] : w) {
      for (const auto& [k, wk] : w) {
        if (j == k) continue;
        const double unlike = (wj * u[k] - wk * u[j]) / 0.1;
        const double alike = wj * wk * u[j] * u[k] * std::exp(-unlike * unlike);
        mass += alike * area;
        moment += alike * area * centroid;
      }
    }
  }
  return moment / mass;
}

TEST(RotationCenters, AreTheSumOverAllTriangles) {
  const Tube t = tube();
  const std::vector<Vec3f> centers = rotationCenters(t.positions, t.triangles, t.weights);
  for (Index v = 0; v < t.positions.size(); v += 7) {
    EXPECT_LT((centers[v].cast<double>() - bruteForce(t, v)).norm(), 2e-3) << v;
  }
}

TEST(RotationCenters, LieOnTheAxisOfATube) {
  const Tube t = tube();
  for (const Vec3f& c : rotationCenters(t.positions, t.triangles, t.weights)) EXPECT_LT(std::hypot(c.y(), c.z()), 1e-5);
}

TEST(RotationCenters, VertexOfOneJointIsItsOwn) {
  Tube t = tube();
  for (Index v = 0; v < t.positions.size(); ++v) {
    for (Index s = 0; s < 3; ++s) t.weights.weights[3 * v + s] = s == v % 3 ? 1.0f : 0.0f;
  }
  EXPECT_EQ(rotationCenters(t.positions, t.triangles, t.weights), t.positions);
  EXPECT_EQ(rotationCenters(t.positions, {}, tube().weights), t.positions);
}

TEST(RotationCenters, ThreadsDoNotChangeABit) {
  const Tube t = tube();
  setThreadCount(1);
  const std::vector<Vec3f> one = rotationCenters(t.positions, t.triangles, t.weights);
  setThreadCount(3);
  EXPECT_EQ(rotationCenters(t.positions, t.triangles, t.weights), one);
  setThreadCount(0);
}

TEST(RotationCenters, RefuseWhatDoesNotFit) {
  Tube t = tube();
  t.triangles.push_back({0, 1, static_cast<Index>(t.positions.size())});
  EXPECT_THROW(rotationCenters(t.positions, t.triangles, t.weights), Error);
  t.triangles.pop_back();
  t.positions.pop_back();
  EXPECT_THROW(rotationCenters(t.positions, {}, t.weights), Error);
}

std::vector<Vec3f> deformed(const Tube& t, const char* name, const Quat& turn) {
  const Affine identity = Affine::Identity(), turned(turn);
  const std::vector<Affine> transforms = {identity, turned, turned};
  const Deformer& deformer = findDeformer(name);
  const auto prepared = prepareDeformer(deformer, {t.positions, t.triangles, t.weights}, 3);
  std::vector<float> scratch(deformer.scratchSize(t.positions.size(), 3));
  std::vector<Vec3f> out(t.positions.size());
  deformer.deform({t.positions, {}, t.weights, transforms, {}, prepared.get()}, {out, {}}, scratch);
  return out;
}

// The thinnest and the widest ring, by the mean distance of its vertices from its middle.
std::pair<double, double> radii(const std::vector<Vec3f>& positions) {
  double least = 1e9, most = 0;
  for (Index ring = 0; ring < kRings; ++ring) {
    Vec3 middle = Vec3::Zero();
    for (Index s = 0; s < kSides; ++s) middle += positions[ring * kSides + s].cast<double>() / kSides;
    double radius = 0;
    for (Index s = 0; s < kSides; ++s) radius += (positions[ring * kSides + s].cast<double>() - middle).norm() / kSides;
    least = std::min(least, radius);
    most = std::max(most, radius);
  }
  return {least, most};
}

// Table 1 of the paper: linear blend collapses where it twists, dual quaternions bulge where they bend, this neither.
TEST(RotationCenters, NeitherCollapseNorBulge) {
  const Tube t = tube();
  const Quat twist(Eigen::AngleAxisd(2.5, Vec3::UnitX())), bend(Eigen::AngleAxisd(2.0, Vec3::UnitZ()));
  const auto [twisted, wide] = radii(deformed(t, "centers-of-rotation", twist));
  EXPECT_NEAR(twisted, 0.3, 1e-3);
  EXPECT_NEAR(wide, 0.3, 1e-3);
  EXPECT_LT(radii(deformed(t, "linear-blend", twist)).first, 0.15);

  const auto [thin, bulged] = radii(deformed(t, "centers-of-rotation", bend));
  EXPECT_NEAR(thin, 0.3, 1e-3);
  EXPECT_NEAR(bulged, 0.3, 1e-3);
  EXPECT_LT(radii(deformed(t, "linear-blend", bend)).first, 0.25);
}

}  // namespace
}  // namespace limber
