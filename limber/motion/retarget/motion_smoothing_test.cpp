#include "limber/motion/retarget/motion_smoothing.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/roughness.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::quadruped;
using limber::testing::turn;
using limber::testing::walk;

using Positions = std::vector<std::vector<Vec3>>;  // of each frame, #J

struct Case {
  Case(Skeleton from, Skeleton to, const PoseSequence& moves)
      : source(std::move(from)), target(std::move(to)), motion(moves), setup(made()) {
    result = retargetFrames(findRetargetMethod("limb-ik"), setup, motion);
  }

  RetargetSetup made() const {
    RetargetOptions options;
    options.smoothMotion = false;
    return {source, target, matchSkeletons(source, target), options, &motion};
  }
  Positions positionsOf(const PoseSequence& frames) const {
    Positions positions;
    BodyFrame frame;
    for (const Pose& pose : frames.poses) {
      setup.targetKinematics.globals(pose, frame);
      positions.push_back(frame.positions);
    }
    return positions;
  }
  double jerk(const PoseSequence& frames, std::size_t begin = 3) const {
    const std::vector<bool> cuts(motion.poses.size());
    BodyPaths from(setup, MapSide::kSource), to(setup, MapSide::kTarget);
    BodyFrame frame;
    for (const Pose& pose : motion.poses) {
      setup.sourceKinematics.globals(pose, frame);
      from.add(frame.positions);
    }
    for (const std::vector<Vec3>& positions : positionsOf(frames)) to.add(positions);
    return jerkRatio(squaredJerk(from.paths(), cuts, begin, cuts.size()),
                     squaredJerk(to.paths(), cuts, begin, cuts.size()), cuts.size() - begin);
  }
  // Bends one limb at once, for three frames.
  PoseSequence jolted(const char* joint, std::size_t at, double degrees = 12) const {
    PoseSequence rough = result;
    for (std::size_t f = at; f < at + 3; ++f) {
      Quat& rotation = rough.poses[f].locals[target.find(joint).value()].rotation;
      rotation = turn(Vec3::UnitX(), degrees) * rotation;
    }
    return rough;
  }
  PoseSequence smoothed(PoseSequence frames) const {
    smoothMotion(setup, motion, frames);
    return frames;
  }

  Skeleton source, target;
  PoseSequence motion;
  RetargetSetup setup;
  PoseSequence result;
};

bool areEqual(const PoseSequence& one, const PoseSequence& other, std::size_t f) {
  for (std::size_t j = 0; j < one.poses[f].locals.size(); ++j) {
    const Transform &a = one.poses[f].locals[j], &b = other.poses[f].locals[j];
    if (a.rotation.coeffs() != b.rotation.coeffs() || a.translation != b.translation) return false;
  }
  return true;
}

double furthestOf(const Case& made, const PoseSequence& one, const PoseSequence& other, const char* joint,
                  std::size_t begin, std::size_t end) {
  const Index index = made.target.find(joint).value();
  const Positions a = made.positionsOf(one), b = made.positionsOf(other);
  double most = 0;
  for (std::size_t f = begin; f < end; ++f) most = std::max(most, (a[f][index] - b[f][index]).norm());
  return most;
}

TEST(MotionSmoothing, WhatIsSmoothStaysAsItIs) {
  const Case person(practiceHumanoid(), oddlyBuilt(), walk(practiceHumanoid()));
  ASSERT_LT(person.jerk(person.result), 1.08);
  const PoseSequence smoothed = person.smoothed(person.result);
  for (std::size_t f = 0; f < smoothed.poses.size(); ++f) ASSERT_TRUE(areEqual(smoothed, person.result, f)) << f;
}

// The right foot is planted up to frame 15 and from 45 to 75; the left one is lifted then.
TEST(MotionSmoothing, ASwingingLegThatJerksMovesAsSmoothlyAsTheSource) {
  const Case person(practiceHumanoid(), oddlyBuilt(), walk(practiceHumanoid()));
  const PoseSequence rough = person.jolted("leftUpperLeg", 58);
  ASSERT_GT(person.jerk(rough), 1.3);
  const PoseSequence smoothed = person.smoothed(rough);
  EXPECT_LT(person.jerk(smoothed), 1.08);
  const double jolt = furthestOf(person, rough, person.result, "leftFoot", 58, 61);
  EXPECT_LT(furthestOf(person, smoothed, person.result, "leftFoot", 50, 70), jolt);
  EXPECT_LT(furthestOf(person, smoothed, rough, "rightFoot", 47, 74), 0.002) << "it stands";
  EXPECT_LT(furthestOf(person, smoothed, rough, "leftFoot", 80, 100), 0.01) << "long after it";
}

TEST(MotionSmoothing, FeetStayAboveTheGround) {
  const Case person(practiceHumanoid(), oddlyBuilt(), walk(practiceHumanoid()));
  // Up at once, as it is about to come down.
  const PoseSequence smoothed = person.smoothed(person.jolted("leftLowerLeg", 70, 25));
  const auto lowest = [&](const PoseSequence& frames) {
    double low = 1;
    for (const auto& positions : person.positionsOf(frames)) {
      for (const char* joint : {"leftFoot", "rightFoot"}) {
        low = std::min(low, positions[person.target.find(joint).value()].y());
      }
    }
    return low;
  };
  EXPECT_GT(lowest(smoothed), lowest(person.result) - 1e-3);
}

PoseSequence steppingOnTheSpot(const Skeleton& animal) {
  PoseSequence motion;
  for (int f = 0; f <= 60; ++f) {
    Pose pose = restPose(animal);
    const double phase = 2 * kPi * f / 30;
    for (const char* leg : {"b0Left", "b1Right"}) {
      const double lift = 25 * std::max(0.0, std::sin(phase));
      pose.locals[animal.find(std::string(leg) + "One").value()].rotation = turn(-Vec3::UnitX(), lift);
      pose.locals[animal.find(std::string(leg) + "Two").value()].rotation = turn(Vec3::UnitX(), 2 * lift);
    }
    motion.poses.push_back(pose);
  }
  return motion;
}

TEST(MotionSmoothing, AnimalsLegsAndLoops) {
  const Case animal(quadruped(0.5), quadruped(0.35), steppingOnTheSpot(quadruped(0.5)));
  ASSERT_EQ(animal.setup.animalLegs.size(), 4u);
  const PoseSequence rough = animal.jolted("b0LeftOne", 8);
  ASSERT_GT(animal.jerk(rough), 1.2);
  const PoseSequence smoothed = animal.smoothed(rough);
  EXPECT_LT(animal.jerk(smoothed), 1.08);
  EXPECT_LT(furthestOf(animal, smoothed, rough, "b1LeftThree", 0, 61), 1e-3) << "it stands all the time";
  const Index foot = animal.target.find("b0LeftThree").value();
  const Positions before = animal.positionsOf(rough), after = animal.positionsOf(smoothed);
  EXPECT_LT((after[60][foot] - after[0][foot] - (before[60][foot] - before[0][foot])).norm(), 1e-5)
      << "a loop closes as it did";
}

// In parts that join.
TEST(MotionSmoothing, LongMotions) {
  const Case person(practiceHumanoid(), oddlyBuilt(), walk(practiceHumanoid(), 2100));
  const PoseSequence rough = person.jolted("leftUpperLeg", 1018, 25);
  const PoseSequence smoothed = person.smoothed(rough);
  EXPECT_LT(person.jerk(smoothed, 703), person.jerk(rough, 703));
  for (std::size_t f = 0; f < 2100; ++f) {
    const bool ofIt = f >= 700 && f < 1400;
    ASSERT_TRUE(ofIt || areEqual(smoothed, rough, f)) << f << " is of another part";
  }
  for (const std::size_t f : {700u, 702u, 1397u, 1399u}) {
    EXPECT_LT(furthestOf(person, smoothed, rough, "leftFoot", f, f + 1), 1e-6) << f;
  }
}

TEST(MotionSmoothing, IsDoneToWholeMotionsUnlessItIsSwitchedOff) {
  const Skeleton source = quadruped(0.5), target = quadruped(0.1);
  const PoseSequence motion = steppingOnTheSpot(source);
  const auto by = [&](bool smoothMotion, bool contacts, const char* method) {
    RetargetOptions options;
    options.smoothMotion = smoothMotion;
    options.contacts = contacts;
    const RetargetSetup setup(source, target, matchSkeletons(source, target), options, &motion);
    PoseSequence frames = retargetFrames(findRetargetMethod(method), setup, motion);
    PoseSequence again = frames;
    limber::smoothMotion(setup, motion, again);
    bool same = true;
    for (std::size_t f = 0; f < frames.poses.size(); ++f) same = same && areEqual(frames, again, f);
    return same;
  };
  EXPECT_FALSE(by(false, true, "limb-ik")) << "a motion that is rough without it";
  for (const char* method : {"limb-ik", "spacetime"}) EXPECT_TRUE(by(true, true, method)) << method;
}

TEST(MotionSmoothing, FewFramesAndNoLegsAreLeftAlone) {
  const Case person(practiceHumanoid(), oddlyBuilt(), walk(practiceHumanoid(), 4));
  PoseSequence frames = person.result;
  smoothMotion(person.setup, person.motion, frames);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_TRUE(areEqual(frames, person.result, f));
}

}  // namespace
}  // namespace limber
