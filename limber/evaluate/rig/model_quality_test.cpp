// A person made of capsules, whose measures are known where nothing bends.
#include "limber/evaluate/rig/model_quality.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/evaluate/motion/body_contacts.h"
#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

// The joint of the other side; else the joint itself.
Index mirrored(const Skeleton& skeleton, Index joint) {
  const std::string& name = skeleton.joints[joint].name;
  if (name.rfind("left", 0) == 0) return skeleton.find("right" + name.substr(4)).value();
  if (name.rfind("right", 0) == 0) return skeleton.find("left" + name.substr(5)).value();
  return joint;
}

// A capsule round each bone between two joints, which follows the upper one alone.
SkinnedModel capsulePerson() {
  SkinnedModel model;
  model.skeleton = contactFigure({});
  const std::vector<Vec3> positions = restPositions(model.skeleton);
  model.weights.slots = 4;
  for (Index j = 0; j < model.skeleton.jointCount(); ++j) {
    const auto parent = model.skeleton.joints[j].parent;
    if (!parent || (positions[j] - positions[*parent]).norm() < 0.02) continue;
    // Radii differ so that no vertices of two capsules have one position, which would be welded.
    const double radius = 0.03 + 0.0001 * static_cast<double>(std::min(j, mirrored(model.skeleton, j)));
    limber::testing::addCapsule(model.mesh, positions[*parent], positions[j], radius);
    while (model.weights.vertexCount() < model.mesh.vertexCount()) {
      model.weights.joints.insert(model.weights.joints.end(), {*parent, 0, 0, 0});
      model.weights.weights.insert(model.weights.weights.end(), {1, 0, 0, 0});
    }
  }
  return model;
}

// Every vertex follows its joint by so much less, and the root by that.
SkinnedModel smeared(SkinnedModel model, float fraction) {
  for (Index v = 0; v < model.weights.vertexCount(); ++v) {
    const std::size_t first = std::size_t{v} * model.weights.slots;
    if (model.weights.joints[first] == 0) continue;
    model.weights.weights[first] = 1 - fraction * static_cast<float>(v % 2);
    model.weights.weights[first + 1] = fraction * static_cast<float>(v % 2);
  }
  return model;
}

// Measured once for all tests.
const ModelQuality& rigidQuality() {
  static const ModelQuality quality = measureModel(capsulePerson());
  return quality;
}

const ModelQuality& smearedQuality() {
  static const ModelQuality quality = measureModel(smeared(capsulePerson(), 0.2f));
  return quality;
}

std::vector<Vec2f> heightsAsCoordinates(const SkinnedModel& model) {
  std::vector<Vec2f> uvs;
  for (const Vec3f& p : model.mesh.positions) uvs.emplace_back(p.x() + p.z(), p.y());
  return uvs;
}

TEST(ModelQuality, OfRigidPartsNothingStretches) {
  const SkinnedModel model = capsulePerson();
  const ModelQuality quality = measureModel(model, heightsAsCoordinates(model));
  ASSERT_TRUE(quality.motion);
  EXPECT_GT(quality.motion->poses.size(), 8u);
  const SurfaceChange& mean = quality.motion->mean;
  EXPECT_NEAR(mean.stretch.mean, 0, 1e-4);
  EXPECT_NEAR(mean.stretch.p95, 0, 1e-4);
  EXPECT_NEAR(mean.texture.value(), 0, 1e-4);
  EXPECT_NEAR(mean.volumeLoss, 0, 1e-4);
  EXPECT_NEAR(quality.weights.islands, 0, 1e-12);
  EXPECT_EQ(quality.weights.influences, 1);
  EXPECT_EQ(quality.weights.roughness, 0);
  EXPECT_NEAR(quality.asymmetry.value(), 0, 1e-3);
  EXPECT_GT(quality.coverage.value(), 0.99);
  EXPECT_EQ(quality.placement.inside, 1);
}

TEST(ModelQuality, SmearedWeightsStretchAndAreRough) {
  const ModelQuality &rigid = rigidQuality(), &half = smearedQuality();
  const ModelQuality more = measureModel(smeared(capsulePerson(), 0.4f));
  EXPECT_GT(half.motion->mean.stretch.mean, rigid.motion->mean.stretch.mean + 0.01);
  EXPECT_GT(more.motion->mean.stretch.mean, half.motion->mean.stretch.mean);
  EXPECT_GT(more.weights.roughness, half.weights.roughness);
  EXPECT_GT(half.weights.roughness, 0.05);
  EXPECT_GT(half.weights.influences, 1.1);
  EXPECT_FALSE(rigid.motion->mean.texture);
}

TEST(ModelQuality, JointsThatMoveNothingAreIdle) {
  SkinnedModel model = capsulePerson();
  const double count = model.skeleton.jointCount(), idle = count * rigidQuality().idleJoints;
  for (int j = 0; j < 2; ++j) {
    Joint joint;
    joint.name = "helper" + std::to_string(j);
    joint.parent = model.skeleton.find("headTop_end");
    joint.rest.translation = Vec3(0, 0.1, 0);
    model.skeleton.joints.push_back(joint);
  }
  EXPECT_NEAR(measureModel(model).idleJoints, (idle + 2) / (count + 2), 1e-12);
}

// The size and the position of a model change nothing.
TEST(ModelQuality, DoesNotDependOnTheUnit) {
  SkinnedModel large = smeared(capsulePerson(), 0.2f);
  for (Vec3f& p : large.mesh.positions) p *= 128;
  for (Joint& joint : large.skeleton.joints) joint.rest.translation *= 128;
  const ModelQuality &a = smearedQuality(), b = measureModel(large);
  EXPECT_NEAR(a.motion->mean.stretch.mean, b.motion->mean.stretch.mean, 1e-4);
  EXPECT_NEAR(a.motion->mean.volumeLoss, b.motion->mean.volumeLoss, 1e-4);
  EXPECT_NEAR(a.motion->selfPenetration, b.motion->selfPenetration, 1e-3);
  EXPECT_NEAR(a.placement.offCenter, b.placement.offCenter, 1e-4);
  EXPECT_NEAR(*a.coverage, *b.coverage, 1e-3);
  EXPECT_NEAR(*a.asymmetry, *b.asymmetry, 1e-3);
}

// A tube about the vertical through the head's joint, which goes over from the neck to the head along its length.
SkinnedModel turnedNeck() {
  SkinnedModel model;
  model.skeleton = contactFigure({});
  const Index neck = model.skeleton.find("neck").value(), head = model.skeleton.find("head").value();
  const Vec3f middle = restPositions(model.skeleton)[head].cast<float>();
  model.mesh = limber::testing::tube(32, 41, true);
  model.weights.slots = 2;
  for (Vec3f& p : model.mesh.positions) {
    model.weights.joints.insert(model.weights.joints.end(), {neck, head});
    model.weights.weights.insert(model.weights.weights.end(), {0.5f - p.x(), 0.5f + p.x()});
    p = middle + Vec3f(p.z(), p.x(), p.y());
  }
  return model;
}

// Rotated by a, a ring blended with weight w has an area of 1 - 2 w (1 - w) (1 - cos a) by linear blending: a third
// of 1 - cos a is lost in the mean. By dual quaternions each ring is whole.
TEST(ModelQuality, TheDeformerDecidesHowMuchVolumeIsLost) {
  const SkinnedModel model = turnedNeck();
  const Deformer& dual = findDeformer("dual-quaternion");
  const ModelQuality byLinear = measureModel(model), byDual = measureModel(model, {}, dual);
  const auto lossOf = [](const ModelQuality& quality) {
    for (const PoseChange& one : quality.motion->poses) {
      if (one.pose == "head turned") return one.change.volumeLoss;
    }
    ADD_FAILURE();
    return 0.0;
  };
  EXPECT_NEAR(lossOf(byLinear), (1 - std::cos(30 * kDegree)) / 3, 1e-3);
  EXPECT_NEAR(lossOf(byDual), 0, 1e-3);
  EXPECT_THAT(toText(byDual), HasSubstr("by dual-quaternion"));
  Json linear = toJson(byLinear), other = toJson(byDual);
  EXPECT_EQ(linear.at("motion").at("deformer"), "linear-blend");
  EXPECT_EQ(other.at("motion").at("deformer"), "dual-quaternion");
  linear.erase("motion");
  other.erase("motion");
  EXPECT_EQ(linear, other);
}

TEST(ModelQuality, WhatDoesNotMoveHasNoMotion) {
  SkinnedModel model = capsulePerson();
  model.skeleton.joints.resize(1);
  for (Index& joint : model.weights.joints) joint = 0;
  const ModelQuality quality = measureModel(model);
  EXPECT_FALSE(quality.motion);
  EXPECT_TRUE(toJson(quality).at("motion").is_null());
  EXPECT_THAT(toText(quality), HasSubstr("no part of the body moves"));
}

TEST(ModelQuality, ABadWeightIsAnError) {
  SkinnedModel model = capsulePerson();
  model.weights.joints.front() = model.skeleton.jointCount();
  EXPECT_THROW(measureModel(model), Error);
}

TEST(ModelQuality, IsReadAsJsonAndAsText) {
  const ModelQuality& quality = rigidQuality();
  const Json json = toJson(quality);
  EXPECT_EQ(json.at("joints"), contactFigure({}).jointCount());
  EXPECT_EQ(json.at("motion").at("poses").size(), quality.motion->poses.size());
  EXPECT_TRUE(json.at("motion").at("texture_stretch").is_null());
  EXPECT_THAT(toText(quality), HasSubstr("no coordinates"));
  EXPECT_THAT(toText(quality), HasSubstr("100 % inside"));
}

}  // namespace
}  // namespace limber
