#include "limber/matching/body_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::addJoint;

// What an animal's joints are called, and how many make up its parts.
struct Build {
  const char *wing, *leg, *spine, *head, *tail;
  int spineJoints, wingJoints, tailJoints;
};
constexpr Build kGull = {"wing", "leg", "spine", "head", "tail", 4, 5, 3},
                kBat = {"Fluegel_Wing", "Hind_leg", "Rumpf", "The Head", "Schwanz", 2, 3, 4},
                kNameless = {"a", "b", "c", "d", "e", 4, 4, 3};

// Hips on a root, a trunk forward, wings to the sides at its end, legs down, a tail behind.
Skeleton flyer(const Build& build, double turn = 0) {
  Skeleton made;
  addJoint(made, "origin", "", Vec3::Zero());
  made.joints[0].rest.rotation = limber::testing::turn(Vec3::UnitY(), turn);
  addJoint(made, "carrier", "origin", Vec3(0, 0.5, 0));
  const auto chain = [&](const std::string& stem, int count, std::string parent, const Vec3& first, const Vec3& way) {
    for (int i = 1; i <= count; ++i) {
      addJoint(made, stem + std::to_string(i), parent, i == 1 ? first : Vec3(way / (count - 1)));
      parent = stem + std::to_string(i);
    }
    return parent;
  };
  const std::string chest = chain(build.spine, build.spineJoints, "carrier", Vec3(0, 0, 0.1), Vec3(0, 0.1, 0.5));
  addJoint(made, build.head, chest, Vec3(0, 0.1, 0.2));
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "L" : "R";
    chain(build.wing + name, build.wingJoints, chest, Vec3(0.1 * side, 0, 0), Vec3(1.5 * side, 0, -0.2));
    chain(build.leg + name, 3, "carrier", Vec3(0.1 * side, 0, 0), Vec3(0, -0.45, 0.05));
  }
  chain(build.tail, build.tailJoints, "carrier", Vec3(0, 0, -0.1), Vec3(0, 0, -0.5));
  return made;
}

// The part that moves that joint, and by which joint of the source.
std::string followed(const SkeletonMap& map, const Skeleton& source, const Skeleton& target, const std::string& joint) {
  for (const JointMatch& match : map.matches) {
    if (std::find(match.target.begin(), match.target.end(), target.find(joint)) != match.target.end()) {
      return source.joints[match.source.front()].name;
    }
  }
  return "";
}

TEST(BodyPlan, WingsGoWithWingsAndLegsWithLegs) {
  const Skeleton gull = flyer(kGull), bat = flyer(kBat);
  const std::optional<SkeletonMap> map = matchBodyPlans(gull, bat);
  ASSERT_TRUE(map);
  EXPECT_NO_THROW(checkSkeletonMap(*map, gull, bat));
  EXPECT_EQ(followed(*map, gull, bat, "carrier"), "carrier");
  EXPECT_EQ(followed(*map, gull, bat, "Fluegel_WingL1"), "wingL1");
  EXPECT_EQ(followed(*map, gull, bat, "Fluegel_WingR3").substr(0, 5), "wingR");
  EXPECT_EQ(followed(*map, gull, bat, "Hind_legL2"), "legL2");
  EXPECT_EQ(followed(*map, gull, bat, "Hind_legR3"), "legR3");
  EXPECT_EQ(followed(*map, gull, bat, "Rumpf1"), "spine1");
  EXPECT_EQ(followed(*map, gull, bat, "Schwanz2"), "tail1");
  for (const JointMatch& match : map->matches) EXPECT_EQ(match.by, MatchedBy::kShape);
}

TEST(BodyPlan, FormTellsWhereNamesDoNot) {
  const Skeleton gull = flyer(kGull), nameless = flyer(kNameless);
  const std::optional<SkeletonMap> map = matchBodyPlans(gull, nameless);
  ASSERT_TRUE(map);
  EXPECT_EQ(followed(*map, gull, nameless, "aL1"), "wingL1");
  EXPECT_EQ(followed(*map, gull, nameless, "bR3"), "legR3");
  EXPECT_EQ(followed(*map, gull, nameless, "e1"), "tail1");
  for (const JointMatch& match : map->matches) EXPECT_LT(match.confidence, kDoubtful) << match.part;
  const SkeletonMap chosen = matchSkeletons(gull, nameless);
  EXPECT_EQ(chosen.matches.size(), map->matches.size());
}

// Head and tail of a snake, whose joints hang on the head or on the middle.
TEST(BodyPlan, SnakesGoAlongTheirSpines) {
  Skeleton one, other;
  addJoint(one, "root", "", Vec3::Zero());
  addJoint(one, "head", "root", Vec3(0, 0.1, 0.2));
  for (int i = 1; i <= 6; ++i) {
    addJoint(one, "tail" + std::to_string(i), i > 1 ? "tail" + std::to_string(i - 1) : "head", Vec3(0, 0, -0.3));
  }
  addJoint(other, "middle", "", Vec3(0, 0.1, 0));
  addJoint(other, "neck", "middle", Vec3(0, 0.3, 0.4));
  addJoint(other, "Head", "neck", Vec3(0, 0.3, 0.1));
  for (int i = 1; i <= 3; ++i) {
    addJoint(other, "Tail" + std::to_string(i), i > 1 ? "Tail" + std::to_string(i - 1) : "middle", Vec3(0, 0, -0.4));
  }
  const std::optional<SkeletonMap> map = matchBodyPlans(one, other);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->find("trunk")->target.size(), 2u);
  EXPECT_EQ(map->find("tail")->source.size(), 6u);
  EXPECT_EQ(map->find("tail")->target.size(), 3u);
  EXPECT_EQ(followed(*map, one, other, "middle"), "root");
}

TEST(BodyPlan, WhatIsNotAlikeIsNotMatched) {
  const Skeleton gull = flyer(kGull);
  EXPECT_TRUE(matchBodyPlans(gull, flyer(kBat)));
  const auto why = [&](const Skeleton& other) {
    return matchBodyPlans(gull, other) ? "matched" : whyBodyPlansDiffer(gull, other);
  };
  EXPECT_EQ(why(flyer(kBat, 90)), "they face different ways");
  Skeleton insect = flyer(kBat);  // two more pairs of legs
  for (const char* leg : {"two", "three"}) {
    for (const double side : {1.0, -1.0}) {
      const std::string name = std::string(leg) + (side > 0 ? "L" : "R") + "leg";
      addJoint(insect, name + "1", "Rumpf1", Vec3(0.1 * side, 0, 0));
      addJoint(insect, name + "2", name + "1", Vec3(0.3 * side, -0.4, 0));
    }
  }
  EXPECT_EQ(why(insect), "the motion's has 2 pairs of limbs, the character's 4");
  Skeleton footed = flyer(kBat);  // feet on the ground that no shin comes down to
  for (const double side : {1.0, -1.0}) {
    addJoint(footed, side > 0 ? "footL" : "footR", "origin", Vec3(0.5 * side, 0, 0.5));
  }
  EXPECT_EQ(why(footed), "the character's feet hang on a root of their own, and no leg reaches them");
  Skeleton two;
  addJoint(two, "one", "", Vec3::Zero());
  addJoint(two, "two", "one", Vec3(0, 1, 0));
  EXPECT_EQ(why(two), "the character's joints show no head on a trunk");
}

// The motion of what carries the body counts, though no joint is matched with it.
TEST(BodyPlan, BodiesGoWhereRootsTakeThem) {
  const Skeleton gull = flyer(kGull), bat = flyer(kBat);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 10; ++f) {
    motion.poses.push_back(restPose(gull));
    motion.poses.back().locals[0].translation = Vec3(0, 0.1 * f, 0.2 * f);
    motion.poses.back().locals[gull.find("wingL1").value()].rotation = limber::testing::turn(Vec3::UnitZ(), 5.0 * f);
  }
  const RetargetSetup setup(gull, bat, matchBodyPlans(gull, bat).value(), {}, &motion);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, motion);
  const std::vector<Affine> globals = poseGlobals(bat, result.poses[9]);
  const Vec3 way = globals[bat.find("carrier").value()].translation() - Vec3(0, 0.5, 0);
  EXPECT_NEAR((way - setup.scale * Vec3(0, 0.9, 1.8)).norm(), 0, 1e-9);
  const Quat wing(globals[bat.find("Fluegel_WingL1").value()].linear());
  EXPECT_NEAR(wing.angularDistance(Quat::Identity()) * 180 / kPi, 45, 1e-6);
}

}  // namespace
}  // namespace limber
