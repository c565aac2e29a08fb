#include "limber/character/matching/motion_bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Clip clipOf(const PoseSequence& frames) {
  Clip clip;
  std::vector<float> times;
  for (std::size_t f = 0; f < frames.poses.size(); ++f)
    times.push_back(static_cast<float>(static_cast<double>(f) * frames.frameSeconds));
  for (Index j = 0; j < frames.poses.front().locals.size(); ++j) {
    clip.translations.push_back({j, Interpolation::kLinear, times, {}});
    clip.rotations.push_back({j, Interpolation::kLinear, times, {}});
    for (const Pose& pose : frames.poses) {
      clip.translations.back().values.push_back(pose.locals[j].translation.cast<float>());
      clip.rotations.back().values.push_back(pose.locals[j].rotation.normalized().cast<float>());
    }
  }
  return clip;
}

// Skeletons side by side in one, the joints of the second with "_2" behind their names, and what walk() makes of both.
Motion together(const Skeleton& one, const PoseSequence& ofOne, Skeleton other, const PoseSequence& ofOther) {
  Motion motion;
  motion.name = "actors";
  motion.skeleton = one;
  for (Joint joint : other.joints) {
    joint.name += "_2";
    if (joint.parent) joint.parent = *joint.parent + one.jointCount();
    motion.skeleton.joints.push_back(joint);
  }
  PoseSequence both = ofOne;
  for (std::size_t f = 0; f < both.poses.size(); ++f) {
    const std::vector<Transform>& locals = ofOther.poses[f].locals;
    both.poses[f].locals.insert(both.poses[f].locals.end(), locals.begin(), locals.end());
  }
  motion.clips.push_back(clipOf(both));
  return motion;
}

PoseSequence resting(const Skeleton& skeleton, std::size_t frames) {
  PoseSequence still;
  still.poses.assign(frames, restPose(skeleton));
  still.frameSeconds = 1.0 / 60;
  return still;
}

// Both rest in one position; one walks, the other is still, a metre beside.
Motion twoActors() {
  const Skeleton person = practiceHumanoid();
  const PoseSequence walking = limber::testing::walk(person);
  PoseSequence standing = resting(person, walking.poses.size());
  for (Pose& pose : standing.poses) pose.locals[0].translation.x() += 1;
  return together(person, walking, person, standing);
}

std::string refusal(const Motion& motion, std::string_view body) {
  try {
    motionOfBody(motion, body);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MotionBodies, TwoActorsAreToldApartByTheirRootJoints) {
  const Motion motion = twoActors();
  const Index second = motion.skeleton.find("hips_2").value();
  EXPECT_THAT(bodyRoots(motion), ElementsAre(Index{0}, second));
  EXPECT_THAT(refusal(motion, ""), AllOf(HasSubstr("actors: holds 2 bodies"), HasSubstr("'hips' and 'hips_2'"),
                                         HasSubstr("--skeleton 'hips'")));
  EXPECT_THAT(refusal(motion, "pelvis"), AllOf(HasSubstr("no joint 'pelvis'"), HasSubstr("'hips' and 'hips_2'")));
  EXPECT_THAT(refusal(motion, "3"), HasSubstr("no joint '3'"));
}

TEST(MotionBodies, OneIsTakenByNameOrByNumber) {
  const Motion motion = twoActors();
  for (const char* body : {"hips_2", "2"}) {
    const Motion taken = motionOfBody(motion, body);
    checkMotion(taken);
    EXPECT_EQ(taken.skeleton.jointCount(), practiceHumanoid().jointCount());
    EXPECT_EQ(taken.skeleton.joints[0].name, "hips_2");
  }
  const Skeleton person = practiceHumanoid();
  const PoseSequence walking = limber::testing::walk(person);
  const Motion walker = motionOfBody(motion, "1");
  checkMotion(walker);
  for (std::size_t f = 0; f < walking.poses.size(); f += 20) {
    Pose pose = restPose(walker.skeleton);
    sampleClip(walker.clips[0], static_cast<double>(f) / 60, pose);
    const std::vector<Vec3> positions = posePositions(walker.skeleton, pose),
                            expected = posePositions(person, walking.poses[f]);
    for (Index j = 0; j < person.jointCount(); ++j) EXPECT_LT((positions[j] - expected[j]).norm(), 1e-5);
  }
}

TEST(MotionBodies, WhatIsAboveABodyStaysWithIt) {
  const Skeleton person = limber::testing::onTheGround(practiceHumanoid(), {});
  Motion motion;
  motion.skeleton = person;
  const Motion taken = motionOfBody(motion, "hips");
  EXPECT_EQ(taken.skeleton.joints[0].name, "ground");
  EXPECT_EQ(taken.skeleton.jointCount(), person.jointCount());
}

// A prop, feet on roots of their own, controls that the body follows: one body.
TEST(MotionBodies, OtherRootsAreNoBodies) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence walking = limber::testing::walk(person);
  const Motion controls = together(person, walking, person, walking);
  EXPECT_THAT(bodyRoots(controls), ElementsAre(Index{0}));
  EXPECT_EQ(motionOfBody(controls, "").skeleton.jointCount(), 2 * person.jointCount());

  Skeleton chain;
  for (int i = 0; i < 12; ++i) {
    limber::testing::addJoint(chain, "rope" + std::to_string(i), i > 0 ? "rope" + std::to_string(i - 1) : "",
                              Vec3(i == 0 ? 2 : 0.1, 0, 0));
  }
  const Motion roped = together(person, walking, chain, resting(chain, walking.poses.size()));
  EXPECT_THAT(bodyRoots(roped), ElementsAre(Index{0}));

  Motion one;
  one.skeleton = person;
  EXPECT_EQ(motionOfBody(one, "").skeleton.jointCount(), person.jointCount());
}

}  // namespace
}  // namespace limber
