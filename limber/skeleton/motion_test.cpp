#include "limber/skeleton/motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber {
namespace {

Clip clipAtRate(double rate, Index frames) {
  Clip clip;
  Track<Vec3f> track;
  for (Index k = 0; k < frames; ++k) {
    track.times.push_back(static_cast<float>(k / rate));
    track.values.emplace_back(Vec3f::Constant(static_cast<float>(k)));
  }
  clip.translations.push_back(track);
  return clip;
}

TEST(Motion, FindsTheRateThatKeysWereWrittenAt) {
  for (const double rate : {1.0, 12.0, 24.0, 30.0, 59.94, 60.0, 100.0, 120.0, 1000.0}) {
    const Clip clip = clipAtRate(rate, 3000);
    ASSERT_TRUE(measuredFrameRate(clip));
    // Times in single precision: half an ulp at the middle of the clip.
    EXPECT_NEAR(*measuredFrameRate(clip), rate, 5e-4 * rate) << rate;
    EXPECT_EQ(frameCount(clip, rate), 3000u) << rate;
  }
  EXPECT_EQ(*measuredFrameRate(clipAtRate(30, 3000)), 30);
  Clip cut = clipAtRate(30, 100);
  cut.translations[0].times.back() -= 0.02f;
  EXPECT_EQ(*measuredFrameRate(cut), 30) << "a clip may end between two frames";
}

TEST(Motion, MeasuresTheTrackWithTheMostKeys) {
  Clip clip = clipAtRate(50, 100);
  Track<Eigen::Quaternionf> slow;
  slow.times = {0, 1, 2};
  slow.values.assign(3, Eigen::Quaternionf::Identity());
  clip.rotations.push_back(slow);
  EXPECT_EQ(*measuredFrameRate(clip), 50);
}

TEST(Motion, HasNoRateWithoutTwoKeys) {
  EXPECT_FALSE(measuredFrameRate({}));
  EXPECT_FALSE(measuredFrameRate(clipAtRate(30, 1)));
  EXPECT_EQ(frameCount(clipAtRate(30, 1), 30), 1u);
  EXPECT_EQ(frameCount({}, 30), 1u);
}

TEST(Motion, CountsFramesUpToHalfAFrameBeyond) {
  Clip clip = clipAtRate(10, 2);
  for (const auto& [duration, frames] : {std::pair{1.0f, 11u}, {1.04f, 11u}, {1.06f, 12u}, {0.96f, 11u}}) {
    clip.translations[0].times[1] = duration;
    EXPECT_EQ(frameCount(clip, 10), frames) << duration;
  }
}

TEST(Motion, EachClipHasItsOwnRate) {
  Motion motion;
  motion.clips = {clipAtRate(24, 48), clipAtRate(119.875, 300), clipAtRate(24, 1)};
  motion.framesPerSecond = 24.0001;  // as the file writes it
  EXPECT_EQ(frameRateOf(motion, 0), 24.0001);
  EXPECT_NEAR(frameRateOf(motion, 1), 119.875, 0.01);
  EXPECT_EQ(frameRateOf(motion, 2), 24.0001) << "one key does not tell";
  EXPECT_EQ(frameRateOf(motion.clips[2]), 30);
}

TEST(Motion, WorksOnSparseKeysMoreOften) {
  const auto rate = [](double keys) { return denseFrameRateOf(clipAtRate(keys, 50)); };
  for (const double usual : {20.0, 24.0, 25.0, 30.0, 60.0, 120.0}) EXPECT_EQ(rate(usual), usual);
  EXPECT_EQ(rate(4), 32);
  EXPECT_EQ(rate(2), 30);
  EXPECT_EQ(rate(15), 30);
}

TEST(Motion, RefusesRatesThatAreNone) {
  const Clip clip = clipAtRate(30, 30);
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_THROW(frameCount(clip, rate), Error);
  EXPECT_THROW(frameCount(clip, 1e30), Error);
  Motion motion;
  motion.skeleton.joints.push_back({"a", std::nullopt, {}, 0});
  motion.clips.push_back(clip);
  EXPECT_NO_THROW(checkMotion(motion));
  motion.framesPerSecond = 0;
  EXPECT_THROW(checkMotion(motion), Error);
}

TEST(Motion, NamesTheBadClip) {
  Motion motion;
  motion.skeleton.joints.push_back({"a", std::nullopt, {}, 0});
  motion.clips = {clipAtRate(30, 3), clipAtRate(30, 3)};
  motion.clips[1].name = "jump";
  motion.clips[1].translations[0].joint = 7;
  try {
    checkMotion(motion);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.where().find("'jump'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace limber
