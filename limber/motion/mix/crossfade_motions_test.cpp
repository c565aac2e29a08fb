#include "limber/motion/mix/crossfade_motions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/error.h"
#include "limber/motion/mix/hold_pose.h"
#include "limber/motion/mix/testing/sample_clip.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/motion.h"

namespace limber {
namespace {

using limber::testing::jointPaths;
using limber::testing::sampleClip;

class CrossfadeMotions : public ::testing::Test {
 protected:
  static Vec3 headingAt(const std::vector<std::vector<Vec3>>& frames, std::size_t from, std::size_t to) {
    Vec3 displacement = frames[to][0] - frames[from][0];
    displacement.y() = 0;
    return displacement.normalized();
  }

  const Skeleton skeleton = limber::testing::sampleSkeleton();
  const ClipWithContacts walk = sampleClip("walk"), run = sampleClip("run");
};

TEST_F(CrossfadeMotions, GoesOnWhereItIsAndAsItHeads) {
  // The run begins elsewhere and heads elsewhere.
  Clip aside = turnClip(run.clip, skeleton, Quat(Eigen::AngleAxisd(2.0, Vec3::UnitY())));
  for (Track<Vec3f>& track : aside.translations) {
    for (Vec3f& value : track.values) value += track.joint == 0 ? Vec3f(5, 0, -7) : Vec3f(0, 0, 0);
  }
  const ClipWithContacts both = crossfadeMotions(skeleton, walk, {aside, {}}, {0.3, std::nullopt});
  const auto frames = jointPaths(skeleton, both.clip), first = jointPaths(skeleton, walk.clip);
  EXPECT_LT((headingAt(frames, 0, 60) - headingAt(frames, frames.size() - 43, frames.size() - 1)).norm(), 0.02);
  // Nothing is faster from frame to frame than it is in the run.
  double fastest = 0, fastestOfRun = 0;
  for (std::size_t f = 1; f < frames.size(); ++f) {
    for (std::size_t j = 0; j < frames[f].size(); ++j) {
      fastest = std::max(fastest, (frames[f][j] - frames[f - 1][j]).norm());
    }
  }
  const auto ran = jointPaths(skeleton, run.clip);
  for (std::size_t f = 1; f < ran.size(); ++f) {
    for (std::size_t j = 0; j < ran[f].size(); ++j) {
      fastestOfRun = std::max(fastestOfRun, (ran[f][j] - ran[f - 1][j]).norm());
    }
  }
  EXPECT_LT(fastest, 1.05 * fastestOfRun);
  // The first is as it was until a second before the earliest transition.
  for (std::size_t f = 0; f < 60; ++f) {
    for (std::size_t j = 0; j < frames[f].size(); ++j) ASSERT_LT((frames[f][j] - first[f][j]).norm(), 1e-5);
  }
}

TEST_F(CrossfadeMotions, FeetSlideNoMoreAndNothingIsRougher) {
  const std::pair<ClipWithContacts, ClipWithContacts> pairs[] = {
      {walk, run}, {run, walk}, {walk, walk}, {sampleClip("sneak"), walk}};
  for (const auto& [a, b] : pairs) {
    SCOPED_TRACE(a.clip.name + " " + b.clip.name);
    for (const double seconds : {0.2, 0.5}) {
      const Clip clip = crossfadeMotions(skeleton, a, b, {seconds, std::nullopt}).clip;
      const double slide =
          std::max(limber::testing::toesSlide(skeleton, a.clip), limber::testing::toesSlide(skeleton, b.clip));
      const double jerk =
          std::max(limber::testing::jerkOf(skeleton, a.clip), limber::testing::jerkOf(skeleton, b.clip));
      EXPECT_LT(limber::testing::toesSlide(skeleton, clip), slide + 0.01) << seconds;
      EXPECT_LT(limber::testing::jerkOf(skeleton, clip), 1.1 * jerk) << seconds;
    }
  }
}

// A loop into itself goes on as if nothing were.
TEST_F(CrossfadeMotions, AWalkIntoItselfIsAWalk) {
  const Clip clip = crossfadeMotions(skeleton, walk, walk, {0.3, std::nullopt}).clip;
  const auto frames = jointPaths(skeleton, clip);
  const Index toes = skeleton.find("leftToes").value();
  for (std::size_t f = 66; f < frames.size(); ++f) {  // a stride later: 1.2 m further
    EXPECT_NEAR((frames[f][toes] - frames[f - 66][toes]).z(), 1.2, 0.01) << f;
  }
}

TEST_F(CrossfadeMotions, AllAreJoinedAndLastAsLongAsAllLessTheTransitions) {
  const ClipWithContacts all[] = {walk, run, walk};
  const auto [joined, spans] = joinMotions(skeleton, all, {0.3, std::nullopt});
  const double sum = 2 * walk.clip.duration() + run.clip.duration();
  EXPECT_LT(joined.clip.duration(), sum);
  EXPECT_GT(joined.clip.duration(), sum - 2 * (0.3 + 2));  // at most a second of each side is left out
  EXPECT_EQ(joined.feet.size(), 2u);
  checkClip(joined.clip, skeleton);
  const ClipWithContacts one[] = {walk};
  const JoinedMotions alone = joinMotions(skeleton, one);
  EXPECT_EQ(alone.motion.clip.duration(), walk.clip.duration());
  ASSERT_EQ(alone.spans.size(), 1u);
  EXPECT_EQ(alone.spans[0].to, walk.clip.duration());

  // Each plays until the next one, that begins before, plays alone.
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_EQ(spans[0].from, 0);
  EXPECT_NEAR(spans[2].to, joined.clip.duration(), 1e-9);
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
    EXPECT_NEAR(spans[i].to - spans[i + 1].from, 0.3, 1.0 / 60) << i;
    EXPECT_LT(spans[i].from, spans[i + 1].from);
  }
}

TEST_F(CrossfadeMotions, AShortMotionBetweenTwoIsNotLeftOut) {
  for (const char* name : {"jump", "walk", "run"}) {
    SCOPED_TRACE(name);
    const ClipWithContacts all[] = {walk, {trimClip(sampleClip(name).clip, 0, 0.8), {}}, run};
    const auto [joined, spans] = joinMotions(skeleton, all, {0.3, std::nullopt});
    ASSERT_EQ(spans.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(spans[i].from, spans[i].to) << i;
      if (i == 0) continue;
      EXPECT_LT(spans[i - 1].from, spans[i].from) << i;
      EXPECT_LT(spans[i - 1].to, spans[i].to) << i;
    }
  }
}

TEST_F(CrossfadeMotions, KeysMayBeFartherApartThanTheTransitionIsLong) {
  const ClipWithContacts sparse{resampleClip(walk.clip, 2), {}};
  const Clip clip = crossfadeMotions(skeleton, sparse, sparse, {0.3, std::nullopt}).clip;
  EXPECT_NEAR(frameRateOf(clip), 30, 1e-3);
}

TEST_F(CrossfadeMotions, ATransitionMayLastNearlyAsLongAsAMotion) {
  const Clip second = resampleClip(trimClip(walk.clip, 0, 1), 30);
  for (const double seconds : {0.97, 0.99}) {
    EXPECT_NEAR(crossfadeMotions(skeleton, {second, {}}, {second, {}}, {seconds, 30}).clip.duration(), 1, 0.1);
  }
}

TEST_F(CrossfadeMotions, ATransitionIsNoLongerThanItsMotionsAndOfOneBetweenTwoTakesHalf) {
  const ClipWithContacts brief{resampleClip(trimClip(walk.clip, 0, 0.2), 60), {}};
  const auto join = [&](std::vector<ClipWithContacts> all, double seconds, std::vector<double> lengths) {
    Warnings warnings;
    const std::vector<TimeSpan> spans = joinMotions(skeleton, all, {seconds, std::nullopt}, &warnings).spans;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      EXPECT_NEAR(spans[i].to - spans[i + 1].from, lengths[i], 1.5 / 60) << i;
    }
    ASSERT_EQ(warnings.items().size(), 1u);
    EXPECT_EQ(warnings.items()[0].kind, "short-transitions");
    EXPECT_EQ(warnings.items()[0].count, lengths.size());
  };
  join({brief, walk}, 0.3, {0.2});
  join({walk, brief}, 0.3, {0.2});
  join({walk, brief, run}, 0.3, {0.1, 0.1});
  const ClipWithContacts aFrameShort{resampleClip(trimClip(walk.clip, 0, 35 / 60.0), 60), {}};
  join({aFrameShort, walk}, 0.6, {35 / 60.0});
  join({walk, run}, 5, {std::min(walk.clip.duration(), run.clip.duration())});
}

TEST_F(CrossfadeMotions, TwoFramesAreEnough) {
  const ClipWithContacts two{resampleClip(trimClip(walk.clip, 0, 1.0 / 30), 30), {}};
  const std::vector<std::vector<ClipWithContacts>> rows = {{two, walk}, {walk, two}, {walk, two, run}, {two, two, two}};
  for (const std::vector<ClipWithContacts>& row : rows) {
    for (const double rate : {30.0, 60.0}) EXPECT_NO_THROW(joinMotions(skeleton, row, {0.3, rate}));
  }
}

// As where retargeting has spread the T-pose at the beginning of a recording over several frames.
TEST_F(CrossfadeMotions, OneFirstPoseIsLeftOutHoweverManyAreJoined) {
  ClipWithContacts jumps = walk;
  for (Track<Vec3f>& track : jumps.clip.translations) {
    if (track.joint == 0) track.values[0].y() += 4, track.values[1].y() += 2;
  }
  const ClipWithContacts all[] = {jumps, walk, walk};
  const Clip one = crossfadeMotions(skeleton, jumps, walk).clip, two = joinMotions(skeleton, all).motion.clip;
  const auto ofOne = jointPaths(skeleton, one), ofTwo = jointPaths(skeleton, two);
  for (std::size_t f = 0; f < 60; ++f) ASSERT_LT((ofOne[f][0] - ofTwo[f][0]).norm(), 1e-4) << f;
}

TEST_F(CrossfadeMotions, APoseIsHeldForItsTransitions) {
  const ClipWithContacts pose = holdPose(skeleton, sampleClip("idle").clip, 0, 1 / 30.0);
  const std::vector<std::vector<ClipWithContacts>> rows = {{pose, walk}, {walk, pose}, {walk, pose, run}, {pose, pose}};
  for (const std::vector<ClipWithContacts>& row : rows) {
    Warnings warnings;
    const auto [joined, spans] = joinMotions(skeleton, row, {0.3, std::nullopt}, &warnings);
    EXPECT_TRUE(warnings.empty());
    for (std::size_t i = 0; i + 1 < row.size(); ++i) EXPECT_NEAR(spans[i].to - spans[i + 1].from, 0.3, 1e-6) << i;
    checkClip(joined.clip, skeleton);
  }
}

TEST_F(CrossfadeMotions, ATransitionOfLessThanAFrameIsRefused) {
  EXPECT_THROW(crossfadeMotions(skeleton, walk, run, {0, std::nullopt}), Error);
  EXPECT_THROW(crossfadeMotions(skeleton, walk, run, {std::nan(""), std::nullopt}), Error);
  EXPECT_THROW(joinMotions(skeleton, {}), Error);
}

}  // namespace
}  // namespace limber
