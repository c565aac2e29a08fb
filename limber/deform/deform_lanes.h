// Four and eight floats that the compiler keeps in vector registers where the target has such, with the few operations
// that the deformers' inner loops need. The result does not depend on whether it does. Only for deform_kernels_impl.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "limber/core/float4.h"

#define LIMBER_INLINE inline __attribute__((always_inline))

namespace limber {
namespace {

using Int4 = std::int32_t __attribute__((vector_size(16)));

LIMBER_INLINE Float4 loadFloat4(const float* from) {
  Float4 result;
  __builtin_memcpy(&result, from, sizeof(result));
  return result;
}

LIMBER_INLINE void storeFloat4(Float4 value, float* to) {
  __builtin_memcpy(to, &value, sizeof(value));
}

LIMBER_INLINE Float4 broadcast(float value) {
  return Float4{value, value, value, value};
}

#ifdef __AVX__

using Float8 = float __attribute__((vector_size(32)));

LIMBER_INLINE Float8 loadFloat8(const float* from) {
  Float8 result;
  __builtin_memcpy(&result, from, sizeof(result));
  return result;
}

LIMBER_INLINE Float8 joinFloat4(Float4 low, Float4 high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

LIMBER_INLINE Float4 lowHalf(Float8 a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}

LIMBER_INLINE Float4 highHalf(Float8 a) {
  return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

#ifdef __AVX512F__

using Float16 = float __attribute__((vector_size(64)));

LIMBER_INLINE Float16 loadFloat16(const float* from) {
  Float16 result;
  __builtin_memcpy(&result, from, sizeof(result));
  return result;
}

LIMBER_INLINE Float8 lowHalf(Float16 a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
}

LIMBER_INLINE Float8 highHalf(Float16 a) {
  return __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
}

#endif

#else

struct Float8 {
  Float4 low, high;
};

LIMBER_INLINE Float8 loadFloat8(const float* from) {
  return {loadFloat4(from), loadFloat4(from + 4)};
}

LIMBER_INLINE Float8 joinFloat4(Float4 low, Float4 high) {
  return {low, high};
}

LIMBER_INLINE Float4 lowHalf(Float8 a) {
  return a.low;
}

LIMBER_INLINE Float4 highHalf(Float8 a) {
  return a.high;
}

LIMBER_INLINE Float8 operator+(Float8 a, Float8 b) {
  return {a.low + b.low, a.high + b.high};
}

LIMBER_INLINE Float8 operator*(Float8 a, Float8 b) {
  return {a.low * b.low, a.high * b.high};
}

LIMBER_INLINE Float8 operator*(float s, Float8 a) {
  return {s * a.low, s * a.high};
}

#endif

// {sum of a, sum of b, sum of c, sum of d}
LIMBER_INLINE Float4 sumEach(Float4 a, Float4 b, Float4 c, Float4 d) {
  const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5) + __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

// v + d, and v itself, sign of zero included, where d is zero.
LIMBER_INLINE Float4 displaced(Float4 v, Float4 d) {
  return d == 0.0f ? v : v + d;
}

// Three-vectors of four vertices, a vertex a lane.
struct Lanes3 {
  Float4 x, y, z;
};

struct Lanes4 {
  Float4 x, y, z, w;
};

// Lane i from the i-th argument.
LIMBER_INLINE Lanes4 transposed(Float4 a, Float4 b, Float4 c, Float4 d) {
  const Float4 abLow = __builtin_shufflevector(a, b, 0, 4, 1, 5), abHigh = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cdLow = __builtin_shufflevector(c, d, 0, 4, 1, 5), cdHigh = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(abLow, cdLow, 0, 1, 4, 5), __builtin_shufflevector(abLow, cdLow, 2, 3, 6, 7),
          __builtin_shufflevector(abHigh, cdHigh, 0, 1, 4, 5), __builtin_shufflevector(abHigh, cdHigh, 2, 3, 6, 7)};
}

LIMBER_INLINE Lanes3 xyzOf(const Lanes4& a) {
  return {a.x, a.y, a.z};
}

LIMBER_INLINE Lanes3 loadLanes3(const float* from) {
  const Float4 a = loadFloat4(from), b = loadFloat4(from + 4), c = loadFloat4(from + 8);  // xyzx yzxy zxyz
  const Float4 yz = __builtin_shufflevector(a, b, 1, 2, 4, 5), xy = __builtin_shufflevector(b, c, 2, 3, 5, 6);
  return {__builtin_shufflevector(a, xy, 0, 3, 4, 6), __builtin_shufflevector(yz, xy, 0, 2, 5, 7),
          __builtin_shufflevector(yz, c, 1, 3, 4, 7)};
}

LIMBER_INLINE void storeLanes3(const Lanes3& value, float* to) {
  const Float4 xy = __builtin_shufflevector(value.x, value.y, 0, 2, 4, 6),
               yz = __builtin_shufflevector(value.y, value.z, 1, 3, 5, 7),
               zx = __builtin_shufflevector(value.z, value.x, 0, 2, 5, 7);
  storeFloat4(__builtin_shufflevector(xy, zx, 0, 2, 4, 6), to);
  storeFloat4(__builtin_shufflevector(yz, xy, 0, 2, 5, 7), to + 4);
  storeFloat4(__builtin_shufflevector(zx, yz, 1, 3, 5, 7), to + 8);
}

LIMBER_INLINE Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

LIMBER_INLINE Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

LIMBER_INLINE Lanes3 operator*(Float4 s, const Lanes3& a) {
  return {s * a.x, s * a.y, s * a.z};
}

LIMBER_INLINE Float4 dot(const Lanes3& a, const Lanes3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

LIMBER_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

LIMBER_INLINE Lanes3 displaced(const Lanes3& v, const Lanes3& d) {
  return {displaced(v.x, d.x), displaced(v.y, d.y), displaced(v.z, d.z)};
}

LIMBER_INLINE Float4 squareRoot(Float4 a) {
  return Float4{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3])};
}

}  // namespace
}  // namespace limber
