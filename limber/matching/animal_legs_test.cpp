#include "limber/matching/animal_legs.h"

#include <gtest/gtest.h>

#include <string>

#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

// It sways forward and back over its paws, which stand still.
PoseSequence swaying(const Skeleton& animal) {
  PoseSequence motion{{}, 1.0 / 60};
  for (int f = 0; f < 120; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(animal));
    const double angle = 20 * std::sin(0.05 * f);
    for (const Joint& joint : animal.joints) {
      const Quat lean = limber::testing::turn(Vec3::UnitX(), angle);
      const Index j = animal.find(joint.name).value();
      if (joint.name.ends_with("One")) pose.locals[j].rotation = lean;
      if (joint.name.ends_with("Three")) pose.locals[j].rotation = lean.conjugate();
    }
    const Index paw = animal.find("b0LeftThree").value();
    pose.locals[0].translation += restGlobals(animal)[paw].translation() - poseGlobals(animal, pose)[paw].translation();
  }
  return motion;
}

TEST(AnimalLegs, AreThoseThatComeDownToTheGround) {
  const Skeleton one = quadruped(0.5), other = quadruped(0.35);
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  for (const AnimalLeg& leg : setup.animalLegs) {
    const std::string upper = other.joints[leg.target.upper].name, stem = upper.substr(0, upper.find("One"));
    EXPECT_EQ(upper, stem + "One");
    EXPECT_EQ(leg.target.lower, other.find(stem + "Two"));
    EXPECT_EQ(leg.target.end, other.find(stem + "Three"));
    EXPECT_EQ(leg.target.toes, other.find(stem + "Four"));
    EXPECT_FALSE(leg.target.hock);
    EXPECT_EQ(one.joints[leg.source.lower].name, stem + "Two");
  }
}

// Wings ten times as long as the legs do not make it lie.
TEST(AnimalLegs, StandUnderLongWings) {
  Skeleton winged = quadruped(0.5);
  for (const double side : {1.0, -1.0}) {
    const std::string wing = side > 0 ? "leftWing" : "rightWing";
    limber::testing::addJoint(winged, wing + "One", "b1", Vec3(0.2 * side, 0, 0));
    limber::testing::addJoint(winged, wing + "Two", wing + "One", Vec3(10 * side, 0, 0));
  }
  EXPECT_EQ(RetargetSetup(winged, winged, matchSkeletons(winged, winged), {}).animalLegs.size(), 4u);
}

// The body sways over paws that stand on a root of their own: they stand in the result, and the shins end at them.
TEST(AnimalLegs, ReachPawsOnARootOfTheirOwn) {
  const std::vector<std::string> paws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};
  const Skeleton one = limber::testing::onTheGround(quadruped(0.5), paws),
                 other = limber::testing::onTheGround(quadruped(0.45), paws);
  PoseSequence motion{{}, 1.0 / 60};
  for (int f = 0; f < 120; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    pose.locals[one.find("b0").value()].translation += Vec3(0, -0.1, 0.1 * std::sin(0.1 * f));
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  const std::vector<Affine> rest = restGlobals(other);
  for (const char* method : {"limb-ik", "online", "spacetime"}) {
    SCOPED_TRACE(method);
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    const std::vector<Affine> first = poseGlobals(other, result.poses.front());
    for (const Pose& pose : result.poses) {
      const std::vector<Affine> globals = poseGlobals(other, pose);
      for (const AnimalLeg& leg : setup.animalLegs) {
        const auto shin = [&](const std::vector<Affine>& at) {
          return (at[leg.target.end].translation() - at[leg.target.carrier.value()].translation()).norm();
        };
        EXPECT_NEAR(shin(globals), shin(rest), 1e-6);
        EXPECT_LT((globals[leg.target.end].translation() - first[leg.target.end].translation()).norm(), 1e-3);
      }
    }
  }
}

// One paw on a root of its own is lifted at once: it rises in the result as it does, scaled, and the others stay.
TEST(AnimalLegs, LiftedPawsOnRootsOfTheirOwnGoTheirOwnWay) {
  const std::vector<std::string> paws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};
  const Skeleton one = limber::testing::onTheGround(quadruped(0.5), paws),
                 other = limber::testing::onTheGround(quadruped(0.45), paws);
  const Index lifted = one.find("b1LeftThree").value(), stays = one.find("b0LeftThree").value();
  const auto lift = [](std::size_t f) { return 0.03 * static_cast<double>(f > 20 ? f - 20 : 0); };
  PoseSequence motion{{}, 1.0 / 30};
  for (std::size_t f = 0; f < 28; ++f) {
    motion.poses.push_back(restPose(one));
    motion.poses.back().locals[lifted].translation.y() += lift(f);
  }
  RetargetOptions options;
  options.evenOut = false;  // which would make it rise more smoothly
  const RetargetSetup setup(one, other, matchSkeletons(one, other), options, &motion);
  for (const char* method : {"limb-ik", "online", "spacetime"}) {
    SCOPED_TRACE(method);
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    const auto height = [&](std::size_t f, Index paw) {
      return poseGlobals(other, result.poses[f])[paw].translation().y();
    };
    for (std::size_t f = 21; f < 28; ++f) {
      EXPECT_NEAR(height(f, lifted) - height(15, lifted), setup.scale * lift(f), 0.015) << f;
      EXPECT_NEAR(height(f, stays), height(15, stays), 0.005) << f;
    }
  }
}

// A body that comes down further than its legs fold: it stays as high as they need, and paws where they stand.
TEST(AnimalLegs, BodiesComeDownAsFarAsTheirLegsFold) {
  const std::vector<std::string> paws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};
  const Skeleton one = limber::testing::onTheGround(quadruped(0.5), paws),
                 other = limber::testing::onTheGround(quadruped(0.75), paws);
  PoseSequence motion{{}, 1.0 / 60};
  for (int f = 0; f < 60; ++f) {
    motion.poses.push_back(restPose(one));
    motion.poses.back().locals[one.find("b0").value()].translation.y() -= 0.01 * f;
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, motion);
  const std::vector<Affine> first = poseGlobals(other, result.poses.front()),
                            last = poseGlobals(other, result.poses.back());
  for (const AnimalLeg& leg : setup.animalLegs) {
    EXPECT_LT((last[leg.target.end].translation() - first[leg.target.end].translation()).norm(), 0.02);
  }
}

// A neck held higher makes nobody step further.
TEST(AnimalLegs, TheRootsWayScalesWithThem) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = quadruped(0.35);
  const Index body = *other.joints[other.find("b0LeftOne").value()].parent;
  Joint head;
  head.name = "head";
  head.parent = body;
  head.rest.translation = Vec3(0, 0.3, 0.2);
  Skeleton one2 = one;
  one2.joints.push_back(head);
  head.rest.translation.y() = 1;
  other.joints.push_back(head);
  const RetargetSetup setup(one2, other, matchSkeletons(one2, other), {});
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  const auto hip = [](const Skeleton& animal) {
    const std::vector<Affine> globals = restGlobals(animal);
    double low = HUGE_VAL;
    for (const Affine& global : globals) low = std::min(low, global.translation().y());
    return globals[animal.find("b0LeftOne").value()].translation().y() - low;
  };
  EXPECT_NEAR(setup.scale, hip(other) / hip(one2), 1e-9);
}

TEST(AnimalLegs, LyingAndLeglessOnesHaveNone) {
  const Skeleton one = straightChain(8, 2);
  Skeleton snake = one;
  for (Joint& joint : snake.joints) joint.rest.translation = Vec3(0, 0, joint.rest.translation.y());
  EXPECT_TRUE(RetargetSetup(snake, snake, matchSkeletons(snake, snake), {}).animalLegs.empty());
}

TEST(AnimalLegs, PlantedPawsStandStill) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = quadruped(0.35);
  for (Joint& joint : other.joints) {
    if (joint.name.ends_with("Two")) joint.rest.translation.y() -= 0.2;
  }
  const PoseSequence motion = swaying(one);
  RetargetOptions options;
  options.rootScale = RootScale::kNone;  // a way too short for these legs
  const RetargetSetup setup(one, other, matchSkeletons(one, other), options, &motion);
  const auto way = [&](const char* method) {
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    double sum = 0;
    for (std::size_t f = 11; f < result.poses.size(); ++f) {
      const std::vector<Affine> before = poseGlobals(other, result.poses[f - 1]),
                                now = poseGlobals(other, result.poses[f]);
      for (const AnimalLeg& leg : setup.animalLegs) {
        sum += (now[leg.target.end].translation() - before[leg.target.end].translation()).norm();
      }
    }
    return sum;
  };
  EXPECT_GT(way("aligned"), 0.04);
  for (const char* method : {"limb-ik", "online"}) EXPECT_LT(way(method), 0.02 * way("aligned")) << method;
}

}  // namespace
}  // namespace limber
