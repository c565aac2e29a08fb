#include "limber/character/matching/skeleton_matches.h"

#include <gtest/gtest.h>

#include "limber/core/parallel.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

TEST(SkeletonMatches, OtherDeclaredBonesAreAnotherSkeleton) {
  const Skeleton person = practiceHumanoid();
  Skeleton declared = person;
  declared.joints[0].declaredBone = "hips";
  SkeletonMatches matches;
  matches.match(person, person, false);
  matches.match(person, declared, false);
  EXPECT_EQ(matches.made(), 2U);
}

TEST(SkeletonMatches, AreMadeOnceForEachPairAndAsWithoutThem) {
  const Skeleton source = practiceHumanoid();
  Skeleton taller = source;
  for (Joint& joint : taller.joints) joint.rest.translation *= 1.2;
  SkeletonMatches matches;
  const SkeletonMap map = matches.match(source, taller, false);
  EXPECT_EQ(skeletonMapToJson(map, source, taller), skeletonMapToJson(matchSkeletons(source, taller), source, taller));
  matches.match(Skeleton(source), Skeleton(taller), false);  // other objects, the same content
  EXPECT_EQ(matches.made(), 1u);
  taller.joints.back().rest.translation.x() += 1e-9;
  matches.match(source, taller, false);
  matches.match(source, taller, true);
  EXPECT_EQ(matches.made(), 3u);
}

TEST(SkeletonMatches, OneReadingOfEachSkeleton) {
  Skeleton person = practiceHumanoid();
  SkeletonMatches matches;
  const SkeletonReading first = matches.reading(person);
  EXPECT_EQ(&matches.reading(Skeleton(person)).anatomy(), &first.anatomy());
  person.joints.back().rest.translation.x() += 1e-9;
  const SkeletonReading other = matches.reading(person);
  EXPECT_NE(&other.anatomy(), &first.anatomy());
}

TEST(SkeletonMatches, ReadInAnotherPoseAreAnotherMatch) {
  const Skeleton person = practiceHumanoid();
  Pose pose = restPose(person);
  SkeletonMatches matches;
  matches.match(person, person, false);
  matches.match(person, person, false, &pose);
  pose.locals[0].translation.y() += 0.1;
  matches.match(person, person, false, &pose);
  matches.match(person, person, false, &pose);
  EXPECT_EQ(matches.made(), 3u);
}

TEST(SkeletonMatches, AreMadeByOneOfManyThreads) {
  const Skeleton skeleton = practiceHumanoid();
  SkeletonMatches matches;
  parallelFor(64, 1, [&](std::size_t, std::size_t) { matches.match(skeleton, skeleton, false); });
  EXPECT_EQ(matches.made(), 1u);
}

TEST(SkeletonMatches, ForgetTheOldestOfVeryMany) {
  Skeleton source, target;
  source.joints = {{"a", {}, {}, 0}, {"b", 0, {}, 0}, {"c", 1, {}, 0}};
  for (Joint& joint : source.joints) joint.rest.translation = Vec3(0, 1, 0);
  target = source;
  SkeletonMatches matches;
  for (int i = 0; i < 300; ++i) {
    target.joints[2].rest.translation.y() = 1 + i;
    matches.match(source, target, false);
  }
  matches.match(source, target, false);
  EXPECT_EQ(matches.made(), 300u);
  target.joints[2].rest.translation.y() = 1;
  matches.match(source, target, false);
  EXPECT_EQ(matches.made(), 301u);
}

}  // namespace
}  // namespace limber
