// Random rotations and vectors for tests, out of the test's own generator.
#pragma once

#include <random>

#include "limber/core/types.h"

namespace limber::testing {

// Uniform over all rotations.
template <class Generator>
Quat randomRotation(Generator& generator) {
  std::normal_distribution<double> normal;
  const double w = normal(generator), x = normal(generator), y = normal(generator), z = normal(generator);
  return Quat(w, x, y, z).normalized();
}

// A generator with what tests draw from it.
class RandomValues {
 public:
  explicit RandomValues(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low = 0, double high = 1) { return std::uniform_real_distribution<>(low, high)(generator_); }
  Index below(Index count) { return std::uniform_int_distribution<Index>(0, count - 1)(generator_); }
  Vec3 unitCube() {
    const double x = uniform(), y = uniform(), z = uniform();
    return {x, y, z};
  }
  Vec3 direction() { return rotation() * Vec3(Vec3::UnitX()); }
  Quat rotation() { return randomRotation(generator_); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace limber::testing
