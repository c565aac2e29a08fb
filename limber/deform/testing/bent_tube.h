// Bound surfaces that tests of deformers bend. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "limber/core/random.h"
#include "limber/deform/deformer.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber::testing {

struct BoundMesh {
  TriMesh mesh;
  SkinWeights weights;
  std::vector<Affine> transforms;

  Index jointCount() const { return static_cast<Index>(transforms.size()); }
  BoundSurface surface() const { return {mesh.positions, mesh.triangles, weights}; }

  std::vector<Vec3f> deformed(const Deformer& deformer, const DeformPreparation* preparation) const {
    std::vector<float> scratch(deformer.scratchSize(mesh.positions.size(), jointCount()));
    std::vector<Vec3f> out(mesh.positions.size());
    deformer.deform({mesh.positions, {}, weights, transforms, {}, preparation}, {out, {}}, scratch);
    return out;
  }
  std::vector<Vec3f> deformed(std::string_view name) const {
    const Deformer& deformer = findDeformer(name);
    return deformed(deformer, prepareDeformer(deformer, surface(), jointCount()).get());
  }
};

// A tube of radius 0.1 about x from -0.5 to 0.5, bound to one joint left of 0 and to the other right of it, over a ramp
// that is `soft` wide; the right one turned about 0.
inline BoundMesh bentTube(int around, int rings, double soft, const Quat& turn) {
  BoundMesh result;
  result.mesh = tube(around, rings, true);
  result.weights.slots = 2;
  for (const Vec3f& p : result.mesh.positions) {
    const double ramp = 0.5 + static_cast<double>(p.x()) / std::max(soft, 1e-9);
    const float right = static_cast<float>(std::clamp(ramp, 0.0, 1.0));
    const bool rightFirst = right > 0.5f;
    result.weights.joints.insert(result.weights.joints.end(), {rightFirst ? 1u : 0u, rightFirst ? 0u : 1u});
    result.weights.weights.push_back(rightFirst ? right : 1 - right);
    result.weights.weights.push_back(rightFirst ? 1 - right : right);
  }
  result.transforms = {Affine::Identity(), Affine(turn)};
  return result;
}

// Any mesh bound to four joints at random, which move apart from one another.
inline BoundMesh boundAtRandom(TriMesh mesh, double maxAngle = 1.5) {
  Random random(11);
  const auto number = [&] { return random.uniform(-1, 1); };
  const auto vector = [&] {
    const double x = number(), y = number(), z = number();
    return Vec3(x, y, z);
  };
  BoundMesh result;
  result.mesh = std::move(mesh);
  result.weights.slots = 3;
  for (Index v = 0; v < result.mesh.vertexCount(); ++v) {
    double sum = 0, raw[3];
    for (double& w : raw) sum += w = random.uniform(0, 1);
    std::sort(raw, raw + 3, std::greater<>());
    const Index first = static_cast<Index>(random.below(4));
    for (Index i = 0; i < 3; ++i) {
      result.weights.joints.push_back((first + i) % 4);
      result.weights.weights.push_back(static_cast<float>(raw[i] / sum));
    }
  }
  for (int j = 0; j < 4; ++j) {
    const double angle = maxAngle * number();
    const Vec3 axis = vector(), offset = 0.2 * vector();
    result.transforms.push_back(Affine(Eigen::Translation3d(offset) * Eigen::AngleAxisd(angle, axis.normalized())));
  }
  return result;
}

}  // namespace limber::testing
