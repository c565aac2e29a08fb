// The random numbers of surface samples, which programs in other languages draw too.
#pragma once

#include <cstdint>

namespace limber {

// PCG-XSH-RR with 64 bits of state (O'Neill 2014). `increment` is odd.
struct Pcg32 {
  std::uint64_t state = 0x853c49e6748fea9bULL;
  std::uint64_t increment = 0xda3e39cb94b95bdbULL;

  std::uint32_t next() {
    const std::uint64_t old = state;
    state = old * 6364136223846793005ULL + increment;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }

  // In [0, 1), in steps of 2^-32.
  double uniform() { return next() * 0x1p-32; }
};

}  // namespace limber
