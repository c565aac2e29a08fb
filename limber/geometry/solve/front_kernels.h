// The inner loops of SparseCholesky, in the widest form that the machine has.
#pragma once

#include <cstddef>

namespace limber {

// Matrices are cut in strips of four rows, each stored column after column: element (i, k) of a strip at 4 k + i.
// Both kernels give the same bits on every machine.
struct FrontKernels {
  // For j below bCount: target block j (16 numbers, element (i, l) at 4 l + i) -= strip a * transpose(strip b_j) over
  // their first `columns` columns. b_j begins at b + j * bStride, block j at target + 16 j.
  void (*subtractProducts)(const double* a, const double* b, std::size_t bStride, std::size_t bCount,
                           std::size_t columns, double* target);

  // target (`columns` rows of four, row k at 4 k) -= transpose(strip) * x, where x is four rows of four, row i at 4 i.
  void (*subtractTransposed)(const double* strip, const double* x, std::size_t columns, double* target);
};

const FrontKernels& frontKernels();          // the best there are on this machine
const FrontKernels& baselineFrontKernels();  // what every machine has
const FrontKernels* avx2FrontKernels();      // null where there is no AVX2

}  // namespace limber
