#include "limber/motion/limbs/body/arm_clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/text/numbers.h"

namespace limber {
namespace {

using limber::testing::turn;
using Bone = ArmClearance::Bone;

// Round pillars about vertical lines that pass through joints.
struct Pillars {
  std::vector<Vec3f> positions;
  SkinWeights weights{1, {}, {}};

  void add(Index joint, const Vec3& at, double down, double up, double radius) {
    constexpr int kHeights = 11, kAround = 24;
    for (int h = 0; h < kHeights; ++h) {
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * kPi * i / kAround, height = -down + (up + down) * h / (kHeights - 1);
        positions.push_back((at + Vec3(radius * std::cos(angle), height, radius * std::sin(angle))).cast<float>());
        weights.joints.push_back(joint);
        weights.weights.push_back(1);
      }
    }
  }
};

TEST(SkinTube, TellsHowDeepAPointIsAndTheWayOut) {
  const Skeleton person = practiceHumanoid();
  const RetargetSetup setup(person, person, matchSkeletons(person, person), {});
  const Index joint = person.find("hips").value();
  BodyFrame frame;
  setup.targetKinematics.globals(restPose(person), frame);
  const Vec3 hips = frame.positions[joint];
  Pillars pillars;
  pillars.add(joint, hips, 0.1, 0.5, 0.3);
  const std::optional<SkinTube> tube =
      SkinTube::about(joint, *makeBodySkin(person, pillars.positions, pillars.weights));
  ASSERT_TRUE(tube);
  EXPECT_NEAR(tube->thickness(), 0.3, 0.01);
  for (const double angle : {0.1, 2.0, 4.5}) {
    const Vec3 aside(std::cos(angle), 0, std::sin(angle));
    const auto inside = tube->depthOf(hips + Vec3(0, 0.2, 0) + 0.1 * aside, frame);
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->depth, 0.2, 0.01);
    EXPECT_NEAR(inside->out.dot(aside), 1, 1e-4);
    EXPECT_NEAR(tube->depthOf(hips + Vec3(0, 0.2, 0) + 0.5 * aside, frame)->depth, -0.2, 0.01);
  }
  EXPECT_FALSE(tube->depthOf(hips + Vec3(0, 0.6, 0), frame)) << "above it";
  EXPECT_FALSE(SkinTube::about(joint, BodySkin{})) << "no skin";
}

class ArmClearanceTest : public ::testing::Test {
 protected:
  ArmClearance clearanceBy(double radius) { return clearanceBy(radius, shortArmed_); }
  ArmClearance clearanceBy(double radius, const Skeleton& source) {
    Pillars pillars;
    const Index hips = person_.find("hips").value();
    const std::vector<Vec3> rest = restPositions(person_);
    if (radius > 0) pillars.add(hips, rest[hips], 0.1, 0.6, radius);
    RetargetOptions options;
    if (radius > 0) {
      options.skin = makeBodySkin(person_, pillars.positions, pillars.weights);
    }
    setup_.emplace(source, person_, matchSkeletons(source, person_), options);
    root_.emplace(*setup_);
    return ArmClearance(*setup_, *root_);
  }
  static Skeleton shortArmed() {
    Skeleton source = practiceHumanoid();
    for (const char* joint : {"leftHand", "rightHand"}) {
      source.joints[source.find(joint).value()].rest.translation *= 0.9;
    }
    return source;
  }
  // Arms that hang down, turned in front of the body.
  void hang() {
    for (const auto& [joint, degrees] : {std::pair{"leftUpperArm", -80.0}, {"rightUpperArm", 80.0}}) {
      pose_.locals[person_.find(joint).value()].rotation = turn(Vec3::UnitZ(), degrees);
    }
    setup_->targetKinematics.globals(pose_, frame_);
  }

  void expectOutAfterSwings(const ArmClearance& clearance, std::size_t arm, Bone bone) {
    const double before = clearance.displacementOut(arm, bone, frame_).norm();
    EXPECT_GT(before, 0.02);
    for (int i = 0; i < 4; ++i) clearance.swing(arm, bone, clearance.displacementOut(arm, bone, frame_), frame_, pose_);
    EXPECT_LT(clearance.displacementOut(arm, bone, frame_).norm(), 0.3 * before);
    BodyFrame anew;
    setup_->targetKinematics.globals(pose_, anew);
    const Index hand = person_.find("leftHand").value();
    EXPECT_LT((anew.positions[hand] - frame_.positions[hand]).norm(), 1e-9) << "the pose says what the frame says";
  }

  const Skeleton person_ = practiceHumanoid(), shortArmed_ = shortArmed();  // motions are of the latter
  std::optional<RetargetSetup> setup_;
  std::optional<RootPositioner> root_;
  Pose pose_ = restPose(person_);
  BodyFrame frame_;
};

TEST_F(ArmClearanceTest, TakesHangingArmsOutOfAThickBody) {
  const ArmClearance clearance = clearanceBy(0.45);
  hang();
  ASSERT_EQ(clearance.arms(), 2u);
  for (std::size_t arm = 0; arm < 2; ++arm) expectOutAfterSwings(clearance, arm, Bone::kUpper);
}

TEST_F(ArmClearanceTest, TakesForearmsOutThatAreBentIntoIt) {
  const ArmClearance clearance = clearanceBy(0.4);
  pose_.locals[person_.find("leftLowerArm").value()].rotation = turn(Vec3::UnitY(), -150);
  setup_->targetKinematics.globals(pose_, frame_);
  EXPECT_EQ(clearance.displacementOut(0, Bone::kUpper, frame_), Vec3(Vec3::Zero()));
  expectOutAfterSwings(clearance, 0, Bone::kForearm);
}

TEST_F(ArmClearanceTest, LeavesArmsThatAreOutside) {
  const ArmClearance thin = clearanceBy(0.08);
  hang();
  for (const Bone bone : {Bone::kUpper, Bone::kForearm})
    EXPECT_EQ(thin.displacementOut(0, bone, frame_), Vec3(Vec3::Zero()));
  EXPECT_EQ(clearanceBy(0).arms(), 0u) << "nothing is known of its skin";
  EXPECT_EQ(clearanceBy(0.45, person_).arms(), 0u) << "a motion of its own is right as it is";
}

TEST_F(ArmClearanceTest, WhatIsInsideAtRestMayBe) {
  const ArmClearance clearance = clearanceBy(0.45);
  setup_->targetKinematics.globals(setup_->targetRest, frame_);
  for (const Bone bone : {Bone::kUpper, Bone::kForearm}) {
    EXPECT_EQ(clearance.displacementOut(0, bone, frame_), Vec3(Vec3::Zero()));
  }
}

}  // namespace
}  // namespace limber
