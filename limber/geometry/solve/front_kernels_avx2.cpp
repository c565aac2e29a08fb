// Compiled with -mavx2 where the target is x86-64 (see CMakeLists.txt).
#include "limber/geometry/solve/front_kernels.h"

#ifdef __AVX2__

#include "limber/geometry/solve/front_kernels_impl.h"

namespace limber {

const FrontKernels* avx2FrontKernels() {
  return __builtin_cpu_supports("avx2") ? &kFrontKernels : nullptr;
}

}  // namespace limber

#else

namespace limber {

const FrontKernels* avx2FrontKernels() {
  return nullptr;
}

}  // namespace limber

#endif
