#include "limber/matching/animal_map.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

// Hips at b0; a trunk, a neck and a tail of so many joints, called spine1 to spineN along both trunk and neck.
Skeleton animal(int trunk, int neck, int tail) {
  const Skeleton simple = quadruped(0.5);
  Skeleton made;
  const auto add = [&](const std::string& name, const std::string& parent, const Vec3& offset) {
    limber::testing::addJoint(made, name, parent, offset);
  };
  const auto chain = [&](const std::string& stem, int first, int count, std::string parent, const Vec3& way) {
    for (int i = first; i < first + count; ++i) {
      add(stem + std::to_string(i), parent, way / count);
      parent = stem + std::to_string(i);
    }
    return parent;
  };
  made.joints.push_back(simple.joints[0]);
  const std::string chest = chain("spine", 1, trunk, "b0", Vec3(0, 0, 0.8));
  const std::string throat = chain("spine", trunk + 1, neck, chest, Vec3(0, 0.3, 0.3));
  add("Head", throat, Vec3(0, 0.1, 0.1));
  chain("tail", 1, tail, "b0", Vec3(0, -0.2, -0.7));
  for (const Joint& joint : simple.joints) {
    const std::string side = joint.name.substr(0, 2);
    if (!joint.name.ends_with("One") && !joint.name.ends_with("Two") && !joint.name.ends_with("Three")) continue;
    const std::string parent = simple.joints[joint.parent.value()].name;
    add(joint.name, parent == "b1" ? chest : parent, joint.rest.translation);
  }
  return made;
}

std::vector<std::string> names(const Skeleton& skeleton, const std::vector<Index>& joints) {
  std::vector<std::string> all;
  for (const Index joint : joints) all.push_back(skeleton.joints[joint].name);
  return all;
}

using Names = std::vector<std::string>;

TEST(AnimalMap, MatchesTrunkNeckAndTailAlongTheirChains) {
  const Skeleton one = animal(4, 2, 3), other = animal(2, 3, 3);
  const SkeletonMap map = matchSkeletons(one, other);
  const JointMatch *trunk = map.find("trunk"), *neck = map.find("neck");
  ASSERT_TRUE(trunk && neck);
  EXPECT_EQ(names(one, trunk->source), (Names{"spine1", "spine2", "spine3", "spine4"}));
  EXPECT_EQ(names(other, trunk->target), (Names{"spine1", "spine2"}));
  EXPECT_EQ(names(one, neck->source), (Names{"spine5", "spine6"}));
  EXPECT_EQ(names(other, neck->target), (Names{"spine3", "spine4", "spine5"}));
  EXPECT_EQ(trunk->by, MatchedBy::kShape);
  for (const char* joint : {"tail1", "tail3", "Head", "b1LeftOne"}) {
    const JointMatch* match = map.find(joint);
    ASSERT_TRUE(match) << joint;
    EXPECT_EQ(names(one, match->source), Names{joint});
  }
  EXPECT_NO_THROW(checkSkeletonMap(map, one, other));
  for (std::size_t i = 1; i < map.matches.size(); ++i) {
    EXPECT_LT(map.matches[i - 1].target.front(), map.matches[i].target.front());
  }
}

// By their names neck joints would go with each other: spine4 with spine4.
TEST(AnimalMap, PairsJointsOfChainsThatHaveAsMany) {
  const Skeleton one = animal(3, 2, 2), other = animal(2, 2, 5);
  const SkeletonMap map = matchSkeletons(one, other);
  ASSERT_TRUE(map.find("spine3"));
  EXPECT_EQ(names(one, map.find("spine3")->source), Names{"spine4"});
  EXPECT_EQ(map.find("tail")->target.size(), 5u);
}

TEST(AnimalMap, LeavesNamesWhereChainsAreAlike) {
  const Skeleton one = animal(3, 2, 4);
  Skeleton other = one;
  for (Joint& joint : other.joints) joint.rest.translation *= 2;
  for (const JointMatch& match : matchSkeletons(one, other).matches) {
    EXPECT_EQ(names(one, match.source), Names{match.part});
    EXPECT_EQ(names(other, match.target), Names{match.part});
  }
}

// A bent chest of a long trunk is one of a short trunk, too.
TEST(AnimalMap, ChestsTurnAlike) {
  const Skeleton one = animal(4, 2, 3), other = animal(2, 3, 3);
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

// Forelegs that stick out forward are none.
TEST(AnimalMap, NeedsFourLegs) {
  Skeleton one = animal(4, 2, 3), other = animal(2, 3, 3);
  for (Skeleton* skeleton : {&one, &other}) {
    for (Joint& joint : skeleton->joints) {
      if (joint.name.starts_with("b1") && !joint.name.ends_with("One")) joint.rest.translation = Vec3(0, 0, 0.3);
    }
  }
  EXPECT_FALSE(matchSkeletons(one, other).find("trunk"));
}

}  // namespace
}  // namespace limber
