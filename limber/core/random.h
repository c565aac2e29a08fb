// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace limber {

// SplitMix64 (Steele, Lea, Flood 2014). Draw into named values: compilers differ in the order of arguments.
class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  // Evenly from [low, high).
  double uniform(double low = 0, double high = 1) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }

  // Below `count`, 1 or more.
  std::uint64_t below(std::uint64_t count) { return bits() % count; }

  // Nearly a normal distribution's, of mean 0 and deviation 1, within 3.5: the sum of four even ones (no logarithm,
  // which libraries round differently).
  double normal() {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += uniform();
    return (sum - 2) * 1.7320508075688772;
  }

 private:
  std::uint64_t state_;
};

}  // namespace limber
