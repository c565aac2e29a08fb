#include "limber/retarget/root_motion.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;

// The rest pose of `target`, placed where `source` stands when moved by `way` from rest.
Vec3 placedPelvis(const Skeleton& source, const Skeleton& target, const Vec3& way, const RetargetOptions& options) {
  const RetargetSetup setup(source, target, matchSkeletons(source, target), options);
  const RootPlacer placer(setup);
  Pose from = restPose(source), to = restPose(target);
  from.locals[source.find("hips").value()].translation += way;
  BodyFrame fromFrame, toFrame;
  setup.sourceKinematics.globals(from, fromFrame);
  setup.targetKinematics.globals(to, toFrame);
  placer.place(from, fromFrame, to, toFrame);
  BodyFrame again;
  setup.targetKinematics.globals(to, again);
  for (Index j = 0; j < target.jointCount(); ++j) {
    EXPECT_LT((again.positions[j] - toFrame.positions[j]).norm(), 1e-12) << "the frame is up to date";
  }
  return pelvisOf(setup.map, MapSide::kTarget, toFrame.positions);
}

TEST(RootMotion, TheWayScalesWithTheHips) {
  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const Vec3 way(0.4, -0.1, 1.2);
  for (const RootScale scale : {RootScale::kHipHeight, RootScale::kLegLength, RootScale::kNone}) {
    RetargetOptions options;
    options.rootScale = scale;
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options);
    const Vec3 moved = placedPelvis(person, odd, way, options) - placedPelvis(person, odd, Vec3::Zero(), options);
    EXPECT_LT((moved - setup.scale * way).norm(), 1e-9);
  }
}

TEST(RootMotion, ThePelvisMovesByWhatIsAsked) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::withOtherAxes(oddlyBuilt());
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPlacer placer(setup);
  Pose pose = restPose(odd);
  BodyFrame frame;
  setup.targetKinematics.globals(pose, frame);
  const BodyFrame before = frame;
  const Vec3 shift(0.1, -0.2, 0.3);
  placer.movePelvis(shift, pose, frame);
  const Index hips = setup.map.find("hips")->target.front(), hand = setup.map.find("leftHand")->target.front();
  EXPECT_LT((frame.positions[hips] - before.positions[hips] - shift).norm(), 1e-12);
  EXPECT_LT((frame.positions[hand] - before.positions[hand] - shift).norm(), 1e-12);
}

}  // namespace
}  // namespace limber
