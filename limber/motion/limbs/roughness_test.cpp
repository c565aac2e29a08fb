#include "limber/motion/limbs/roughness.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;
using limber::testing::scaled;
using limber::testing::walk;

TEST(Roughness, ThirdDifferencesAreOfWhatChangesItsAcceleration) {
  Path steady, jolt;
  for (int f = 0; f < 12; ++f) {
    steady.push_back(Vec3(1, 2 * f, 0.5 * f * f));
    jolt.push_back(steady.back() + (f == 6 ? Vec3(0.1, 0, 0) : Vec3(Vec3::Zero())));
  }
  const std::vector<bool> none(12);
  EXPECT_NEAR(squaredJerk(steady, none, 0, 12), 0, 1e-20);
  EXPECT_NEAR(squaredJerk(jolt, none, 0, 12), 0.01 * (1 + 9 + 9 + 1), 1e-12);
  EXPECT_NEAR(squaredJerk(jolt, none, 7, 9), 0.01 * (9 + 9), 1e-12) << "of those that end there";
  std::vector<bool> cuts(12);
  cuts[7] = true;
  EXPECT_NEAR(squaredJerk(jolt, cuts, 0, 12), 0.01, 1e-12) << "not across a cut";
}

TEST(Roughness, RatiosAreOfWhatMoves) {
  EXPECT_DOUBLE_EQ(jerkRatio(4, 9, 10), 1.5);
  EXPECT_EQ(jerkRatio(0, 0, 10), 1);
  EXPECT_LT(jerkRatio(0, 1e-7, 10), 10) << "hardly anything against nothing";
}

TEST(Roughness, EqualAnglesOnABodyOfAnotherSizeAreAsRough) {
  const Skeleton small = practiceHumanoid(), big = scaled(small, 3);
  const PoseSequence motion = walk(small);
  const RetargetSetup setup(small, big, matchSkeletons(small, big), {}, &motion);
  BodyPaths from(setup, MapSide::kSource), to(setup, MapSide::kTarget);
  BodyFrame frame;
  for (Pose pose : motion.poses) {
    setup.sourceKinematics.globals(pose, frame);
    from.add(frame.positions);
    for (Transform& local : pose.locals) local.translation *= 3;
    setup.targetKinematics.globals(pose, frame);
    to.add(frame.positions);
  }
  ASSERT_EQ(from.paths().size(), 1u + 4 * 2) << "the pelvis and eight bones";
  const std::vector<bool> none(motion.poses.size());
  const double source = squaredJerk(from.paths(), none, 0, none.size());
  EXPECT_GT(source, 0);
  EXPECT_NEAR(squaredJerk(to.paths(), none, 0, none.size()), source, 1e-9 * source);
}

TEST(Roughness, LimbsAreArmsAndLegsOrAnimalsLegs) {
  const Skeleton person = practiceHumanoid(), animal = quadruped(0.5);
  const auto limbs = [](const Skeleton& skeleton) {
    return limbPairs(RetargetSetup(skeleton, skeleton, matchSkeletons(skeleton, skeleton), {}));
  };
  ASSERT_EQ(limbs(person).size(), 4u);
  EXPECT_EQ(limbs(person)[2].target.front(), person.find("leftUpperLeg"));
  EXPECT_EQ(limbs(person)[2].of(MapSide::kSource).back(), person.find("leftFoot"));
  ASSERT_EQ(limbs(animal).size(), 4u);
  for (const LimbPair& limb : limbs(animal)) EXPECT_EQ(limb.source.size(), 3u);
}

// A snake's head on its neck, and its tail, which is matched as a whole, from end to end.
TEST(Roughness, WithoutLegsBonesAndChainsCount) {
  Skeleton snake;
  for (const auto& [name, parent] : {std::pair{"body", ""},
                                     {"neck", "body"},
                                     {"head", "neck"},
                                     {"tail1", "body"},
                                     {"tail2", "tail1"},
                                     {"tail3", "tail2"}}) {
    limber::testing::addJoint(snake, name, parent, Vec3(0, 0, std::string(name).starts_with("tail") ? -0.3 : 0.2));
  }
  SkeletonMap map;
  map.matches = {{body_part::kTrunk, {0}, {0}, 1, MatchedBy::kFile},
                 {body_part::kNeck, {1}, {1}, 1, MatchedBy::kFile},
                 {body_part::kHead, {2}, {2}, 1, MatchedBy::kFile},
                 {body_part::kTail, {3, 4, 5}, {3, 4, 5}, 1, MatchedBy::kFile}};
  const RetargetSetup setup(snake, snake, map, {});
  EXPECT_FALSE(hasLegs(setup));
  const std::vector<LimbPair> bones = limbPairs(setup);
  ASSERT_EQ(bones.size(), 4u);
  EXPECT_EQ(bones[1].target, (std::vector<Index>{1, 2}));
  EXPECT_EQ(bones[3].source, (std::vector<Index>{3, 5}));
  EXPECT_NEAR(standingHeight(setup, MapSide::kSource), setup.sourceHipHeight, 1e-12);
}

TEST(Roughness, NobodyIsFasterThanACut) {
  const Skeleton person = practiceHumanoid();
  const RetargetSetup setup(person, person, matchSkeletons(person, person), {});
  const double height = standingHeight(setup, MapSide::kSource);
  std::vector<Vec3> before = setup.sourceNeutral.positions, now = before;
  for (Vec3& position : now) position.x() += 0.3 * height;
  EXPECT_TRUE(isCut(setup, before, now, 1.0 / 60));
  EXPECT_FALSE(isCut(setup, before, now, 1.0 / 30));
}

}  // namespace
}  // namespace limber
