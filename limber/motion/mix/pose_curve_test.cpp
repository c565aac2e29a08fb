#include "limber/motion/mix/pose_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber {
namespace {

// One joint on a parabola, turning evenly.
Pose poseAt(double seconds) {
  Transform local;
  local.translation = {seconds, 3 * seconds * seconds, 1 - seconds};
  local.rotation = Eigen::AngleAxisd(2 * seconds, Vec3::UnitY());
  return {{local}};
}

TEST(PoseCurve, FollowsParabolasAndEvenTurnsBetweenFrames) {
  PoseSequence frames{{}, 0.1};
  for (int f = 0; f < 6; ++f) frames.poses.push_back(poseAt(0.1 * f));
  frames.poses[3].locals[0].rotation.coeffs() *= -1;  // the same turn
  const PoseCurve curve(frames);
  Pose pose;
  for (double t = 0; t <= 0.5; t += 0.013) {
    curve.sample(t, pose);
    EXPECT_LT((pose.locals[0].translation - poseAt(t).locals[0].translation).norm(), 1e-12) << t;
    EXPECT_LT(pose.locals[0].rotation.angularDistance(poseAt(t).locals[0].rotation), 2e-4) << t;
  }
  curve.sample(9, pose);
  EXPECT_EQ(pose.locals[0].translation, frames.poses.back().locals[0].translation);
}

TEST(PoseCurve, TwoFramesAreAStraightLine) {
  const PoseSequence frames{{poseAt(0), poseAt(0.1)}, 0.1};
  Pose pose;
  PoseCurve(frames).sample(0.025, pose);
  EXPECT_NEAR(pose.locals[0].translation.y(), 0.25 * 0.03, 1e-12);
}

}  // namespace
}  // namespace limber
