#include "limber/document/scene/grid_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace limber {
namespace {

// A bent sheet with vertices at no regular distances, 1.8 long.
std::vector<double> organic(std::size_t count) {
  std::mt19937 random(5);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = 1e-9 * (random() % 1000000000), v = 1e-9 * (random() % 1000000000);
    for (const double value : {1.8 * u - 0.9, 1.2 * v, 0.4 * std::sin(5 * u + v)}) values.push_back(value);
  }
  return values;
}

std::vector<float> mapped(const std::vector<double>& values, const std::function<double(double)>& map) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(map(value)));
  return result;
}

TEST(GridStep, FloatsThatWereDecodedFromAGridShowIt) {
  for (int bits = 8; bits <= 14; ++bits) {
    const double step = 1.8 / (std::ldexp(1.0, bits) - 1);
    const auto grid = [&](double value) { return 0.013 + step * std::round(value / step); };
    EXPECT_NEAR(gridStep(mapped(organic(3000), grid), {}), step, 1e-2 * step) << bits << " bits";
    EXPECT_NEAR(gridStep(mapped(organic(200000), grid), {}), step, 1e-2 * step) << bits << " bits";
  }
}

// Stores 14 bits in normalised 16: the upper bits are repeated in the lowest ones.
TEST(GridStep, AGridThatIsCoarserThanTheIntegersShowsInThem) {
  const auto grid = [](double value) {
    const auto level = static_cast<int>(std::round(std::abs(0.8 * value) * 8191));
    return std::copysign(((level << 2) | (level >> 11)) / 32767.0, value);
  };
  EXPECT_NEAR(gridStep(mapped(organic(3000), grid), {3000, 3, ComponentType::kI16, true}), 4.0 / 32767, 0.1 / 32767);
}

// As encoders write a small mesh: its box has all levels.
TEST(GridStep, AGridOverTheirOwnBoxShowsInFewValues) {
  for (const std::size_t count : {20u, 300u}) {
    const std::vector<double> values = organic(count);
    std::array<double, 3> low, high;
    low.fill(1e9);
    high.fill(-1e9);
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], values[i]);
      high[i % 3] = std::max(high[i % 3], values[i]);
    }
    const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    for (int bits = 8; bits <= 14; ++bits) {
      std::vector<float> decoded, integers;
      const double levels = std::ldexp(1.0, bits) - 1, half = std::ldexp(1.0, bits - 1) - 1;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double level = std::round((values[i] - low[i % 3]) / side * levels);
        decoded.push_back(static_cast<float>(low[i % 3] + level * side / levels));
        const double middle = (values[i] - 0.5 * (low[i % 3] + high[i % 3])) / (0.5 * side);
        integers.push_back(static_cast<float>(std::round(std::round(middle * half) / half * 32767) / 32767));
      }
      EXPECT_NEAR(gridStep(decoded, {}), side / levels, 1e-3 * side / levels) << count << ", " << bits;
      const AccessorInfo normalised{static_cast<Index>(count), 3, ComponentType::kI16, true};
      EXPECT_NEAR(gridStep(integers, normalised), 1 / half, 1e-3 / half) << count << ", " << bits;
    }
  }
}

TEST(GridStep, IntegersAreAGridHoweverFewThereAre) {
  const std::vector<float> corners = {0, 0, 0, 90, 0, 0, 0, 70, 20};
  EXPECT_EQ(gridStep(corners, {3, 3, ComponentType::kU16, false}), 1);
  EXPECT_EQ(gridStep(corners, {3, 3, ComponentType::kI8, false}), 1);
  const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 1};
  EXPECT_EQ(gridStep(triangle, {3, 3, ComponentType::kI16, true}), 1.0 / 32767);
  EXPECT_EQ(gridStep(triangle, {3, 3, ComponentType::kU8, true}), 1.0 / 255);
}

TEST(GridStep, FloatsThatLieAnywhereAreNoGrid) {
  EXPECT_EQ(gridStep(mapped(organic(5000), [](double value) { return value; }), {}), 0);
  EXPECT_EQ(gridStep(mapped(organic(50), [](double value) { return value; }), {}), 0);
  EXPECT_EQ(gridStep(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 1}, {}), 0);
  EXPECT_EQ(gridStep({}, {}), 0);
  std::vector<float> box;  // cubes of a few centimetres, as games are built from
  for (int i = 0; i < 30 * 30 * 30; ++i) {
    for (const int value : {i % 30, i / 30 % 30, i / 900}) box.push_back(0.05f * static_cast<float>(value));
  }
  EXPECT_EQ(gridStep(box, {}), 0);
}

}  // namespace
}  // namespace limber
