#include "limber/motion/limbs/contacts/contact_track.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/limb_goals.h"

namespace limber {
namespace {

using namespace testing;

class ContactTrackTest : public ::testing::Test {
 protected:
  ContactTrack track() const {
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {}, &motion);
    const RootPositioner root(setup);
    return {setup, LimbGoals(setup, root).watchedFeet(), motion};
  }

  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  PoseSequence motion = walk(person, 240);
};

TEST_F(ContactTrackTest, AWalkStandsOnOneFootAfterTheOther) {
  const ContactTrack contacts = track();
  ASSERT_EQ(contacts.frames(), motion.poses.size());
  std::size_t one = 0, none = 0, changes = 0;
  for (std::size_t f = 0; f < contacts.frames(); ++f) {
    const int standing = contacts.at(f, 0).isPlanted() + contacts.at(f, 1).isPlanted();
    one += standing == 1;
    none += standing == 0;
    changes += f > 0 && contacts.at(f, 0).isPlanted() != contacts.at(f - 1, 0).isPlanted();
    EXPECT_FALSE(f > 1 && contacts.isCut(f)) << "the walk begins at once";
  }
  EXPECT_GT(one, contacts.frames() / 2);
  EXPECT_LT(none, contacts.frames() / 5);
  EXPECT_GE(changes, 3u);
}

TEST_F(ContactTrackTest, StrengthComesAndGoesWithoutAJump) {
  const ContactTrack contacts = track();
  double most = 0;
  for (std::size_t f = 1; f < contacts.frames(); ++f) {
    most = std::max(most, std::abs(contacts.at(f, 0).strength - contacts.at(f - 1, 0).strength));
  }
  EXPECT_LT(most, 0.1);
  EXPECT_GT(most, 0);
}

TEST_F(ContactTrackTest, AFootIsHeldTheLessTheFasterItMovesWhileItStands) {
  const double hipHeight = RetargetSetup(person, odd, matchSkeletons(person, odd), {}).sourceHipHeight;
  const auto firmnessAt = [&](double speed) {
    motion.poses.assign(30, restPose(person));
    for (std::size_t f = 0; f < motion.poses.size(); ++f) {
      const double pathLength = speed * hipHeight * motion.frameSeconds * static_cast<double>(f);
      motion.poses[f].locals[0].translation += Vec3(pathLength, 0, 0);
    }
    return track().firmness(15, 0);
  };
  EXPECT_EQ(firmnessAt(0), 1);
  EXPECT_NEAR(firmnessAt(0.2), 0.1, 0.01);
  EXPECT_LT(firmnessAt(0.28), 0.02);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) motion.poses[f].locals[0].translation.y() += f < 15 ? 0 : 0.5;
  EXPECT_EQ(track().firmness(20, 0), 0) << "in the air";
}

TEST_F(ContactTrackTest, WhatStoodBeforeACutDoesNotCount) {
  for (std::size_t f = 120; f < motion.poses.size(); ++f) motion.poses[f].locals[0].translation += Vec3(3, 1, 0);
  const ContactTrack contacts = track();
  for (std::size_t f = 2; f < contacts.frames(); ++f) EXPECT_EQ(contacts.isCut(f), f == 120) << f;
  EXPECT_FALSE(contacts.at(125, 0).isPlanted() || contacts.at(125, 1).isPlanted()) << "a metre over the ground";
}

}  // namespace
}  // namespace limber
