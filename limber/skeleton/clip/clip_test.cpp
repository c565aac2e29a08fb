#include "limber/skeleton/clip/clip.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/text/numbers.h"

namespace limber {
namespace {

Skeleton twoJoints() {
  Skeleton skeleton;
  skeleton.joints.resize(2);
  skeleton.joints[0].name = "root";
  skeleton.joints[1].name = "tip";
  skeleton.joints[1].parent = 0;
  skeleton.joints[1].rest.translation = Vec3(0, 1, 0);
  return skeleton;
}

Eigen::Quaternionf aboutZ(double degrees) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(degrees * kDegree), Vec3f::UnitZ()));
}

Track<Vec3f> slide(Interpolation interpolation) {
  return {1, interpolation, {1, 3}, {Vec3f(0, 0, 0), Vec3f(4, 0, 0)}};
}

Vec3 tipAt(const Clip& clip, double seconds) {
  Pose pose = restPose(twoJoints());
  sampleClip(clip, seconds, pose);
  return pose.locals[1].translation;
}

TEST(Clip, LinearValuesLieOnTheLine) {
  Clip clip;
  clip.translations.push_back(slide(Interpolation::kLinear));
  EXPECT_DOUBLE_EQ(clip.duration(), 3);
  EXPECT_EQ(tipAt(clip, 0), Vec3(0, 0, 0));
  EXPECT_EQ(tipAt(clip, 1), Vec3(0, 0, 0));
  EXPECT_EQ(tipAt(clip, 1.5), Vec3(1, 0, 0));
  EXPECT_EQ(tipAt(clip, 3), Vec3(4, 0, 0));
  EXPECT_EQ(tipAt(clip, 9), Vec3(4, 0, 0));
}

TEST(Clip, StepsHoldTheKeyBefore) {
  Clip clip;
  clip.translations.push_back(slide(Interpolation::kStep));
  EXPECT_EQ(tipAt(clip, 0.5), Vec3(0, 0, 0));
  EXPECT_EQ(tipAt(clip, 2.999), Vec3(0, 0, 0));
  EXPECT_EQ(tipAt(clip, 3), Vec3(4, 0, 0));
}

// Key times are single precision: k / 60 may be a little less as a double.
TEST(Clip, StepsShowEachKeyAtItsFrame) {
  for (const double rate : {24.0, 30.0, 60.0, 120.0}) {
    Track<Vec3f> track{1, Interpolation::kStep, {}, {}};
    constexpr int kFrames = 3000;
    for (int k = 0; k < kFrames; ++k) {
      track.times.push_back(static_cast<float>(k / rate));
      track.values.emplace_back(static_cast<float>(k), 0, 0);
    }
    for (int k = 0; k < kFrames; ++k) {
      EXPECT_EQ(sampleTrack(track, k / rate).x(), k) << rate;
      EXPECT_EQ(sampleTrack(track, k * (1 / rate)).x(), k) << rate;
      EXPECT_EQ(sampleTrack(track, (k - 0.01) / rate).x(), std::max(0, k - 1)) << rate;
    }
  }
}

TEST(Clip, CubicsReproduceACubicPolynomial) {
  const auto f = [](double t) { return t * t * t - 2 * t * t + 3; };
  const auto slope = [](double t) { return 3 * t * t - 4 * t; };
  Track<Vec3f> track{1, Interpolation::kCubic, {0.5f, 2.0f}, {}};
  for (const double t : {0.5, 2.0}) {
    track.values.push_back(Vec3f(static_cast<float>(slope(t)), 0, 0));
    track.values.push_back(Vec3f(static_cast<float>(f(t)), 0, 0));
    track.values.push_back(Vec3f(static_cast<float>(slope(t)), 0, 0));
  }
  Clip clip;
  clip.translations.push_back(track);
  checkClip(clip, twoJoints());
  for (const double t : {0.5, 0.9, 1.3, 1.999, 2.0}) EXPECT_NEAR(tipAt(clip, t).x(), f(t), 1e-6) << t;
}

TEST(Clip, RotationsTurnEvenlyTheShortWay) {
  Clip clip;
  Eigen::Quaternionf end = aboutZ(90);
  end.coeffs() *= -1;  // the same rotation, as the quaternion on the longer path
  clip.rotations.push_back({1, Interpolation::kLinear, {0, 1}, {aboutZ(0), end}});
  Pose pose = restPose(twoJoints());
  sampleClip(clip, 0.25, pose);
  EXPECT_LT(pose.locals[1].rotation.angularDistance(aboutZ(22.5).cast<double>()), 1e-6);
  EXPECT_EQ(pose.locals[1].translation, Vec3(0, 1, 0)) << "parts without a track stay";
}

TEST(Clip, CubicRotationsAreOfUnitLength) {
  const Eigen::Quaternionf none(0, 0, 0, 0);
  Clip clip;
  clip.rotations.push_back({1, Interpolation::kCubic, {0, 1}, {none, aboutZ(0), none, none, aboutZ(120), none}});
  Pose pose = restPose(twoJoints());
  sampleClip(clip, 0.5, pose);
  EXPECT_NEAR(pose.locals[1].rotation.norm(), 1, 1e-12);
  EXPECT_LT(pose.locals[1].rotation.angularDistance(aboutZ(60).cast<double>()), 1e-6);
}

TEST(Clip, BadTracksAreNamed) {
  const Skeleton skeleton = twoJoints();
  const auto message = [&](const Track<Vec3f>& track) {
    Clip clip;
    clip.translations = {slide(Interpolation::kStep), track};
    clip.translations[0].joint = 0;
    try {
      checkClip(clip, skeleton);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Track<Vec3f> good = slide(Interpolation::kLinear);
  EXPECT_EQ(message(good), "");
  for (const auto& spoil : std::initializer_list<void (*)(Track<Vec3f>&)>{
           [](Track<Vec3f>& t) { t.joint = 2; }, [](Track<Vec3f>& t) { t.joint = 0; },
           [](Track<Vec3f>& t) { t.times[1] = 1; }, [](Track<Vec3f>& t) { t.times[0] = NAN; },
           [](Track<Vec3f>& t) { t.values.pop_back(); }, [](Track<Vec3f>& t) { t.values[0].y() = INFINITY; },
           [](Track<Vec3f>& t) { t.times.clear(), t.values.clear(); }}) {
    Track<Vec3f> bad = good;
    spoil(bad);
    EXPECT_NE(message(bad).find("translation track 1"), std::string::npos) << message(bad);
  }
}

}  // namespace
}  // namespace limber
