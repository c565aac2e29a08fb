#include "limber/session/drag/live_character.h"

#include <chrono>

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/session/session.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

Session standingPerson() {
  Session session;
  Progress progress;
  session.open(testing::namedPersonGlb(), "person.glb", progress);
  return session;
}

// As the whole motion retargeted at once, which knows when feet will come to a stop and smooths what comes out: a
// hundredth of the person's height off in the mean, and a twentieth at most, by feet that are about to.
TEST(LiveCharacter, FollowsAsAWholeMotionDoes) {
  Session session = standingPerson();
  const Skeleton& skeleton = session.state().rig->skeleton();
  const Motion walk = makeSampleMotion("walk");
  RetargetOptions options;
  options.characterOnGround = true;
  const SkeletonMap map = matchSkeletons(walk.skeleton, skeleton);
  const Clip whole =
      retargetClip(findRetargetMethod("limb-ik"), walk.skeleton, walk.clips[0], skeleton, map, options, 60);
  session.beginLive(walk.skeleton);
  const PoseSequence frames = sampleFrames(walk.skeleton, walk.clips[0], 60);
  const auto begun = std::chrono::steady_clock::now();
  double farthest = 0, sum = 0;
  for (std::size_t f = 0; f < frames.poses.size(); ++f) {
    const double seconds = static_cast<double>(f) / 60;
    session.showLive(frames.poses[f], 100 + seconds);
    Pose wanted = restPose(skeleton);
    sampleClip(whole, seconds, wanted);
    const std::vector<Vec3> a = posePositions(skeleton, wanted), b = posePositions(skeleton, session.state().pose);
    for (std::size_t j = 0; j < a.size(); ++j) {
      const double off = (a[j] - b[j]).norm();
      farthest = std::max(farthest, off);
      sum += off / static_cast<double>(a.size() * frames.poses.size());
    }
  }
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begun;
  RecordProperty("milliseconds_a_frame", std::to_string(taken.count() / static_cast<double>(frames.poses.size())));
  RecordProperty("farthest", std::to_string(farthest));
  RecordProperty("mean", std::to_string(sum));
  EXPECT_LT(farthest, 1.7 / 20);
  EXPECT_LT(sum, 1.7 / 100);
}

TEST(LiveCharacter, LeavesNothingBehind) {
  Session session = standingPerson();
  const Pose before = session.state().pose;
  const std::size_t commands = session.record().size();
  const auto isAsBefore = [&] {
    for (std::size_t j = 0; j < before.locals.size(); ++j) {
      if (session.state().pose.locals[j].rotation.coeffs() != before.locals[j].rotation.coeffs()) return false;
    }
    return true;
  };
  const Motion walk = makeSampleMotion("walk");
  const PoseSequence frames = sampleFrames(walk.skeleton, walk.clips[0], 30);
  const auto live = [&] {
    session.beginLive(walk.skeleton);
    for (std::size_t f = 0; f < 10; ++f) session.showLive(frames.poses[f], static_cast<double>(f) / 30);
    EXPECT_FALSE(isAsBefore());
  };
  live();
  EXPECT_EQ(session.fork().state().pose.locals[0].translation, before.locals[0].translation);
  const Motion recorded = session.recordedLive();
  ASSERT_EQ(recorded.clips.size(), 1u);
  EXPECT_NEAR(recorded.clips[0].duration(), 9.0 / 30, 1e-6);
  session.endLive();
  EXPECT_TRUE(isAsBefore());
  EXPECT_FALSE(session.canUndo());
  EXPECT_EQ(session.record().size(), commands);
  EXPECT_THROW(session.showLive(frames.poses[0], 1), Error);
  EXPECT_THROW(session.recordedLive(), Error);
  live();
  Progress progress;
  session.run(AddClip{"mine"}, progress);  // any command ends it
  EXPECT_TRUE(isAsBefore());
}

TEST(LiveCharacter, RefusesWhatDoesNotFit) {
  Session session = standingPerson();
  Skeleton point;
  point.joints.push_back({"point", {}, {}, 0});
  EXPECT_THROW(session.beginLive(point), Error);
  EXPECT_THROW(Session().beginLive(point), Error);
  session.beginLive(makeSampleMotion("walk").skeleton);
  EXPECT_THROW(session.showLive(Pose{}, 0), Error);
  Progress progress;
  BeginDrag drag;
  drag.joint = session.state().rig->skeleton().joints[1].name;
  session.run(drag, progress);
  EXPECT_THROW(session.beginLive(makeSampleMotion("walk").skeleton), Error);
}

}  // namespace
}  // namespace limber
