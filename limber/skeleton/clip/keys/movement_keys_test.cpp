#include "limber/skeleton/clip/keys/movement_keys.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/skeleton/clip/keys/key_rounding.h"

namespace limber {
namespace {

TEST(MovementKeys, AreAsManyAsTheBoundTakes) {
  const MovingTransform round = [](double seconds) {
    Transform local;
    local.rotation = Quat(Eigen::AngleAxisd(2 * seconds * seconds, Vec3::UnitY()));
    local.translation = Vec3(std::cos(seconds), 0, std::sin(seconds));
    return local;
  };
  for (const double most : {1e-3, 1e-5}) {
    Clip clip;
    MovementKeys(round, {1, 0, 1, 0.5f}, 2, most).writeTo(clip, 3, true);
    const Track<Vec3f>& positions = clip.translations.at(0);
    EXPECT_EQ(positions.joint, 3U);
    EXPECT_EQ(clip.scales.at(0).times.size(), 1U);
    for (double seconds = 0; seconds <= 1; seconds += 0.0013) {
      const Transform wanted = round(seconds);
      EXPECT_LT((sampleTrack(positions, seconds) - wanted.translation).norm(), 2 * most + 1e-6);
      EXPECT_LT(sampleTrack(clip.rotations.at(0), seconds).angularDistance(wanted.rotation), most + 1e-6);
    }
    EXPECT_LT(positions.times.size(), most > 1e-4 ? 80U : 800U);
  }
}

TEST(MovementKeys, AStepHasTwoTimes) {
  const Track<Vec3f> track{0, Interpolation::kStep, {0, 1}, {Vec3f::Zero(), Vec3f::Ones()}};
  std::vector<float> times;
  addKeyTimes(track, times);
  EXPECT_EQ(times, (std::vector<float>{0, static_cast<float>(justBefore(1)), 1}));
}

}  // namespace
}  // namespace limber
