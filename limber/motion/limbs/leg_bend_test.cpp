#include "limber/motion/limbs/leg_bend.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

// Where the leg's paw is `raised` above its position in rest pose: how far the other's reaches, over the whole of its
// bones.
double reachOf(const Skeleton& one, const Skeleton& other, double raised) {
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  const AnimalLeg& leg = setup.animalLegs.front();
  BodyFrame frame;
  setup.sourceKinematics.globals(restPose(one), frame);
  frame.positions[leg.source.end].y() += raised;
  const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
  const double bones =
      (rest[leg.target.lower] - rest[leg.target.upper]).norm() + (rest[leg.target.end] - rest[leg.target.lower]).norm();
  return LegBend(setup, leg.source, leg.target).reach(frame) / bones;
}

// Its knees are so far ahead of the line from hip to paw.
Skeleton crouching(double ahead) {
  Skeleton animal = quadruped(0.5);
  for (Joint& joint : animal.joints) {
    if (joint.name.ends_with("Two")) joint.rest.translation.z() += ahead;
    if (joint.name.ends_with("Three")) joint.rest.translation.z() -= ahead;
  }
  return animal;
}

TEST(LegBend, LegsOfAnySizeBendAsTheSources) {
  const Skeleton animal = crouching(0.2);
  const double raised = 0.3, bones = 2 * std::hypot(0.45, 0.22);
  EXPECT_NEAR(reachOf(animal, limber::testing::scaled(animal, 2), raised), (0.9 - raised) / bones, 5e-3);
}

TEST(LegBend, WhatStandsStraighterBendsFromThere) {
  EXPECT_NEAR(reachOf(crouching(0.3), crouching(0.1), 0), 0.45 / std::hypot(0.45, 0.12), 1e-3) << "at rest";
  const auto counted = [](double angle) { return std::hypot(2 * angle, 0.5); };  // of a knee between two equal bones
  const double one = std::atan2(0.32, 0.45), other = std::atan2(0.12, 0.45);
  const double bend = std::acos((0.9 - 0.2) / (2 * std::hypot(0.45, 0.32)));
  const double bent = counted(other) + counted(bend) - counted(one);
  EXPECT_NEAR(reachOf(crouching(0.3), crouching(0.1), 0.2), std::cos(0.5 * std::sqrt(bent * bent - 0.25)), 2e-3);
}

// Short and long bones: the knee bends as far, not the ends come as near to each other.
TEST(LegBend, KneesBendAlikeWhateverTheirBones) {
  const double knee = std::acos(0.7 / 0.9);  // each bone against the line, of two that are equal
  const double first = 0.9 * 0.3, second = 0.9 * 0.7;
  const double reach = std::sqrt(first * first + second * second + 2 * first * second * std::cos(2 * knee));
  EXPECT_NEAR(reachOf(quadruped(0.5), quadruped(0.3), 0.2), reach / 0.9, 0.01);
}

TEST(LegBend, OverstretchedLegsGoOnWithoutAKink) {
  const Skeleton animal = quadruped(0.5), other = quadruped(0.4);
  const auto slope = [&](double raised) {
    return (reachOf(animal, other, raised + 1e-4) - reachOf(animal, other, raised)) / 1e-4;
  };
  for (double raised = -0.05; raised < 0.05; raised += 1e-4) EXPECT_NEAR(slope(raised + 1e-4), slope(raised), 0.05);
}

TEST(LegBend, NoLegReachesFurtherThanItsBonesOrIsFolded) {
  const double stretched = reachOf(crouching(0.3), crouching(0.05), -0.5);
  EXPECT_LT(stretched, 1);
  EXPECT_GT(stretched, 0.999);
  EXPECT_GT(reachOf(crouching(0.05), crouching(0.3), 0.9), 0.1);
}

}  // namespace
}  // namespace limber
