// The loops behind front_kernels.h, compiled once for each instruction set. Nothing here may be inlined elsewhere.
#pragma once

#include "limber/geometry/solve/front_kernels.h"

namespace limber {

namespace {

using Lanes = double __attribute__((vector_size(32)));  // four numbers

// By reference: what returns such a type has another calling convention without AVX.
inline void load(const double* from, Lanes& lanes) {
  __builtin_memcpy(&lanes, from, sizeof lanes);
}

inline void subtractAt(double* target, const Lanes& lanes) {
  Lanes difference;
  load(target, difference);
  difference -= lanes;
  __builtin_memcpy(target, &difference, sizeof difference);
}

// kAtOnce blocks side by side keep the adders busy; sums run over columns in order whatever it is.
template <int kAtOnce>
inline void subtractSome(const double* a, const double* b, std::size_t bStride, std::size_t columns, double* target) {
  Lanes sums[kAtOnce][4] = {};
  for (std::size_t k = 0; k < columns; ++k) {
    Lanes column;
    load(a + 4 * k, column);
    for (int j = 0; j < kAtOnce; ++j) {
      const double* row = b + static_cast<std::size_t>(j) * bStride + 4 * k;
      for (int l = 0; l < 4; ++l) sums[j][l] += column * row[l];
    }
  }
  for (int j = 0; j < kAtOnce; ++j) {
    for (int l = 0; l < 4; ++l) subtractAt(target + 16 * j + 4 * l, sums[j][l]);
  }
}

void subtractProducts(const double* a, const double* b, std::size_t bStride, std::size_t bCount, std::size_t columns,
                      double* target) {
#ifdef __AVX__
  for (; bCount >= 2; bCount -= 2, b += 2 * bStride, target += 32) subtractSome<2>(a, b, bStride, columns, target);
#endif
  for (; bCount > 0; --bCount, b += bStride, target += 16) subtractSome<1>(a, b, bStride, columns, target);
}

void subtractTransposed(const double* strip, const double* x, std::size_t columns, double* target) {
  Lanes x0, x1, x2, x3;
  load(x, x0);
  load(x + 4, x1);
  load(x + 8, x2);
  load(x + 12, x3);
  for (std::size_t k = 0; k < columns; ++k) {
    const double* column = strip + 4 * k;
    subtractAt(target + 4 * k, (x0 * column[0] + x1 * column[1]) + (x2 * column[2] + x3 * column[3]));
  }
}

constexpr FrontKernels kFrontKernels = {&subtractProducts, &subtractTransposed};

}  // namespace

}  // namespace limber
