#include "limber/skeleton/clip/keys/key_choice.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

std::vector<double> frames(Index count) {
  std::vector<double> times;
  for (Index i = 0; i < count; ++i) times.push_back(i / 30.0);
  return times;
}

// Even turns from rotation to rotation, and what noise there is.
std::vector<Quat> wander(Index count, std::uint64_t seed) {
  RandomValues random(seed);
  std::vector<Quat> values = {random.rotation()};
  Vec3 speed = 0.02 * random.direction();
  for (Index i = 1; i < count; ++i) {
    speed = 0.9 * speed + 0.01 * random.direction();
    Quat next = Quat(Eigen::AngleAxisd(speed.norm(), speed.normalized())) * values.back();
    if (next.dot(values.back()) < 0) next.coeffs() *= -1;
    values.push_back(next);
  }
  return values;
}

double farthestAngle(const std::vector<double>& times, const std::vector<Quat>& values, Index from, Index to) {
  double worst = 0;
  for (Index i = from; i <= to; ++i) {
    const double u = (times[i] - times[from]) / (times[to] - times[from]);
    worst = std::max(worst, values[from].slerp(u, values[to]).angularDistance(values[i]));
  }
  return worst;
}

// The fewest keys there are: shortest paths over all pairs of frames.
std::size_t fewestKeys(const std::vector<double>& times, const std::vector<Quat>& values, double tolerance) {
  std::vector<std::size_t> keys(values.size(), 1);
  for (Index to = 1; to < values.size(); ++to) {
    keys[to] = keys[to - 1] + 1;
    for (Index from = 0; from + 1 < to; ++from) {
      if (keys[from] + 1 < keys[to] && farthestAngle(times, values, from, to) <= tolerance) keys[to] = keys[from] + 1;
    }
  }
  return keys.back();
}

TEST(ChooseKeys, StaysWithinTheToleranceWithFewKeys) {
  const std::vector<double> times = frames(60);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const std::vector<Quat> values = wander(60, seed);
    for (const double tolerance : {0.002, 0.01, 0.05}) {
      const std::vector<Index> kept = chooseKeys(times, values, tolerance);
      ASSERT_EQ(kept.front(), 0u);
      ASSERT_EQ(kept.back(), 59u);
      for (std::size_t k = 1; k < kept.size(); ++k) {
        ASSERT_LT(kept[k - 1], kept[k]);
        EXPECT_LE(farthestAngle(times, values, kept[k - 1], kept[k]), tolerance * (1 + 1e-3));
      }
      const std::size_t best = fewestKeys(times, values, tolerance);
      EXPECT_GE(kept.size(), best);
      EXPECT_LE(static_cast<double>(kept.size()), 1.15 * static_cast<double>(best) + 1) << seed << ' ' << tolerance;
    }
  }
}

TEST(ChooseKeys, FindsTheCornersOfLines) {
  const std::vector<double> times = frames(40);
  std::vector<Vec3> values;
  for (const double time : times) values.emplace_back(std::abs(time - times[17]), time, 0);
  EXPECT_EQ(chooseKeys(times, values, 1e-9), (std::vector<Index>{0, 17, 39}));
  EXPECT_EQ(chooseKeys(times, values, 10), (std::vector<Index>{0, 39}));
}

TEST(ChooseKeys, OfOneFrame) {
  EXPECT_EQ(chooseKeys(std::vector<double>{0}, std::vector<Vec3>{Vec3::Zero()}, 1), (std::vector<Index>{0}));
}

// Against a dense least squares over hat functions.
TEST(FitKeys, AreTheLeastSquares) {
  const std::vector<double> times = frames(30);
  RandomValues random(3);
  std::vector<Vec3> values;
  for (Index i = 0; i < 30; ++i) values.push_back(random.unitCube());
  const std::vector<Index> kept = {0, 4, 5, 12, 20, 29};
  const std::vector<Vec3> fitted = fitKeys(times, values, kept);
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(30, 6), wanted(30, 3);
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    for (Index i = kept[k]; i <= kept[k + 1]; ++i) {
      const double u = (times[i] - times[kept[k]]) / (times[kept[k + 1]] - times[kept[k]]);
      hats(i, k) = 1 - u, hats(i, k + 1) = u;
    }
  }
  for (Index i = 0; i < 30; ++i) wanted.row(i) = values[i].transpose();
  wanted -= hats.col(0) * values.front().transpose() + hats.col(5) * values.back().transpose();
  const Eigen::MatrixXd best = hats.middleCols(1, 4).colPivHouseholderQr().solve(wanted);
  EXPECT_EQ(fitted.front(), values.front());
  EXPECT_EQ(fitted.back(), values.back());
  for (int k = 0; k < 4; ++k) EXPECT_LT((best.row(k).transpose() - fitted[k + 1]).norm(), 1e-9) << k;
}

TEST(FitKeys, BringRotationsNearer) {
  const std::vector<double> times = frames(60);
  const std::vector<Quat> values = wander(60, 4);
  const std::vector<Index> kept = chooseKeys(times, values, 0.05);
  const std::vector<Quat> fitted = fitKeys(times, values, kept);
  ASSERT_GT(kept.size(), 3u);
  const auto squares = [&](const auto& valueOf) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      for (Index i = kept[k]; i < kept[k + 1]; ++i) {
        const double u = (times[i] - times[kept[k]]) / (times[kept[k + 1]] - times[kept[k]]);
        sum += std::pow(valueOf(k).slerp(u, valueOf(k + 1)).angularDistance(values[i]), 2);
      }
    }
    return sum;
  };
  EXPECT_LT(squares([&](std::size_t k) { return fitted[k]; }),
            0.7 * squares([&](std::size_t k) { return values[kept[k]]; }));
}

}  // namespace
}  // namespace limber
