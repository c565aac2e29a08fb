#include "limber/deform/deform_kernels.h"

#include "limber/deform/deform_kernels_impl.h"

namespace limber {

const DeformKernels& baselineDeformKernels() {
  return kKernels;
}

const DirectKernels& baselineDirectKernels() {
  return kDirectKernels;
}

const DirectKernels& directKernels() {
  static const DirectKernels* const avx512 = avx512DirectKernels();
  static const DirectKernels* const avx2 = avx2DirectKernels();
  if (avx512) return *avx512;
  return avx2 ? *avx2 : baselineDirectKernels();
}

const DeformKernels& deformKernels() {
  static const DeformKernels* const avx512 = avx512DeformKernels();
  static const DeformKernels* const avx2 = avx2DeformKernels();
  if (avx512) return *avx512;
  return avx2 ? *avx2 : baselineDeformKernels();
}

}  // namespace limber
