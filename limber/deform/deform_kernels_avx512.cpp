// Compiled with -mavx512f and its like where the target is x86-64 (see CMakeLists.txt).
#include "limber/deform/deform_kernels.h"

#ifdef __AVX512F__

#include "limber/deform/deform_kernels_impl.h"

namespace limber {

namespace {

bool hasAvx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

}  // namespace

// Of AVX-512 only what gains by it: a sum of matrices in one register. The rest, in registers of eight, is no faster.
const DeformKernels* avx512DeformKernels() {
  const DeformKernels* const avx2 = avx2DeformKernels();
  if (!hasAvx512() || !avx2) return nullptr;
  static const DeformKernels kernels = [avx2] {
    DeformKernels table = *avx2;
    table.linear[1][0] = kKernels.linear[1][0];
    return table;
  }();
  return &kernels;
}

const DirectKernels* avx512DirectKernels() {
  return hasAvx512() ? &kDirectKernels : nullptr;
}

}  // namespace limber

#else

namespace limber {

const DeformKernels* avx512DeformKernels() {
  return nullptr;
}

const DirectKernels* avx512DirectKernels() {
  return nullptr;
}

}  // namespace limber

#endif
