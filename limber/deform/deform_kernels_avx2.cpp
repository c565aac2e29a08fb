// Compiled with -mavx2 where the target is x86-64 (see CMakeLists.txt).
#include "limber/deform/deform_kernels.h"

#ifdef __AVX2__

#include "limber/deform/deform_kernels_impl.h"

namespace limber {

const DeformKernels* avx2DeformKernels() {
  return __builtin_cpu_supports("avx2") ? &kKernels : nullptr;
}

const DirectKernels* avx2DirectKernels() {
  return __builtin_cpu_supports("avx2") ? &kDirectKernels : nullptr;
}

}  // namespace limber

#else

namespace limber {

const DeformKernels* avx2DeformKernels() {
  return nullptr;
}

const DirectKernels* avx2DirectKernels() {
  return nullptr;
}

}  // namespace limber

#endif
