#include "limber/character/matching/retarget_setup.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"

namespace limber {
namespace {

SkeletonMap mapOf(const Skeleton& source, const Skeleton& target, const std::vector<std::string>& parts) {
  SkeletonMap map;
  for (const std::string& part : parts) {
    map.matches.push_back({bodyPartNamed(part).value(), {source.find(part).value()}, {target.find(part).value()}});
  }
  return map;
}

// What is said of a map of these parts alone; nothing where it serves.
std::string refusal(const Skeleton& source, const Skeleton& target, const std::vector<std::string>& parts) {
  try {
    const RetargetSetup setup(source, target, mapOf(source, target, parts), {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RetargetSetup, AMapThatTellsNoSizeSaysWhatIsMissing) {
  const Skeleton person = practiceHumanoid();
  EXPECT_EQ(refusal(person, person, {"hips"}),
            "hips: the matched joints do not tell how large the motion's body is (match parts that lie further apart, "
            "such as hips, head and feet)");
  EXPECT_EQ(refusal(person, person, {"hips", "head"}), "");
  Skeleton folded = person;
  for (Joint& joint : folded.joints) joint.rest.translation = Vec3::Zero();
  EXPECT_EQ(refusal(person, folded, {"hips", "head"}),
            "the matched joints do not tell how large the character's body is (match parts that lie further apart, "
            "such as hips, head and feet)");
}

// A knee of the one body is no foot of the other.
TEST(RetargetSetup, LegsOfOneJointAreAsLongAsTheyAre) {
  const Skeleton person = practiceHumanoid(), kneeless = testing::without(person, {"LowerLeg", "Toes"}),
                 small = testing::scaled(kneeless, 0.5);
  const auto scaleOf = [](const Skeleton& source, const Skeleton& target) {
    const SkeletonMap map = matchSkeletons(source, target);
    EXPECT_FALSE(isSizedByTrunk(source, target, map, nullptr));
    return RetargetSetup(source, target, map, {}).scale;
  };
  EXPECT_NEAR(scaleOf(person, kneeless), 1, 0.1) << "but for the toes";
  EXPECT_NEAR(scaleOf(person, small), 0.5, 0.05);
  EXPECT_NEAR(scaleOf(small, person), 2, 0.2);
}

TEST(RetargetSetup, LegsThatEndAtTheHipsAreAsLongAsTheirSkinOrInProportion) {
  const Skeleton person = practiceHumanoid(), legless = testing::without(person, {"LowerLeg", "Foot", "Toes"}),
                 small = testing::scaled(legless, 0.5);
  const std::vector<std::string> parts = {"hips", "head", "leftUpperLeg", "rightUpperLeg"};
  const SkeletonMap map = mapOf(person, small, parts), back = mapOf(small, person, parts);
  EXPECT_TRUE(isSizedByTrunk(person, small, map, nullptr));
  EXPECT_TRUE(isSizedByTrunk(small, person, back, nullptr));
  EXPECT_NEAR(RetargetSetup(person, small, map, {}).scale, 0.5, 1e-6);
  EXPECT_NEAR(RetargetSetup(small, person, back, {}).scale, 2, 1e-6);
  EXPECT_NEAR(RetargetSetup(legless, small, mapOf(legless, small, parts), {}).scale, 0.5, 1e-6);
  // Legs twice as long as in proportion.
  const std::vector<Vec3> rest = restPositions(person);
  const double length = (rest[person.find("leftUpperLeg").value()] - rest[person.find("leftToesEnd").value()]).y();
  RetargetOptions skinned;
  skinned.skin = std::make_shared<BodySkin>(BodySkin{{Vec3(0, -length, 0)}, {small.find("leftUpperLeg").value()}});
  EXPECT_FALSE(isSizedByTrunk(person, small, map, skinned.skin.get()));
  EXPECT_NEAR(RetargetSetup(person, small, map, skinned).scale, 1, 1e-6);
}

// The origin is at the middle of the body.
TEST(RetargetSetup, ACharacterWithASurfaceStandsOnItsOwnGround) {
  const Skeleton person = practiceHumanoid();
  Skeleton low = person;
  low.joints[0].rest.translation.y() = 0;
  const SkeletonMap map = matchSkeletons(person, low);
  RetargetOptions standing;
  standing.characterOnGround = true;
  const double down = person.joints[0].rest.translation.y();
  const RetargetSetup bare(person, low, map, {}), surfaced(person, low, map, standing);
  EXPECT_NEAR(bare.targetGround, bare.sourceGround, 1e-9);
  EXPECT_NEAR(surfaced.targetGround, surfaced.sourceGround - down, 1e-9);
  const Vec3 hips(0, down, 0);
  EXPECT_NEAR(surfaced.positionOf(hips).y(), 0, 1e-9) << "one who stands is where it rests";
}

// Someone who drifts on the belly, half a metre up, moves the feet slowly; they do not stand there.
TEST(RetargetSetup, TheSameBodyIsToldByItsBones) {
  const Skeleton person = practiceHumanoid();
  const auto isSame = [&](const Skeleton& other) {
    return RetargetSetup(person, other, matchSkeletons(person, other), {}).sameBody;
  };
  EXPECT_TRUE(isSame(person));
  EXPECT_TRUE(isSame(testing::scaled(testing::withOtherAxes(testing::renamed(person)), 0.5)));
  EXPECT_FALSE(isSame(testing::oddlyBuilt()));
  Skeleton longer = person;
  longer.joints[person.find("leftHand").value()].rest.translation *= 1.01;
  EXPECT_FALSE(isSame(longer)) << "a twin, whose hands would be elsewhere";
}

// Whose rest pose has the legs up, so that it is compared from a frame, in which feet on roots of their own are
// elsewhere.
TEST(RetargetSetup, TheSameBodyIsToldByTurnsAlone) {
  Skeleton person = practiceHumanoid();
  const std::vector<Vec3> positions = restPositions(person);
  std::vector<Index> legs, feet;
  for (const char* side : {"left", "right"}) {
    legs.push_back(person.find(std::string(side) + "UpperLeg").value());
    feet.push_back(person.find(std::string(side) + "Foot").value());
    Joint& foot = person.joints[feet.back()];
    foot.parent.reset();
    foot.rest.translation = positions[feet.back()];
  }
  PoseSequence motion{{restPose(person)}, 1.0 / 30};
  for (const Index foot : feet) motion.poses[0].locals[foot].translation.y() += 0.1;
  for (const Index leg : legs) person.joints[leg].rest.rotation = testing::turn(Vec3::UnitX(), 180);
  for (const Index foot : feet) person.joints[foot].rest.translation.y() = 2 * positions[0].y() - positions[foot].y();
  const RetargetSetup setup(person, person, matchSkeletons(person, person), {}, &motion);
  EXPECT_TRUE(setup.sameBody);
  EXPECT_NEAR(setup.scale, 1, 1e-9);
}

// Whose recording's ground is a hand's breadth over that of its rest pose.
TEST(RetargetSetup, TheSameBodyIsAsHighOverItsGround) {
  const Skeleton person = practiceHumanoid();
  PoseSequence motion{std::vector(30, restPose(person)), 1.0 / 30};
  for (Pose& pose : motion.poses) pose.locals[0].translation.y() += 0.12;
  RetargetOptions onGround;
  onGround.characterOnGround = true;
  const RetargetSetup setup(person, person, matchSkeletons(person, person), onGround, &motion);
  EXPECT_GT(setup.sourceGround, 0.1);
  EXPECT_DOUBLE_EQ(setup.targetGround, setup.sourceGround);
  onGround.sourceGround = setup.sourceGround;
  const RetargetSetup asked(person, person, matchSkeletons(person, person), onGround, &motion);
  EXPECT_LT(asked.targetGround, 0.1) << "who says where the ground is wants it under the feet";
}

TEST(RetargetSetup, ASwimmersFeetTellNoGround) {
  using limber::testing::turn;
  const Skeleton person = practiceHumanoid();
  PoseSequence swimming{{}, 1.0 / 30}, standing{{}, 1.0 / 30};
  for (int f = 0; f < 30; ++f) {
    Pose& floats = swimming.poses.emplace_back(restPose(person));
    floats.locals[0].translation.y() = 0.5 + 0.001 * f;
    floats.locals[0].rotation = turn(Vec3::UnitX(), 90 + 0.1 * f);
    floats.locals[person.find("leftFoot").value()].rotation = turn(Vec3::UnitX(), 30);
    floats.locals[person.find("rightFoot").value()].rotation = turn(Vec3::UnitX(), 30);
    standing.poses.emplace_back(restPose(person)).locals[0].translation.y() += 0.5;
  }
  const SkeletonMap map = matchSkeletons(person, person);
  const double rest = RetargetSetup(person, person, map, {}).sourceGround;
  EXPECT_DOUBLE_EQ(RetargetSetup(person, person, map, {}, &swimming).sourceGround, rest);
  EXPECT_NEAR(RetargetSetup(person, person, map, {}, &standing).sourceGround, rest + 0.5, 1e-9) << "on a box";
}

}  // namespace
}  // namespace limber
