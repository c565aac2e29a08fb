// Weights as vertex attributes of a primitive.
#pragma once

#include <span>

#include "limber/document/scene/geometry.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

inline constexpr Index kMaxSkinJoints = 65536;  // of one skin: joint indices are unsigned shorts

// New accessors for the weights of source's range of `weights`: JOINTS_0 and WEIGHTS_0, with JOINTS_1 and WEIGHTS_1
// where a vertex has more than four influences.
//
// skinJointOf   #J, joint of `weights` -> index into the skin's joints; kNoIndex where the skin lacks it (then no
// vertex
//               of the range may use it)
// Joint indices are unsigned bytes where the skin has at most 256 joints, else unsigned shorts. Weights are floats that
// sum to 1 in the order stored; an unused slot is joint 0 with weight 0.
// Throws Error kBadArgument for weights that are negative, not finite or all zero.
gltf::Attributes addWeightAccessors(Asset& asset, const PrimitiveInstance& source, const SkinWeights& weights,
                                    std::span<const Index> skinJointOf, Index skinJointCount);

// The same, written to a primitive to replace its weights.
struct AttributeTarget {
  Index mesh = 0, primitive = 0;
};
void writeWeightAttributes(Asset& asset, AttributeTarget target, const PrimitiveInstance& source,
                           const SkinWeights& weights, std::span<const Index> skinJointOf, Index skinJointCount);

// The joint sets of one primitive, JOINTS_0 with WEIGHTS_0 and so on: four joints of the skin and four weights for each
// vertex, as stored.
struct InfluenceSet {
  std::vector<Index> joints;
  std::vector<float> weights;
};
std::vector<InfluenceSet> readInfluenceSets(const Asset& asset, const gltf::Primitive& primitive);

// Reports a skinned primitive whose vertices have more joints than the eight of SkinWeights (`many-influences`).
void reportLostInfluences(const gltf::Primitive& primitive, const std::string& mesh, Warnings& warnings);

// Takes every JOINTS_n and WEIGHTS_n out of a primitive.
void eraseWeightAttributes(gltf::Primitive& primitive);

}  // namespace limber
