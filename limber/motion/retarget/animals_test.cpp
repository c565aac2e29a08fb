// Animals that follow other animals by the methods that solve for feet.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::chainedAnimal;
using limber::testing::flyer;
using limber::testing::kBat;
using limber::testing::kGull;
using limber::testing::nameless;
using limber::testing::onTheGround;
using limber::testing::quadruped;
using limber::testing::withJointBefore;

const std::vector<std::string> kPaws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};

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

// The body sways over paws that stand on a root of their own: they stand in the result, and the shins end at them.
TEST(RetargetAnimals, LegsReachPawsOnARootOfTheirOwn) {
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
  for (const char* method : {"limb-ik", "spacetime"}) {
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

// The paws follow hands and feet, which have no path of their own, and so ride on the shins.
TEST(RetargetAnimals, PawsOnARootOfTheirOwnGoWithLegsThatFollowOtherLimbs) {
  const Skeleton person = practiceHumanoid(), animal = onTheGround(quadruped(0.5), kPaws);
  const PoseSequence motion = limber::testing::walk(person);
  const SkeletonMap map = matchSkeletons(person, animal, true);
  ASSERT_TRUE(map.unlikeBodies);
  const RetargetSetup setup(person, animal, map, {}, &motion);
  const auto shins = [&](const Pose& pose) {
    std::vector<double> lengths;
    for (const std::string& paw : kPaws) {
      const Index end = animal.find(paw).value(), shin = animal.find(paw.substr(0, paw.size() - 5) + "Two").value();
      const std::vector<Affine> globals = poseGlobals(animal, pose);
      lengths.push_back((globals[end].translation() - globals[shin].translation()).norm());
    }
    return lengths;
  };
  const std::vector<double> rest = shins(restPose(animal));
  for (const RetargetMethod& method : retargetMethods()) {
    SCOPED_TRACE(method.name);
    const PoseSequence result = retargetFrames(method, setup, motion);
    const Index hips = animal.find("b0").value();
    EXPECT_GT((result.poses.back().locals[hips].translation - result.poses.front().locals[hips].translation).norm(), 1);
    for (const Pose& pose : result.poses) {
      const std::vector<double> lengths = shins(pose);
      for (std::size_t paw = 0; paw < rest.size(); ++paw) ASSERT_NEAR(lengths[paw], rest[paw], 1e-6) << kPaws[paw];
    }
  }
}

// One paw on a root of its own is lifted at once: it rises in the result as it does, scaled, and the others stay.
TEST(RetargetAnimals, LiftedPawsOnRootsOfTheirOwnGoTheirOwnWay) {
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
  options.smoothMotion = false;  // which would make it rise more smoothly
  const RetargetSetup setup(one, other, matchSkeletons(one, other), options, &motion);
  for (const char* method : {"limb-ik", "spacetime"}) {
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
TEST(RetargetAnimals, BodiesComeDownAsFarAsTheirLegsFold) {
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

TEST(RetargetAnimals, PlantedPawsStandStill) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = quadruped(0.35);
  for (Joint& joint : other.joints) {
    if (joint.name.ends_with("Two")) joint.rest.translation.y() -= 0.2;
  }
  const PoseSequence motion = swaying(one);
  RetargetOptions options;
  options.rootScale = RootScale::kNone;  // a displacement too short for these legs
  const RetargetSetup setup(one, other, matchSkeletons(one, other), options, &motion);
  const auto displacement = [&](const char* method) {
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
  EXPECT_GT(displacement("aligned"), 0.04);
  EXPECT_LT(displacement("limb-ik"), 0.02 * displacement("aligned"));
}

// A body that faces elsewhere moves as it would if it did not, matched by names or by form.
TEST(RetargetAnimals, EachMovesForwardAsItSeesIt) {
  const Skeleton one = quadruped(0.5), same = quadruped(0.45), other = nameless(withJointBefore(same, "n1", "throat"));
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 20; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    pose.locals[0].translation += Vec3(0, 0.001 * f, 0.02 * f);
    for (const char* leg : {"b0LeftOne", "b1RightOne", "n0"}) {
      pose.locals[one.find(leg).value()].rotation = limber::testing::turn(-Vec3::UnitX(), 2 * f);
    }
  }
  const auto moved = [&](const Skeleton& target) {
    const RetargetSetup setup(one, target, matchSkeletons(one, target), {}, &motion);
    return poseGlobals(target, retargetFrames(findRetargetMethod("limb-ik"), setup, motion).poses.back());
  };
  for (const Skeleton& target : {same, other}) {
    for (const double degrees : {90.0, 180.0, 37.0}) {
      const Quat turn = limber::testing::turn(Vec3::UnitY(), degrees);
      Skeleton turned = target;
      Transform& root = turned.joints[0].rest;
      root = {turn * root.translation, turn * root.rotation, root.scale};
      const std::vector<Affine> there = moved(turned), here = moved(target);
      for (Index j = 0; j < target.jointCount(); ++j) {
        EXPECT_LT((there[j].translation() - turn * here[j].translation()).norm(), 1e-6) << degrees << ' ' << j;
      }
    }
  }
}

// Bodies of differing names and legs: paws stand and rise as the source's, wherever the target's hang.
TEST(RetargetAnimals, PawsGoTheSourcesWay) {
  const Skeleton one = quadruped(0.5);
  const Index lifted = one.find("b1LeftTwo").value(), upper = one.find("b1LeftOne").value();
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 40; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    const double bend = f < 15 ? 0 : 50 * (1 - std::cos(0.25 * (f - 15)));
    pose.locals[upper].rotation = limber::testing::turn(-Vec3::UnitX(), 0.5 * bend);
    pose.locals[lifted].rotation = limber::testing::turn(Vec3::UnitX(), bend);
  }
  for (const Skeleton& other : {nameless(withJointBefore(limber::testing::scaled(quadruped(0.45), 2), "n1", "throat")),
                                nameless(onTheGround(limber::testing::scaled(quadruped(0.45), 2), kPaws))}) {
    const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
    ASSERT_EQ(setup.rootFollows, RootFollows::kHindquarters);
    ASSERT_EQ(setup.animalLegs.size(), 4u);
    for (const char* method : {"limb-ik", "spacetime"}) {
      SCOPED_TRACE(method);
      const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
      for (std::size_t f = 5; f < 40; ++f) {
        const std::vector<Affine> from = poseGlobals(one, motion.poses[f]), to = poseGlobals(other, result.poses[f]);
        for (const AnimalLeg& leg : setup.animalLegs) {
          const Vec3 displacement = from[leg.source.end].translation() - restGlobals(one)[leg.source.end].translation();
          const Vec3 went = to[leg.target.end].translation() - restGlobals(other)[leg.target.end].translation();
          EXPECT_LT((went - setup.scale * displacement).norm(), leg.source.lower == lifted ? 0.2 : 0.03) << f;
        }
      }
    }
  }
}

// How far the forepaws are from below their hips, of a body whose trunk is so many times as long and that has turned
// about its hind legs.
double forepawsAside(double trunk) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = withJointBefore(quadruped(0.5), "n1", "throat");
  other.joints[other.find("b1").value()].rest.translation *= trunk;
  other = nameless(other);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 40; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    pose.locals[0].rotation = limber::testing::turn(Vec3::UnitY(), 1.5 * f);
    for (const char* paw : {"b1LeftOne", "b1RightOne"}) {  // steps all the while
      pose.locals[one.find(paw).value()].rotation = limber::testing::turn(Vec3::UnitX(), 10 * std::sin(0.9 * f));
    }
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
  const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, motion);
  const std::vector<Affine> globals = poseGlobals(other, result.poses.back());
  const AnimalLeg& fore = setup.animalLegs.back();
  const Vec3 aside = globals[fore.target.end].translation() - globals[fore.target.upper].translation();
  return std::hypot(aside.x(), aside.z());
}

TEST(RetargetAnimals, LongerTrunksTakeTheirForepawsAlong) {
  EXPECT_LT(forepawsAside(2), forepawsAside(1) + 0.3);
}

// One whose legs begin far below its trunk lies on the ground as the source does, not in it.
TEST(RetargetAnimals, BodiesLieOnTheGround) {
  const Skeleton one = quadruped(0.5);
  Skeleton deep = withJointBefore(one, "n1", "throat");
  for (Joint& joint : deep.joints) {
    if (joint.name.ends_with("One")) joint.rest.translation.y() = -0.35;
    if (joint.name.ends_with("Two")) joint.rest.translation.y() += 0.3;
  }
  const Skeleton other = nameless(deep);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 30; ++f) {
    motion.poses.push_back(restPose(one));
    motion.poses.back().locals[0].translation.y() -= 0.03 * f;
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  ASSERT_EQ(setup.rootFollows, RootFollows::kHindquarters);
  for (const char* method : {"limb-ik", "spacetime"}) {
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    const std::vector<Affine> lies = poseGlobals(other, result.poses.back());
    for (const AnimalLeg& leg : setup.animalLegs) {
      EXPECT_GT(lies[leg.target.upper].translation().y(), setup.targetGround - 0.03) << method;
    }
  }
}

// A bent chest of a long trunk is one of a short trunk, too.
TEST(RetargetAnimals, ChestsTurnAlike) {
  const Skeleton one = chainedAnimal(4, 2, 3), other = chainedAnimal(2, 3, 3);
  PoseSequence motion{{restPose(one)}, 1.0 / 30};
  for (const char* joint : {"spine1", "spine2", "spine3", "spine4"}) {
    motion.poses[0].locals[one.find(joint).value()].rotation = limber::testing::turn(Vec3::UnitY(), 20);
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, motion);
  const Quat chest(poseGlobals(other, result.poses[0])[other.find("spine2").value()].linear());
  const Quat chestOfSource(poseGlobals(one, motion.poses[0])[one.find("spine4").value()].linear());
  EXPECT_LT(chest.angularDistance(chestOfSource) * 180 / kPi, 11);
  EXPECT_GT(chest.angularDistance(Quat::Identity()) * 180 / kPi, 65);
}

// The motion of what carries the body counts, though no joint is matched with it.
TEST(RetargetAnimals, BodiesGoWhereRootsTakeThem) {
  const Skeleton gull = flyer(kGull), bat = flyer(kBat);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 10; ++f) {
    motion.poses.push_back(restPose(gull));
    motion.poses.back().locals[0].translation = Vec3(0, 0.1 * f, 0.2 * f);
    motion.poses.back().locals[gull.find("wingL1").value()].rotation = limber::testing::turn(Vec3::UnitZ(), 5.0 * f);
  }
  const RetargetSetup setup(gull, bat, matchSkeletons(gull, bat), {}, &motion);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, motion);
  const std::vector<Affine> globals = poseGlobals(bat, result.poses[9]);
  const Vec3 displacement = globals[bat.find("carrier").value()].translation() - Vec3(0, 0.5, 0);
  EXPECT_NEAR((displacement - setup.scale * Vec3(0, 0.9, 1.8)).norm(), 0, 1e-9);
  const Quat wing(globals[bat.find("Fluegel_WingL1").value()].linear());
  EXPECT_NEAR(wing.angularDistance(Quat::Identity()) * 180 / kPi, 45, 1e-6);
}

}  // namespace
}  // namespace limber
