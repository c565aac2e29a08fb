#include "limber/motion/retarget/moved_legs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/limb_goals.h"
#include "limber/skeleton/chain.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::quadruped;
using limber::testing::quadrupedWithHocks;

constexpr std::size_t kFrames = 40;

// Every joint swings, the root travels.
PoseSequence swinging(const Skeleton& body) {
  PoseSequence motion;
  for (std::size_t f = 0; f < kFrames; ++f) {
    Pose pose = restPose(body);
    const double time = 0.2 * static_cast<double>(f);
    pose.locals[0].translation.z() += time;
    for (Index j = 0; j < body.jointCount(); ++j) {
      pose.locals[j].rotation =
          pose.locals[j].rotation * Eigen::AngleAxisd(0.2 * std::sin(time + j), Vec3(1, 0.3, 0.1).normalized());
    }
    motion.poses.push_back(pose);
  }
  return motion;
}

// How skeletons are matched: by names as well; by form, so that the trunk of quadrupeds tilts; with their hocks above
// the joints that bend legs most, as a map out of a file may have them.
enum class Matching { kNames, kForm, kHocksAbove };

SkeletonMap matched(const Skeleton& source, const Skeleton& target, Matching matching) {
  SkeletonMap map =
      matching == Matching::kForm ? limber::testing::matchByForm(source, target) : matchSkeletons(source, target);
  if (matching != Matching::kHocksAbove) return map;
  map.twins.reset();
  for (JointMatch& match : map.matches) {
    if (match.part.kind != PartKind::kLeg) continue;
    if (match.part.segment == Segment::kMiddle) {
      match.part.segment = Segment::kHock;
    } else if (match.part.segment == Segment::kHock) {
      match.part.segment = Segment::kMiddle;
    }
  }
  return map;
}

struct Moved {
  Moved(Skeleton from, Skeleton to, Matching matching = Matching::kNames)
      : source(std::move(from)),
        target(std::move(to)),
        motion(swinging(target)),
        setup(source, target, matched(source, target, matching), {}) {
    std::vector<bool> tilted;
    for (const LegSpec& leg : goals.specs()) tilted.push_back(leg.fore);
    layout = ChangeLayout(kFrames, tilted);
    feet.resize(kFrames * goals.legs().size());
    for (const Pose& pose : motion.poses) {
      setup.targetKinematics.globals(pose, frame);
      legs.add(frame);
    }
  }
  // Of up to a fiftieth of the hips' height, with legs that are bent.
  Changes waves() const {
    Changes changes;
    for (std::size_t i = 0; i < kFrames * layout.perFrame(); ++i) {
      changes.push_back(0.02 * std::sin(0.7 * static_cast<double>(i)));
    }
    for (std::size_t f = 0; f < kFrames; ++f) changes[layout.pelvis(f) + 1] -= 0.2;
    return changes;
  }
  std::vector<Path> followed(const Changes& changes) const {
    std::vector<Path> paths;
    EXPECT_TRUE(legs.follow(layout, changes, feet, paths));
    return paths;
  }
  // The same by posing.
  std::vector<Path> posed(const Changes& changes) {
    std::vector<Path> paths(1 + 2 * goals.legs().size());
    for (std::size_t f = 0; f < kFrames; ++f) {
      Pose pose = motion.poses[f];
      legs.pose(layout, changes, f, pose);
      setup.targetKinematics.globals(pose, frame);
      paths[0].push_back(pelvisOf(setup.map, MapSide::kTarget, frame.positions) / setup.targetHipHeight);
      const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
      for (std::size_t i = 0; i < goals.legs().size(); ++i) {
        const LegSpec& leg = goals.legs()[i].spec;
        const auto displacement = [&](const std::vector<Vec3>& at, Index from, Index to) {
          return Vec3(at[to] - at[from]);
        };
        paths[1 + 2 * i].push_back(displacement(frame.positions, leg.upper, leg.lower) /
                                   displacement(rest, leg.upper, leg.lower).norm());
        paths[2 + 2 * i].push_back(displacement(frame.positions, leg.lower, leg.end) /
                                   displacement(rest, leg.lower, leg.end).norm());
      }
    }
    return paths;
  }

  Skeleton source, target;
  PoseSequence motion;
  RetargetSetup setup;
  RootPositioner root{setup};
  LimbGoals goals{setup, root};
  MovedLegs legs{setup, root, goals.pelvis().trunk(), goals.specs()};
  ChangeLayout layout;
  std::vector<FootFrame> feet;
  BodyFrame frame;
};

double furthestApart(const std::vector<Path>& one, const std::vector<Path>& other) {
  double most = 0;
  for (std::size_t p = 0; p < one.size(); ++p) {
    for (std::size_t f = 0; f < kFrames; ++f) most = std::max(most, (one[p][f] - other[p][f]).norm());
  }
  return most;
}

// Hocks above the joint that bends a leg most, and below it.
Skeleton withHigherHocks() {
  Skeleton animal = quadrupedWithHocks();
  for (Joint& joint : animal.joints) {
    if (joint.name.ends_with("Hock")) joint.rest.translation.z() = -0.02;
    if (joint.name.ends_with("Three")) joint.rest.translation.z() = 0.12;
  }
  return animal;
}

TEST(MovedLegs, TheseBodiesDiffer) {
  const auto hockCarriesMiddle = [](Skeleton (*made)(), Matching matching) {
    Moved moved(made(), made(), matching);
    const LegSpec leg = moved.goals.legs().front().spec;
    return leg.hock && isAncestorOrSelf(moved.target, *leg.hock, leg.lower);
  };
  EXPECT_FALSE(hockCarriesMiddle(&quadrupedWithHocks, Matching::kNames));
  EXPECT_TRUE(hockCarriesMiddle(&withHigherHocks, Matching::kHocksAbove));
  EXPECT_TRUE(Moved(quadruped(0.5), quadruped(0.4), Matching::kForm).layout.tilts());
  EXPECT_FALSE(Moved(practiceHumanoid(), oddlyBuilt()).layout.tilts());
}

struct Body {
  Skeleton (*made)();
  Matching matching = Matching::kNames;
  Moved moved() const {
    Skeleton source = made();
    for (Joint& joint : source.joints) joint.rest.translation *= joint.name.ends_with("Two") ? 1.3 : 1.2;  // no twin
    return {source, made(), matching};
  }
};

class MovedLegsOf : public ::testing::TestWithParam<Body> {};

TEST_P(MovedLegsOf, GoWhereThePoseHasThem) {
  Moved moved = GetParam().moved();
  ASSERT_FALSE(moved.goals.legs().empty());
  EXPECT_EQ(moved.layout.tilts(), GetParam().matching == Matching::kForm);
  const Changes none(kFrames * moved.layout.perFrame(), 0.0), waves = moved.waves();
  EXPECT_GT(furthestApart(moved.followed(none), moved.followed(waves)), 0.05);
  EXPECT_LT(furthestApart(moved.followed(waves), moved.posed(waves)), 1e-9);
  EXPECT_LT(furthestApart(moved.followed(none), moved.posed(none)), 1e-9);
  moved.legs.solveAll(true);
  EXPECT_LT(furthestApart(moved.followed(none), moved.posed(none)), 1e-9);
}

TEST_P(MovedLegsOf, FollowTheirSlopes) {
  Moved moved = GetParam().moved();
  ChangedMotion now;
  now.changes = moved.waves();
  now.paths = moved.followed(now.changes);
  moved.legs.findSlopes(moved.layout, 1e-4, now);
  Changes further = now.changes;
  for (std::size_t f = 0; f < kFrames; ++f) {
    for (std::size_t leg = 0; leg < moved.layout.legs(); ++leg) further[moved.layout.foot(f, leg) + 1] += 1e-3;
  }
  const std::vector<Path> there = moved.followed(further);
  for (std::size_t f = 0; f < kFrames; ++f) {
    for (std::size_t leg = 0; leg < moved.layout.legs(); ++leg) {
      for (std::size_t bone = 0; bone < 2; ++bone) {
        const Vec3 turned = there[1 + 2 * leg + bone][f] - now.bone(leg, bone)[f];
        EXPECT_LT((turned - 1e-3 * now.slopes[leg][bone][f].col(1)).norm(), 0.05 * turned.norm() + 1e-5);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, MovedLegsOf,
                         ::testing::Values(Body{&oddlyBuilt}, Body{&quadrupedWithHocks},
                                           Body{&withHigherHocks, Matching::kHocksAbove},
                                           Body{&quadrupedWithHocks, Matching::kForm}));

TEST(MovedLegs, SayWhereFeetThatStandAreOutOfReach) {
  Moved moved(practiceHumanoid(), oddlyBuilt());
  Changes changes(kFrames * moved.layout.perFrame(), 0.0);
  changes[moved.layout.foot(7, 1) + 1] = -1;
  std::vector<Path> paths;
  EXPECT_TRUE(moved.legs.follow(moved.layout, changes, moved.feet, paths));
  moved.feet[7 * 2 + 1].planted = true;
  EXPECT_FALSE(moved.legs.follow(moved.layout, changes, moved.feet, paths));
}

}  // namespace
}  // namespace limber
