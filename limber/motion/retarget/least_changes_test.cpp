#include "limber/motion/retarget/least_changes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber {
namespace {

constexpr std::size_t kShortClip = 12, kJolt = 6;

// A pelvis that stays and one leg, straight down and 1 long; its foot is moved aside in one frame. Its lower bone
// points wherever the foot is, the upper one stays.
ChangedMotion jolted(const ChangeLayout& layout) {
  ChangedMotion motion;
  motion.changes.assign(layout.frames() * layout.perFrame(), 0.0);
  motion.paths.assign(3, Path(layout.frames(), Vec3::Zero()));
  motion.paths[2][kJolt] = Vec3(0.2, 0, 0);
  BoneSlopes& slopes = motion.slopes.emplace_back();
  slopes.fill(std::vector<Slope>(layout.frames(), Slope(Slope::Zero())));
  for (Slope& slope : slopes[1]) slope.leftCols<3>().setIdentity();
  return motion;
}

struct Leg {
  ChangeLayout layout{kShortClip, {false}};
  std::vector<FootFrame> feet = std::vector<FootFrame>(kShortClip, FootFrame{false, -1, Vec3(0, -1, 0), 2});
  MotionEnds ends;
  double jerkWeight = 1e4;

  Changes changes() const {
    LeastChanges least(layout, feet, std::vector<bool>(kShortClip), ends);
    least.start(jolted(layout));
    return least.find(jerkWeight);
  }
  Vec3 footAt(std::size_t frame) const { return displacementAt(changes(), layout.foot(frame, 0)); }
  Vec3 pelvisAt(std::size_t frame) const { return displacementAt(changes(), layout.pelvis(frame)); }
};

// The sum that is least, of changes about those that are.
double sumOf(const ChangeLayout& layout, const ChangedMotion& now, const Changes& changes,
             const std::vector<bool>& cuts, double jerkWeight) {
  std::vector<Path> paths = now.paths;
  for (std::size_t f = 0; f < layout.frames(); ++f) {
    const Vec3 pelvis = displacementAt(changes, layout.pelvis(f)) - displacementAt(now.changes, layout.pelvis(f));
    paths[0][f] += pelvis;
    for (std::size_t leg = 0; leg < layout.legs(); ++leg) {
      const Vec3 foot = displacementAt(changes, layout.foot(f, leg)) - displacementAt(now.changes, layout.foot(f, leg));
      Eigen::Vector4d displacement(foot.x() - pelvis.x(), foot.y() - pelvis.y(), foot.z() - pelvis.z(), 0);
      if (layout.isTilted(leg)) displacement[3] = changes[layout.shoulders(f)] - now.changes[layout.shoulders(f)];
      for (std::size_t bone = 0; bone < 2; ++bone)
        paths[1 + 2 * leg + bone][f] += now.slopes[leg][bone][f] * displacement;
    }
  }
  double sum = jerkWeight * squaredJerk(paths, cuts, 3, layout.frames());
  for (const double change : changes) sum += change * change;
  return sum;
}

TEST(LeastChanges, AreTheLeast) {
  const ChangeLayout layout(kShortClip, {false, true});
  std::vector<bool> cuts(kShortClip);
  cuts[5] = true;
  double phase = 0;
  const auto next = [&] { return std::sin(phase += 1.7); };
  ChangedMotion now;
  for (std::size_t i = 0; i < kShortClip * layout.perFrame(); ++i) now.changes.push_back(0.1 * next());
  now.paths.assign(5, Path(kShortClip));
  for (Path& path : now.paths) {
    for (Vec3& position : path) position = Vec3(next(), next(), next());
  }
  now.slopes.assign(2, {std::vector<Slope>(kShortClip), std::vector<Slope>(kShortClip)});
  for (BoneSlopes& bones : now.slopes) {
    for (std::vector<Slope>& bone : bones) {
      for (Slope& slope : bone) slope = Slope::NullaryExpr(next);
    }
  }
  const std::vector<FootFrame> free(2 * kShortClip, FootFrame{false, -100, Vec3(0, -1, 0), 100});
  LeastChanges squares(layout, free, cuts, {});
  squares.start(now);
  const Changes least = squares.find(10);
  const double sum = sumOf(layout, now, least, cuts, 10);
  EXPECT_LT(sum, 0.5 * sumOf(layout, now, now.changes, cuts, 10));
  for (std::size_t i = 0; i < least.size(); ++i) {
    Changes more = least, less = least;
    more[i] += 0.01;
    less[i] -= 0.01;
    const double rise = sumOf(layout, now, more, cuts, 10) - sum;
    EXPECT_GT(rise, 0) << i;
    EXPECT_NEAR(sumOf(layout, now, less, cuts, 10) - sum, rise, 1e-6 * rise + 1e-9) << i;
  }
}

TEST(LeastChanges, TheJoltIsTakenBackAndTheRestFollowsTheLess) {
  const Leg leg;
  EXPECT_LT(leg.footAt(kJolt).x(), -0.1);
  EXPECT_NEAR(leg.footAt(kJolt).y(), 0, 1e-9);
  Leg lazy;
  lazy.jerkWeight = 1e-3;
  EXPECT_GT(lazy.footAt(kJolt).x(), -0.01) << "jerk hardly counts";
}

TEST(LeastChanges, FeetThatStandTakeNoSteps) {
  Leg leg;
  for (FootFrame& foot : leg.feet) foot.planted = true;
  for (std::size_t f = 1; f < kShortClip; ++f) EXPECT_NEAR((leg.footAt(f) - leg.footAt(0)).norm(), 0, 1e-4);
}

TEST(LeastChanges, FeetStayAboveTheirLowestAndWithinReach) {
  Leg leg;
  leg.feet[kJolt].lowest = 0.3;  // up, whatever jerk asks
  EXPECT_NEAR(leg.footAt(kJolt).y(), 0.3, 1e-4);
  EXPECT_GT(leg.footAt(kJolt - 1).y(), 0.05) << "its neighbours follow";
  Leg stretched;
  stretched.feet[kJolt].displacement = Vec3(0, -1.1, 0);
  stretched.feet[kJolt].most = 1;
  const Vec3 reached = stretched.footAt(kJolt) - stretched.pelvisAt(kJolt) + Vec3(0, -1.1, 0);
  EXPECT_NEAR(reached.norm(), 1, 1e-4) << "by the foot and by the hip";
}

TEST(LeastChanges, BoundsHoldWhileTheyAreMet) {
  Leg leg;
  for (FootFrame& foot : leg.feet) foot.lowest = -0.02;
  LeastChanges least(leg.layout, leg.feet, std::vector<bool>(kShortClip), {});
  ChangedMotion motion = jolted(leg.layout);
  motion.paths[2][kJolt] = Vec3(0, 0.2, 0);
  least.start(motion);
  EXPECT_NEAR(least.find(1e4)[leg.layout.foot(kJolt, 0) + 1], -0.02, 1e-4);
  motion.paths[2][kJolt] = Vec3::Zero();
  least.start(motion);
  EXPECT_NEAR(least.find(1e4)[leg.layout.foot(kJolt, 0) + 1], 0, 1e-6);
}

// Shoulders that rise go back where the trunk goes up: the leg below them reaches as far as it does there.
TEST(LeastChanges, LegsReachFromShouldersThatRise) {
  const ChangeLayout layout(kShortClip, {true});
  std::vector<FootFrame> feet(kShortClip, FootFrame{false, -1, Vec3(0.6, -0.9, 0), 1, Vec3(-0.5, 1, 0)});
  LeastChanges least(layout, feet, std::vector<bool>(kShortClip), {});
  least.start(jolted(layout));
  const Changes changes = least.find(1e-3);
  const double rise = changes[layout.shoulders(kJolt)];
  EXPECT_LT(rise, -0.01);
  const Vec3 displacement = feet[kJolt].displacement + displacementAt(changes, layout.foot(kJolt, 0)) -
                            displacementAt(changes, layout.pelvis(kJolt));
  EXPECT_NEAR((displacement - rise * feet[kJolt].lift).norm(), 1, 1e-4);
}

TEST(LeastChanges, FeetTakeTheStepsAndComeToTheHeightsThatAreAsked) {
  const ChangeLayout layout(kShortClip, {false});
  std::vector<FootFrame> feet(kShortClip, FootFrame{false, -1, Vec3(0, -1, 0), 2});
  for (FootFrame& foot : feet) {
    foot.step = Vec3(0.01, 0, -0.02);
    foot.height = 0.03;
    foot.hold = foot.rest = 1;
  }
  ChangeWeights weights;
  weights.hold = weights.rest = 1e6;
  LeastChanges least(layout, feet, std::vector<bool>(kShortClip), {}, weights);
  least.start(jolted(layout));
  const Changes changes = least.find(0);
  for (std::size_t f = 0; f < kShortClip; ++f) {
    EXPECT_NEAR(changes[layout.foot(f, 0) + 1], 0.03, 1e-5);
    if (f == 0) continue;
    const Vec3 step = displacementAt(changes, layout.foot(f, 0)) - displacementAt(changes, layout.foot(f - 1, 0));
    EXPECT_NEAR((Vec3(step.x(), 0, step.z()) - Vec3(0.01, 0, -0.02)).norm(), 0, 1e-5);
  }
}

// The pelvis follows a foot that the ground pushes up where bones count, wholly where the foot carries it.
TEST(LeastChanges, BonesKeepTheirDirectionsWhereTheyCount) {
  const ChangeLayout layout(kShortClip, {false});
  std::vector<FootFrame> feet(kShortClip, FootFrame{false, -1, Vec3(0, -1, 0), 2});
  const auto riseOfPelvis = [&](double bones, double hold) {
    for (FootFrame& foot : feet) {
      foot.lowest = 0.1;
      foot.hold = hold;
    }
    ChangeWeights weights;
    weights.bones = bones;
    weights.pelvisUp = 0.01;
    LeastChanges least(layout, feet, std::vector<bool>(kShortClip), {}, weights);
    ChangedMotion still = jolted(layout);
    still.paths[2][kJolt] = Vec3::Zero();
    least.start(still);
    return least.find(1)[layout.pelvis(kJolt) + 1];
  };
  EXPECT_NEAR(riseOfPelvis(0, 1), 0, 1e-3);
  EXPECT_NEAR(riseOfPelvis(1, 1), 0.1, 2e-3);
  EXPECT_NEAR(riseOfPelvis(1, 0), 0.05, 2e-3) << "bones and its own height count the same";
}

TEST(LeastChanges, APartBeginsAsTheOneBeforeItEnded) {
  Leg leg;
  leg.ends.startsJoined = true;
  leg.ends.start.assign(3 * leg.layout.perFrame(), 0.02);
  for (std::size_t f = 0; f < 3; ++f) EXPECT_NEAR((leg.footAt(f) - Vec3::Constant(0.02)).norm(), 0, 1e-6) << f;
}

TEST(LeastChanges, EndsStayOrCloseTheLoop) {
  Leg joined;
  joined.ends.startsJoined = joined.ends.endsJoined = true;
  for (const std::size_t f : {0u, 2u, 9u, 11u}) EXPECT_NEAR(joined.footAt(f).norm(), 0, 1e-6) << f;
  Leg loop;
  EXPECT_GT((loop.footAt(0) - loop.footAt(kShortClip - 1)).norm(), 1e-4);
  loop.ends.loops = true;
  EXPECT_NEAR((loop.footAt(0) - loop.footAt(kShortClip - 1)).norm(), 0, 1e-6);
}

TEST(LeastChanges, ShouldersThatRiseHaveAPlaceInTheLayout) {
  const ChangeLayout flat{4, {false, false}}, tilting{4, {false, true}};
  EXPECT_EQ(flat.perFrame(), 9u);
  EXPECT_EQ(tilting.perFrame(), 10u);
  EXPECT_EQ(tilting.shoulders(1), 19u);
  EXPECT_EQ(tilting.foot(2, 1), 26u);
}

}  // namespace
}  // namespace limber
