#include "limber/evaluate/motion/body_contacts.h"

#include <gtest/gtest.h>

#include "limber/character/matching/skeleton_map.h"

namespace limber {
namespace {

TEST(BodyContacts, FiguresArePeopleOfOtherProportions) {
  const Skeleton base = contactFigure({});
  for (const FigureShape& shape : contactFigures()) {
    EXPECT_TRUE(matchSkeletons(base, contactFigure(shape)).isBiped());
  }
  EXPECT_NEAR(restPositions(base)[base.find("headTop_end").value()].y(), 1.75, 0.05);
}

TEST(BodyContacts, PosesAreHeld) {
  const Skeleton figure = contactFigure({});
  for (const BodyContact& contact : bodyContacts()) {
    const PoseSequence motion = contactMotion(figure, contact);
    ASSERT_EQ(motion.poses.size(), 60 + kHoldFrames + 1);
    const Index hand = figure.find("leftHand").value();
    const auto at = [&](std::size_t f) { return posePositions(figure, motion.poses[f])[hand]; };
    EXPECT_LT((at(32) - at(44)).norm(), 1e-9) << contact.name;
    EXPECT_GT((at(0) - at(40)).norm(), 0.1) << contact.name;
  }
}

// The base figure is among the bodies: what is put back on itself keeps its contacts.
TEST(BodyContacts, AreKeptOnTheSameBody) {
  for (const BodyContact& contact : bodyContacts()) {
    const ContactScore score = scoreContact(findRetargetMethod("aligned"), contact);
    EXPECT_GE(score.reached + score.farReached, 15) << contact.name;
    EXPECT_GE(score.kept, 1) << contact.name;
  }
}

}  // namespace
}  // namespace limber
