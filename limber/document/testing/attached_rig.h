// A rig put into a document, for tests.
#pragma once

#include <string>
#include <utility>

#include "limber/document/rig/rig_io.h"

namespace limber::testing {

// Three joints in a row along x, the last one with a bend to y.
inline Skeleton threeJoints() {
  Skeleton skeleton;
  skeleton.boneShape = BoneShape::kSphere;
  const Vec3 steps[] = {{0.1, 0.2, 0.3}, {1, 0, 0}, {0.25, 0.5, 0}};
  for (Index j = 0; j < 3; ++j) {
    Joint joint;
    joint.name = std::string("handle_").append(std::to_string(j));
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = steps[j];
    joint.radius = 0.1 * (j + 1);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

// Two influences for each vertex, different from vertex to vertex.
inline SkinWeights mixedWeights(std::size_t vertices, Index joints, Index used = 2, Index slots = 4) {
  SkinWeights weights;
  weights.slots = slots;
  weights.joints.assign(vertices * slots, 0);
  weights.weights.assign(vertices * slots, 0.0f);
  for (std::size_t v = 0; v < vertices; ++v) {
    double sum = 0;
    for (Index i = 0; i < used; ++i) sum += 1.0 / (i + 1 + v % 3);
    for (Index i = 0; i < used; ++i) {
      weights.joints[v * slots + i] = static_cast<Index>((v + i) % joints);
      weights.weights[v * slots + i] = static_cast<float>(1.0 / (i + 1 + v % 3) / sum);
    }
  }
  return weights;
}

struct Attached {
  Asset before, after;
  Geometry geometry;
  SkinWeights weights;
};

inline Attached attach(Asset asset, const Skeleton& skeleton = threeJoints(), Index used = 2, Index slots = 4) {
  Attached result;
  result.before = asset.clone();
  result.geometry = collectGeometry(asset);
  result.weights = mixedWeights(result.geometry.positions.size(), skeleton.jointCount(), used, slots);
  attachRig(asset, result.geometry, skeleton, result.weights);
  checkAsset(asset);
  result.after = std::move(asset);
  return result;
}

}  // namespace limber::testing
