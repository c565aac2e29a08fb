#include "limber/motion/retarget/limb_ik.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::turn;
using limber::testing::walk;

class LimbIk : public ::testing::Test {
 protected:
  PoseSequence by(const char* method, const RetargetOptions& options = {}) {
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options, &motion);
    return retargetFrames(findRetargetMethod(method), setup, motion);
  }
  double sliding(const PoseSequence& result) const {
    return limber::testing::slideDistance(person, motion, odd, result);
  }

  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const PoseSequence motion = walk(person);
};

TEST_F(LimbIk, PlantedFeetStayPlanted) {
  EXPECT_LT(sliding(by("limb-ik")), 0.35 * sliding(by("aligned")));
}

TEST_F(LimbIk, FeetStayAboveTheGround) {
  const PoseSequence result = by("limb-ik");
  for (const char* name : {"leftFoot", "rightFoot", "leftToes", "rightToes"}) {
    const Index joint = odd.find(name).value();
    const double standing = restGlobals(odd)[joint].translation().y();
    for (const Pose& pose : result.poses) {
      ASSERT_GT(poseGlobals(odd, pose)[joint].translation().y(), standing - 0.005) << name;
    }
  }
}

// A toy whose hips are as wide as its legs are long: with the source's turns of the pelvis one leg would be straight
// and the other deeply bent.
TEST_F(LimbIk, WideHipsTurnLessThanTheSources) {
  Skeleton toy = person;
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) {
    toy.joints[toy.find(leg).value()].rest.translation.x() *= 5;
  }
  const Index hips = person.find("hips").value();
  PoseSequence swaying{{}, 1.0 / 60};
  for (int f = 0; f < 120; ++f) {
    Pose& pose = swaying.poses.emplace_back(restPose(person));
    pose.locals[hips].translation.y() -= 0.02;
    // Legs stay upright, so that the source's feet stand still but for half a centimetre.
    const Quat sway = turn(Vec3::UnitZ(), 4 * std::sin(0.1 * f));
    pose.locals[hips].rotation = sway;
    for (const char* child : {"spine", "leftUpperLeg", "rightUpperLeg"}) {
      pose.locals[person.find(child).value()].rotation = sway.conjugate();
    }
  }
  const RetargetSetup setup(person, toy, matchSkeletons(person, toy), {}, &swaying);
  const auto worstBend = [&](const char* method) {
    double worst = 0;
    for (const Pose& pose : retargetFrames(findRetargetMethod(method), setup, swaying).poses) {
      for (const char* knee : {"leftLowerLeg", "rightLowerLeg"}) {
        worst = std::max(worst, angleBetween(pose.locals[toy.find(knee).value()].rotation, Quat::Identity()));
      }
    }
    return worst * 180 / kPi;
  };
  EXPECT_LT(worstBend("limb-ik"), 20);
}

// On one leg, while the wide hips of a toy are turned to keep it standing: the other leg goes along with its hip.
TEST_F(LimbIk, FreeLegsGoAlongWithThePelvis) {
  Skeleton toy = person;
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) {
    toy.joints[toy.find(leg).value()].rest.translation.x() *= 2;
  }
  const Index hips = person.find("hips").value();
  const auto joint = [&](const char* name) { return person.find(name).value(); };
  PoseSequence swaying{{}, 1.0 / 60};
  for (int f = 0; f < 120; ++f) {
    Pose& pose = swaying.poses.emplace_back(restPose(person));
    const Quat sway = turn(Vec3::UnitY(), 8 * std::sin(0.2 * f));
    pose.locals[hips].rotation = sway;
    pose.locals[joint("leftUpperLeg")].rotation = sway.conjugate();
    pose.locals[joint("rightUpperLeg")].rotation = sway.conjugate() * turn(-Vec3::UnitX(), 50);
    pose.locals[joint("rightLowerLeg")].rotation = turn(Vec3::UnitX(), 60);
    const Vec3 moved = poseGlobals(person, pose)[joint("leftFoot")].translation() -
                       restGlobals(person)[joint("leftFoot")].translation();
    pose.locals[hips].translation -= moved;
  }
  const RetargetSetup setup(person, toy, matchSkeletons(person, toy), {}, &swaying);
  double least = HUGE_VAL, most = 0;
  for (const Pose& pose : retargetFrames(findRetargetMethod("limb-ik"), setup, swaying).poses) {
    const double bend = angleBetween(pose.locals[toy.find("rightLowerLeg").value()].rotation, Quat::Identity());
    least = std::min(least, bend * 180 / kPi);
    most = std::max(most, bend * 180 / kPi);
  }
  EXPECT_LT(most - least, 0.3) << "it is always bent by 60 degrees in the source";
  EXPECT_NEAR(least, 60, 1);
}

TEST_F(LimbIk, ToesLieOnTheGroundWhileTheHeelGoesUp) {
  PoseSequence raised{{}, 1.0 / 60};
  const Index foot = person.find("leftFoot").value(), toes = person.find("leftToes").value();
  const Vec3 standing = restGlobals(person)[toes].translation();
  for (int f = 0; f < 60; ++f) {
    Pose& pose = raised.poses.emplace_back(restPose(person));
    pose.locals[foot].rotation = limber::testing::turn(Vec3::UnitX(), 0.5 * f);
    pose.locals[0].translation += standing - poseGlobals(person, pose)[toes].translation();
  }
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {}, &raised);
  const auto tipsDown = [&](const char* method) {
    const Pose last = retargetFrames(findRetargetMethod(method), setup, raised).poses.back();
    const Index joint = odd.find("leftToes").value();
    const Mat3 turned = poseGlobals(odd, last)[joint].linear() * restGlobals(odd)[joint].linear().transpose();
    return std::asin(-turned.col(2).y()) * 180 / kPi;
  };
  EXPECT_NEAR(tipsDown("aligned"), 29.5, 0.1);
  EXPECT_LT(tipsDown("limb-ik"), 5);
}

// Toes that only the target has: its feet are longer than the source's ankles tell.
TEST_F(LimbIk, ToesStayAboveTheGroundWhereTheSourceHasNone) {
  const Skeleton toeless = limber::testing::withoutToes(person);
  Skeleton longFooted = odd;
  for (const char* toes : {"leftToes", "rightToes"}) {
    longFooted.joints[longFooted.find(toes).value()].rest.translation.z() *= 1.6;
  }
  PoseSequence rising{{}, 1.0 / 60};
  for (int f = 0; f < 60; ++f) {
    Pose& pose = rising.poses.emplace_back(restPose(toeless));
    pose.locals[toeless.find("hips").value()].translation.y() += 0.001 * f;
    pose.locals[toeless.find("leftFoot").value()].rotation = turn(Vec3::UnitX(), 1.2 * f);
  }
  const RetargetSetup setup(toeless, longFooted, matchSkeletons(toeless, longFooted), {}, &rising);
  const Index toes = longFooted.find("leftToes").value();
  const double standing = restGlobals(longFooted)[toes].translation().y();
  const auto lowest = [&](const char* method) {
    double low = HUGE_VAL;
    for (const Pose& pose : retargetFrames(findRetargetMethod(method), setup, rising).poses) {
      low = std::min(low, poseGlobals(longFooted, pose)[toes].translation().y());
    }
    return low - standing;
  };
  EXPECT_LT(lowest("aligned"), -0.03);
  EXPECT_GT(lowest("limb-ik"), -1e-6);
  EXPECT_GT(lowest("spacetime"), -1e-6);
}

TEST_F(LimbIk, BonesKeepTheirLengths) {
  const PoseSequence result = by("limb-ik");
  for (const Pose& pose : result.poses) {
    for (Index j = 1; j < odd.jointCount(); ++j) {
      ASSERT_LT((pose.locals[j].translation - odd.joints[j].rest.translation).norm(), 1e-9);
    }
  }
}

TEST_F(LimbIk, HandsReachWhereTheSourcesAre) {
  Skeleton shortArms = person;
  for (Joint& joint : shortArms.joints) {
    if (joint.name == "leftHand" || joint.name == "leftLowerArm") joint.rest.translation *= 0.9;
  }
  const PoseSequence still{{restPose(person)}, 1.0 / 30};
  PoseSequence bent = still;
  bent.poses[0].locals[person.find("leftLowerArm").value()].rotation = turn(-Vec3::UnitY(), 60);
  RetargetOptions options;
  options.reach = 1;
  for (const char* solver : {"two-bone", "fabrik"}) {
    options.solver = solver;
    const RetargetSetup setup(person, shortArms, matchSkeletons(person, shortArms), options, &bent);
    const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, bent);
    const Index hand = person.find("leftHand").value();
    EXPECT_LT((poseGlobals(shortArms, result.poses[0])[hand].translation() -
               poseGlobals(person, bent.poses[0])[hand].translation())
                  .norm(),
              0.002)
        << solver;
  }
}

TEST_F(LimbIk, TouchingHandsTouch) {
  Skeleton broad = person;
  for (Joint& joint : broad.joints) {
    if (joint.name == "leftUpperArm" || joint.name == "rightUpperArm") joint.rest.translation.x() *= 1.6;
  }
  PoseSequence clap{{restPose(person)}, 1.0 / 30};
  for (const auto& [side, sign] : {std::pair<std::string, double>{"left", -1}, {"right", 1}}) {
    clap.poses[0].locals[person.find(side + "UpperArm").value()].rotation = turn(Vec3::UnitY(), sign * 80);
    clap.poses[0].locals[person.find(side + "LowerArm").value()].rotation = turn(Vec3::UnitY(), sign * 80);
  }
  const auto apart = [&](const Skeleton& skeleton, const Pose& pose) {
    const std::vector<Affine> globals = poseGlobals(skeleton, pose);
    return (globals[skeleton.find("leftHand").value()].translation() -
            globals[skeleton.find("rightHand").value()].translation())
        .norm();
  };
  const RetargetSetup setup(person, broad, matchSkeletons(person, broad), {}, &clap);
  const double wanted = apart(person, clap.poses[0]);
  ASSERT_LT(wanted, 0.11) << "the source's hands touch";
  const double aligned = apart(broad, retargetFrames(findRetargetMethod("aligned"), setup, clap).poses[0]);
  const double solved = apart(broad, retargetFrames(findRetargetMethod("limb-ik"), setup, clap).poses[0]);
  EXPECT_GT(aligned, wanted + 0.05);
  EXPECT_NEAR(solved, wanted, 0.01);
}

TEST_F(LimbIk, FramesComeOneByOne) {
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {}, &motion);
  const PoseSequence whole = by("limb-ik");
  const auto live = findRetargetMethod("limb-ik").make(setup);
  Pose pose = restPose(odd);
  for (std::size_t f = 0; f < 50; ++f) {
    live->next(motion.poses[f], f == 0 ? 0 : motion.frameSeconds, pose);
    for (Index j = 0; j < odd.jointCount(); ++j) {
      ASSERT_EQ(pose.locals[j].rotation.coeffs(), whole.poses[f].locals[j].rotation.coeffs()) << "no look-ahead";
    }
  }
}

TEST_F(LimbIk, UnknownNamesListTheKnown) {
  EXPECT_THROW(findRetargetMethod("magic"), Error);
  RetargetOptions options;
  options.solver = "magic";
  EXPECT_THROW(by("limb-ik", options), Error);
}

}  // namespace
}  // namespace limber
