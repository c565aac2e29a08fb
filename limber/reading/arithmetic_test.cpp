#include "limber/reading/arithmetic.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/random.h"

namespace limber {
namespace {

FloatMatrix randomMatrix(std::size_t rows, std::size_t columns, Random& random) {
  FloatMatrix matrix(rows, columns);
  for (float& value : matrix.values) value = static_cast<float>(random.uniform(-1, 1));
  return matrix;
}

TEST(ReadingArithmetic, ExpIsThatOfTheLibrary) {
  for (double x = -86.9; x < 87.9; x += 0.00731) {
    const auto argument = static_cast<float>(x);
    ASSERT_NEAR(portableExp(argument) / std::exp(static_cast<double>(argument)), 1, 3e-7) << x;
  }
  EXPECT_EQ(portableExp(0), 1);
  EXPECT_EQ(portableExp(-1e30f), portableExp(-87));
  EXPECT_EQ(portableExp(1e30f), portableExp(88));
  EXPECT_EQ(portableExp(std::nanf("")), portableExp(-87));
}

TEST(ReadingArithmetic, SineAndCosineAreThoseOfTheLibrary) {
  for (double x = -100; x < 100; x += 0.00379) {
    const auto argument = static_cast<float>(x);
    const SineCosine value = portableSineCosine(argument);
    ASSERT_NEAR(value.sine, std::sin(static_cast<double>(argument)), 1.2e-7) << x;
    ASSERT_NEAR(value.cosine, std::cos(static_cast<double>(argument)), 1.2e-7) << x;
    const SineCosine mirror = portableSineCosine(-argument);
    ASSERT_EQ(mirror.sine, -value.sine);
    ASSERT_EQ(mirror.cosine, value.cosine);
  }
  EXPECT_TRUE(std::isfinite(portableSineCosine(1e30f).sine));
  EXPECT_TRUE(std::isfinite(portableSineCosine(std::nanf("")).sine));
}

// Whatever lies in one tile: the bits of the plain loop.
TEST(ReadingArithmetic, ProductsHaveTheBitsOfThePlainLoop) {
  Random random(3);
  for (std::size_t rows = 0; rows < 10; ++rows) {
    for (std::size_t outputs = 1; outputs < 24; ++outputs) {
      const std::size_t inputs = 1 + random.below(30);
      const FloatMatrix x = randomMatrix(rows, inputs, random), weight = randomMatrix(inputs, outputs, random);
      const FloatMatrix bias = randomMatrix(1, outputs, random);
      const FloatMatrix result = apply(Linear{weight, bias.values}, x);
      for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t o = 0; o < outputs; ++o) {
          volatile float sum = bias.values[o];
          for (std::size_t i = 0; i < inputs; ++i) {
            volatile float product = x.row(r)[i] * weight.row(i)[o];
            sum = sum + product;
          }
          ASSERT_EQ(result.row(r)[o], sum) << rows << " rows, " << outputs << " outputs";
        }
      }
    }
  }
}

TEST(ReadingArithmetic, NormsHaveMeanAndDeviationAsAsked) {
  Random random(5);
  const FloatMatrix x = randomMatrix(3, 50, random);
  const FloatMatrix y = apply(LayerNorm{std::vector<float>(50, 2), std::vector<float>(50, 3)}, x);
  for (std::size_t r = 0; r < y.rows; ++r) {
    double sum = 0, squares = 0;
    for (std::size_t c = 0; c < y.columns; ++c) sum += y.row(r)[c];
    for (std::size_t c = 0; c < y.columns; ++c) squares += std::pow(y.row(r)[c] - sum / 50, 2);
    EXPECT_NEAR(sum / 50, 3, 1e-6);
    EXPECT_NEAR(squares / 50, 4, 1e-3);
  }
}

TEST(ReadingArithmetic, SoftmaxHasTheRatiosOfExponentials) {
  std::vector<float> values = {100, 101, 98.5f};
  softmax(values);
  EXPECT_NEAR(values[1] / values[0], std::exp(1.0), 1e-6);
  EXPECT_NEAR(values[2] / values[0], std::exp(-1.5), 1e-6);
  EXPECT_NEAR(values[0] + values[1] + values[2], 1, 1e-6);
  EXPECT_NEAR(sigmoid(2), 1 / (1 + std::exp(-2.0)), 1e-7);
  EXPECT_NEAR(sigmoid(-2) + sigmoid(2), 1, 1e-15);
}

}  // namespace
}  // namespace limber
