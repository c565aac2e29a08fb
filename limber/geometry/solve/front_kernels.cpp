#include "limber/geometry/solve/front_kernels.h"

#include "limber/geometry/solve/front_kernels_impl.h"

namespace limber {

const FrontKernels& baselineFrontKernels() {
  return kFrontKernels;
}

const FrontKernels& frontKernels() {
  static const FrontKernels* const avx2 = avx2FrontKernels();
  return avx2 ? *avx2 : baselineFrontKernels();
}

}  // namespace limber
