#include "limber/retarget/even_changes.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

constexpr std::size_t kFrames = 12, kJolt = 6;

// A pelvis that stays and one leg, straight down and 1 long; its foot is moved aside in one frame. Its lower bone
// points wherever the foot is, the upper one stays.
ChangedMotion jolted(const ChangeLayout& layout) {
  ChangedMotion motion;
  motion.changes.assign(layout.frames * layout.perFrame(), 0.0);
  motion.paths.assign(3, Path(layout.frames, Vec3::Zero()));
  motion.paths[2][kJolt] = Vec3(0.2, 0, 0);
  BonePair bones;
  bones.firstPath = 1;
  bones.slopes.fill(std::vector(layout.frames, BonePair::Slope(BonePair::Slope::Zero())));
  for (BonePair::Slope& slope : bones.slopes[1]) slope.leftCols<3>().setIdentity();
  motion.bones.push_back(bones);
  return motion;
}

struct Leg {
  ChangeLayout layout{kFrames, {false}};
  std::vector<FootFrame> feet = std::vector<FootFrame>(kFrames, FootFrame{false, -1, Vec3(0, -1, 0), 2});
  MotionEnds ends;
  double jerkWeight = 1e4;

  Changes changes() const {
    LeastChanges least(layout, feet, std::vector<bool>(kFrames), ends);
    return least.find(jolted(layout), jerkWeight);
  }
  Vec3 footAt(std::size_t frame) const { return wayAt(changes(), layout.foot(frame, 0)); }
  Vec3 pelvisAt(std::size_t frame) const { return wayAt(changes(), layout.pelvis(frame)); }
};

TEST(EvenChanges, TheJoltIsTakenBackAndTheRestFollowsTheLess) {
  const Leg leg;
  EXPECT_LT(leg.footAt(kJolt).x(), -0.1);
  EXPECT_NEAR(leg.footAt(kJolt).y(), 0, 1e-9);
  Leg lazy;
  lazy.jerkWeight = 1e-3;
  EXPECT_GT(lazy.footAt(kJolt).x(), -0.01) << "jerk hardly counts";
}

TEST(EvenChanges, FeetThatStandTakeNoSteps) {
  Leg leg;
  for (FootFrame& foot : leg.feet) foot.stands = true;
  for (std::size_t f = 1; f < kFrames; ++f) EXPECT_NEAR((leg.footAt(f) - leg.footAt(0)).norm(), 0, 1e-4);
}

TEST(EvenChanges, FeetStayAboveTheirLowestAndWithinReach) {
  Leg leg;
  leg.feet[kJolt].lowest = 0.3;  // up, whatever jerk asks
  EXPECT_NEAR(leg.footAt(kJolt).y(), 0.3, 1e-4);
  EXPECT_GT(leg.footAt(kJolt - 1).y(), 0.05) << "its neighbours follow";
  Leg stretched;
  stretched.feet[kJolt].way = Vec3(0, -1.1, 0);
  stretched.feet[kJolt].most = 1;
  const Vec3 reached = stretched.footAt(kJolt) - stretched.pelvisAt(kJolt) + Vec3(0, -1.1, 0);
  EXPECT_NEAR(reached.norm(), 1, 1e-4) << "by the foot and by the hip";
}

TEST(EvenChanges, EndsStayOrCloseTheLoop) {
  Leg joined;
  joined.ends.startsJoined = joined.ends.endsJoined = true;
  for (const std::size_t f : {0u, 2u, 9u, 11u}) EXPECT_NEAR(joined.footAt(f).norm(), 0, 1e-6) << f;
  Leg loop;
  EXPECT_GT((loop.footAt(0) - loop.footAt(kFrames - 1)).norm(), 1e-4);
  loop.ends.loops = true;
  EXPECT_NEAR((loop.footAt(0) - loop.footAt(kFrames - 1)).norm(), 0, 1e-6);
}

TEST(EvenChanges, ShouldersThatRiseHaveAPlaceInTheLayout) {
  const ChangeLayout flat{4, {false, false}}, tilting{4, {false, true}};
  EXPECT_EQ(flat.perFrame(), 9u);
  EXPECT_EQ(tilting.perFrame(), 10u);
  EXPECT_EQ(tilting.shoulders(1), 19u);
  EXPECT_EQ(tilting.foot(2, 1), 26u);
}

}  // namespace
}  // namespace limber
