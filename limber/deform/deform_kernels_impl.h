// The bodies of the deformers' inner loops; included by one source file for each kind of machine.
#pragma once

#include "limber/deform/deform_kernels.h"
#include "limber/deform/deform_lanes.h"

namespace limber {
namespace {

// Joints and weights of one vertex. With four slots the loops over them unroll; kSlots is 0 for any other number.
template <int kSlots>
struct Influences {
  const std::uint32_t* joints;
  const float* weights;
  std::uint32_t slots;

  LIMBER_INLINE std::uint32_t count() const { return kSlots > 0 ? static_cast<std::uint32_t>(kSlots) : slots; }
};

template <int kSlots>
LIMBER_INLINE Influences<kSlots> influencesOf(const DeformJob& job, std::size_t vertex) {
  const std::size_t first = vertex * (kSlots > 0 ? static_cast<std::size_t>(kSlots) : job.slots);
  return {job.joints + first, job.weights + first, job.slots};
}

// A map less the identity: columns x and y, column z and offset.
struct Columns {
  Float8 xy = {}, zOffset = {};
};

#ifdef __AVX512F__

template <int kSlots>
LIMBER_INLINE Float16 blendWhole(const float* palette, const Influences<kSlots>& influences) {
  Float16 sum = {};
  for (std::uint32_t i = 0; i < influences.count(); ++i) {
    const Float16 map = influences.weights[i] * loadFloat16(palette + kFloatsPerColumns * influences.joints[i]);
    sum = i == 0 ? map : sum + map;
  }
  return sum;
}

template <int kSlots>
LIMBER_INLINE Columns blendColumns(const float* palette, const Influences<kSlots>& influences) {
  const Float16 sum = blendWhole(palette, influences);
  return {lowHalf(sum), highHalf(sum)};
}

#else

template <int kSlots>
LIMBER_INLINE Columns blendColumns(const float* palette, const Influences<kSlots>& influences) {
  Columns sum;
  for (std::uint32_t i = 0; i < influences.count(); ++i) {
    const float* from = palette + kFloatsPerColumns * influences.joints[i];
    const Float8 xy = influences.weights[i] * loadFloat8(from);
    const Float8 zOffset = influences.weights[i] * loadFloat8(from + 8);
    sum.xy = i == 0 ? xy : sum.xy + xy;
    sum.zOffset = i == 0 ? zOffset : sum.zOffset + zOffset;
  }
  return sum;
}

#endif

// What the map adds to a point, given as {x, x, x, x, y, y, y, y} and {z, z, z, z, 1, 1, 1, 1}.
LIMBER_INLINE Float4 displacementBy(const Columns& map, Float8 xy, Float8 zOne) {
  const Float8 sum = map.xy * xy + map.zOffset * zOne;
  return lowHalf(sum) + highHalf(sum);
}

LIMBER_INLINE Float4 displacementBy(const Columns& map, const float* point) {
  return displacementBy(map, joinFloat4(broadcast(point[0]), broadcast(point[1])),
                        joinFloat4(broadcast(point[2]), broadcast(1)));
}

// The unit normals after four vertices' maps: by their cofactors, so that they stay at right angles to the surface, and
// on the side they were where a map mirrors. A normal stays as it is where the map is the identity or leaves none.
LIMBER_INLINE Lanes3 normalsAfter(const Columns maps[4], const Lanes3& n) {
  const Lanes3 dx =
      xyzOf(transposed(lowHalf(maps[0].xy), lowHalf(maps[1].xy), lowHalf(maps[2].xy), lowHalf(maps[3].xy)));
  const Lanes3 dy =
      xyzOf(transposed(highHalf(maps[0].xy), highHalf(maps[1].xy), highHalf(maps[2].xy), highHalf(maps[3].xy)));
  const Lanes3 dz = xyzOf(transposed(lowHalf(maps[0].zOffset), lowHalf(maps[1].zOffset), lowHalf(maps[2].zOffset),
                                     lowHalf(maps[3].zOffset)));
  const Int4 moved = (dx.x != 0.0f) | (dx.y != 0.0f) | (dx.z != 0.0f) | (dy.x != 0.0f) | (dy.y != 0.0f) |
                     (dy.z != 0.0f) | (dz.x != 0.0f) | (dz.y != 0.0f) | (dz.z != 0.0f);

  const Lanes3 x = {dx.x + 1.0f, dx.y, dx.z}, y = {dy.x, dy.y + 1.0f, dy.z}, z = {dz.x, dz.y, dz.z + 1.0f};
  const Lanes3 yz = cross(y, z);
  const Lanes3 turned = n.x * yz + n.y * cross(z, x) + n.z * cross(x, y);
  const Float4 square = dot(turned, turned);
  const Float4 length = squareRoot(square), mirrored = dot(x, yz);
  const Lanes3 unit = (1.0f / (mirrored < 0.0f ? -length : length)) * turned;
  const Int4 keep = (moved == 0) | ~(square > 0.0f);
  return {keep ? n.x : unit.x, keep ? n.y : unit.y, keep ? n.z : unit.z};
}

// {±w_0, ±w_1, ±w_2, ±w_3}: minus where the rotation lies on the other half sphere than `pivot`.
LIMBER_INLINE Float4 signedWeights(const float* const motions[4], Float4 weights, Float4 pivot) {
  const Float4 dots = sumEach(pivot * loadFloat4(motions[0]), pivot * loadFloat4(motions[1]),
                              pivot * loadFloat4(motions[2]), pivot * loadFloat4(motions[3]));
  constexpr std::int32_t kSign = INT32_MIN;
  return reinterpret_cast<Float4>(reinterpret_cast<Int4>(weights) ^
                                  (reinterpret_cast<Int4>(dots) & Int4{kSign, kSign, kSign, kSign}));
}

LIMBER_INLINE Float8 blendFourMotions(const float* palette, const std::uint32_t* joints, Float4 weights, Float4 pivot) {
  const float* const motions[4] = {palette + kFloatsPerMotion * joints[0], palette + kFloatsPerMotion * joints[1],
                                   palette + kFloatsPerMotion * joints[2], palette + kFloatsPerMotion * joints[3]};
  const Float4 factors = signedWeights(motions, weights, pivot);
  Float8 sum = factors[0] * loadFloat8(motions[0]);
  for (int i = 1; i < 4; ++i) sum = sum + factors[i] * loadFloat8(motions[i]);
  return sum;
}

// Sum of the motions' dual quaternions by weight, all on the half sphere of the first.
template <int kSlots>
LIMBER_INLINE Float8 blendMotions(const float* palette, const Influences<kSlots>& influences) {
  if (influences.count() == 0) return Float8{};
  const Float4 pivot = loadFloat4(palette + kFloatsPerMotion * influences.joints[0]);
  if (kSlots == 4) return blendFourMotions(palette, influences.joints, loadFloat4(influences.weights), pivot);
  Float8 sum = {};
  for (std::uint32_t first = 0; first < influences.count(); first += 4) {
    std::uint32_t joints[4] = {};
    float weights[4] = {};
    for (std::uint32_t i = 0; i < 4 && first + i < influences.count(); ++i) {
      joints[i] = influences.joints[first + i];
      weights[i] = influences.weights[first + i];
    }
    sum = sum + blendFourMotions(palette, joints, loadFloat4(weights), pivot);
  }
  return sum;
}

// Four vertices' blended motions, ready to be applied. The rotation and translation of real + eps dual are those of the
// same divided by |real|, and for them only 2 / |real|^2 is needed: no root.
struct AppliedMotions {
  Lanes3 axis;         // vector part of real
  Float4 w;            // scalar part of real
  Lanes3 translation;  // times |real|^2 / 2
  Float4 factor;       // 2 / |real|^2
};

LIMBER_INLINE AppliedMotions prepareMotions(const Float8 motions[4]) {
  const Lanes4 real = transposed(lowHalf(motions[0]), lowHalf(motions[1]), lowHalf(motions[2]), lowHalf(motions[3]));
  const Lanes4 dual =
      transposed(highHalf(motions[0]), highHalf(motions[1]), highHalf(motions[2]), highHalf(motions[3]));
  const Lanes3 axis = xyzOf(real);
  const Float4 square = dot(axis, axis) + real.w * real.w;
  const Float4 inverse = 2.0f / square;
  return {axis, real.w, real.w * xyzOf(dual) - dual.w * axis + cross(axis, xyzOf(dual)),
          square > 0.0f ? inverse : Float4{}};
}

// Rotations alone; none where a vertex has no quaternion.
LIMBER_INLINE AppliedMotions rotationsOf(const Lanes4& q) {
  const Float4 square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const Float4 inverse = 2.0f / square;
  return {xyzOf(q), q.w, Lanes3{}, square > 0.0f ? inverse : Float4{}};
}

LIMBER_INLINE Lanes3 turnOf(const AppliedMotions& motions, const Lanes3& v) {
  return cross(motions.axis, cross(motions.axis, v) + motions.w * v);
}

LIMBER_INLINE Lanes3 movedPoints(const AppliedMotions& motions, const Lanes3& v) {
  return displaced(v, motions.factor * (turnOf(motions, v) + motions.translation));
}

LIMBER_INLINE Lanes3 turnedNormals(const AppliedMotions& motions, const Lanes3& n) {
  return displaced(n, motions.factor * turnOf(motions, n));
}

#ifdef __AVX512F__

// Positions of four vertices from `v` on, a vertex' whole sum of matrices in one register; each sum in the order of
// displacementBy.
LIMBER_INLINE void movePositions(const DeformJob& job, std::size_t v) {
  const float* from = job.positions + 3 * v;
  float* to = job.outPositions + 3 * v;
  const Float8 last = joinFloat4(loadFloat4(from + 8), broadcast(1));
  // x y z of each, then ones
  const Float16 points =
      __builtin_shufflevector(loadFloat8(from), last, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const Float16 p0 = __builtin_shufflevector(points, points, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 12, 12, 12, 12);
  const Float16 p1 = __builtin_shufflevector(points, points, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 12, 12, 12, 12);
  const Float16 p2 = __builtin_shufflevector(points, points, 6, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8, 8, 12, 12, 12, 12);
  const Float16 p3 =
      __builtin_shufflevector(points, points, 9, 9, 9, 9, 10, 10, 10, 10, 11, 11, 11, 11, 12, 12, 12, 12);
  const Float16 a = p0 * blendWhole(job.columns, influencesOf<4>(job, v));
  const Float16 b = p1 * blendWhole(job.columns, influencesOf<4>(job, v + 1));
  const Float16 c = p2 * blendWhole(job.columns, influencesOf<4>(job, v + 2));
  const Float16 d = p3 * blendWhole(job.columns, influencesOf<4>(job, v + 3));
  const Float16 ab = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
                     __builtin_shufflevector(a, b, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  const Float16 cd = __builtin_shufflevector(c, d, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
                     __builtin_shufflevector(c, d, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  const Float16 moves = __builtin_shufflevector(ab, cd, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) +
                        __builtin_shufflevector(ab, cd, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  const Float16 move = __builtin_shufflevector(moves, moves, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15);
  const Float16 moved = move == 0.0f ? points : points + move;
  const Float8 first = lowHalf(moved);
  __builtin_memcpy(to, &first, sizeof(first));
  storeFloat4(lowHalf(highHalf(moved)), to + 8);
}

#endif

// Four vertices from `v` on: their sums of matrices one by one, normals in lanes.
template <int kSlots, bool kNormals>
LIMBER_INLINE void linearBlock(const DeformJob& job, std::size_t v) {
#ifdef __AVX512F__
  if (kSlots == 4 && !kNormals) return movePositions(job, v);
#endif
  const float* from = job.positions + 3 * v;
  Columns maps[4];
  Float4 moves[4];
  for (int i = 0; i < 4; ++i) {
    maps[i] = blendColumns(job.columns, influencesOf<kSlots>(job, v + i));
    moves[i] = displacementBy(maps[i], from + 3 * i);
  }
  // Twelve floats in a row: x y z x, y z x y, z x y z.
  const Float4 rows[3] = {displaced(loadFloat4(from), __builtin_shufflevector(moves[0], moves[1], 0, 1, 2, 4)),
                          displaced(loadFloat4(from + 4), __builtin_shufflevector(moves[1], moves[2], 1, 2, 4, 5)),
                          displaced(loadFloat4(from + 8), __builtin_shufflevector(moves[2], moves[3], 2, 4, 5, 6))};
  for (int i = 0; i < 3; ++i) storeFloat4(rows[i], job.outPositions + 3 * v + 4 * i);
  if (kNormals) storeLanes3(normalsAfter(maps, loadLanes3(job.normals + 3 * v)), job.outNormals + 3 * v);
}

template <int kSlots, bool kNormals, bool kScales>
LIMBER_INLINE void dualBlock(const DeformJob& job, std::size_t v) {
  Lanes3 positions = loadLanes3(job.positions + 3 * v);
  Lanes3 normals = {};
  if (kNormals) normals = loadLanes3(job.normals + 3 * v);
  if (kScales) {
    Columns scales[4];
    for (int i = 0; i < 4; ++i) scales[i] = blendColumns(job.columns, influencesOf<kSlots>(job, v + i));
    const float* from = job.positions + 3 * v;
    positions = displaced(positions,
                          xyzOf(transposed(displacementBy(scales[0], from), displacementBy(scales[1], from + 3),
                                           displacementBy(scales[2], from + 6), displacementBy(scales[3], from + 9))));
    if (kNormals) normals = normalsAfter(scales, normals);
  }
  Float8 sums[4];
  for (int i = 0; i < 4; ++i) sums[i] = blendMotions(job.motions, influencesOf<kSlots>(job, v + i));
  const AppliedMotions motions = prepareMotions(sums);
  storeLanes3(movedPoints(motions, positions), job.outPositions + 3 * v);
  if (kNormals) storeLanes3(turnedNormals(motions, normals), job.outNormals + 3 * v);
}

// What four vertices' stretches add to their arms.
LIMBER_INLINE Lanes3 growthOf(const Columns stretches[4], const Lanes3& arm) {
  Float4 growths[4];
  for (int i = 0; i < 4; ++i) {
    growths[i] = displacementBy(stretches[i], joinFloat4(broadcast(arm.x[i]), broadcast(arm.y[i])),
                                joinFloat4(broadcast(arm.z[i]), broadcast(0)));
  }
  return xyzOf(transposed(growths[0], growths[1], growths[2], growths[3]));
}

// v' = M c + R S (v - c) about the vertex's centre c: the blended matrix M moves the centre, the blended rotation R and
// stretch S the displacement from it. Again computed as displacements, so that nothing moves where all are the
// identity.
template <int kSlots, bool kNormals, bool kScales>
LIMBER_INLINE void centeredBlock(const DeformJob& job, std::size_t v) {
  const Lanes3 positions = loadLanes3(job.positions + 3 * v);
  const float* center = job.rotationCenters + 3 * v;
  Float4 shifts[4];
  Float8 sums[4];
  for (int i = 0; i < 4; ++i) {
    const Influences<kSlots> influences = influencesOf<kSlots>(job, v + i);
    shifts[i] = displacementBy(blendColumns(job.columns, influences), center + 3 * i);
    sums[i] = blendMotions(job.motions, influences);
  }
  Lanes3 shift = xyzOf(transposed(shifts[0], shifts[1], shifts[2], shifts[3]));
  Lanes3 arm = positions - loadLanes3(center), normals = {};
  if (kNormals) normals = loadLanes3(job.normals + 3 * v);
  if (kScales) {
    Columns stretches[4];
    for (int i = 0; i < 4; ++i) stretches[i] = blendColumns(job.stretches, influencesOf<kSlots>(job, v + i));
    const Lanes3 growth = growthOf(stretches, arm);
    shift = shift + growth;
    arm = arm + growth;
    if (kNormals) normals = normalsAfter(stretches, normals);
  }
  const AppliedMotions motions = prepareMotions(sums);
  storeLanes3(displaced(positions, shift + motions.factor * turnOf(motions, arm)), job.outPositions + 3 * v);
  if (kNormals) storeLanes3(turnedNormals(motions, normals), job.outNormals + 3 * v);
}

// What the joints of a row do to its surroundings' mean, the blended quaternion, and the blended stretch where there is
// any.
struct RowSum {
  Float4 shift, turn;
  Columns stretch;
};

// The joints' maps, each times its first moment and weight: of four joints the x, then the y, z and weights.
struct ShiftSum {
#ifdef __AVX512F__
  Float16 all = {};

  LIMBER_INLINE void addFour(const float* palette, const std::uint32_t* joints, const float* moments) {
    const Float16 m = loadFloat16(moments);
    const float* const maps[4] = {palette + kFloatsPerColumns * joints[0], palette + kFloatsPerColumns * joints[1],
                                  palette + kFloatsPerColumns * joints[2], palette + kFloatsPerColumns * joints[3]};
    all =
        all + loadFloat16(maps[0]) * __builtin_shufflevector(m, m, 0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
    all =
        all + loadFloat16(maps[1]) * __builtin_shufflevector(m, m, 1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9, 9, 13, 13, 13, 13);
    all = all +
          loadFloat16(maps[2]) * __builtin_shufflevector(m, m, 2, 2, 2, 2, 6, 6, 6, 6, 10, 10, 10, 10, 14, 14, 14, 14);
    all = all +
          loadFloat16(maps[3]) * __builtin_shufflevector(m, m, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
  }
  LIMBER_INLINE Float8 halves() const {
    return lowHalf(all) + highHalf(all);
  }
#else
  Float8 xy = {}, zOffset = {};

  LIMBER_INLINE void addFour(const float* palette, const std::uint32_t* joints, const float* moments) {
    for (int i = 0; i < 4; ++i) {
      const float* map = palette + kFloatsPerColumns * joints[i];
      xy = xy + loadFloat8(map) * joinFloat4(broadcast(moments[i]), broadcast(moments[4 + i]));
      zOffset = zOffset + loadFloat8(map + 8) * joinFloat4(broadcast(moments[8 + i]), broadcast(moments[12 + i]));
    }
  }
  LIMBER_INLINE Float8 halves() const {
    return xy + zOffset;
  }
#endif
};

template <bool kScales>
LIMBER_INLINE RowSum sumRow(const DeformJob& job, std::size_t row) {
  const std::uint32_t begin = job.rowBegin[row], end = job.rowBegin[row + 1];
  RowSum sum = {};
  if (begin == end) return sum;
  const Float4 pivot = loadFloat4(job.motions + kFloatsPerMotion * job.rowJoints[4 * std::size_t{begin}]);
  ShiftSum shift;
  for (std::size_t four = begin; four < end; ++four) {
    const std::uint32_t* joints = job.rowJoints + 4 * four;
    const float* moments = job.rowMoments + kFloatsPerMoments * four;
    shift.addFour(job.columns, joints, moments);
    sum.turn = sum.turn + lowHalf(blendFourMotions(job.motions, joints, loadFloat4(moments + 12), pivot));
    for (int i = 0; kScales && i < 4; ++i) {
      const float* stretch = job.stretches + kFloatsPerColumns * joints[i];
      sum.stretch.xy = sum.stretch.xy + moments[12 + i] * loadFloat8(stretch);
      sum.stretch.zOffset = sum.stretch.zOffset + moments[12 + i] * loadFloat8(stretch + 8);
    }
  }
  sum.shift = lowHalf(shift.halves()) + highHalf(shift.halves());
  return sum;
}

// v' = p + shift + R S (v - p) about the vertex's smoothed position p.
template <bool kNormals, bool kScales>
LIMBER_INLINE void directBlock(const DeformJob& job, std::size_t v) {
  RowSum sums[4];
  Float4 rowPosition[4];
  for (int i = 0; i < 4; ++i) {
    const std::size_t row = job.rowOf[v + i];
    sums[i] = sumRow<kScales>(job, row);
    rowPosition[i] = loadFloat4(job.rowPositions + 4 * row);
  }
  const Lanes3 positions = loadLanes3(job.positions + 3 * v);
  Lanes3 arm = positions - xyzOf(transposed(rowPosition[0], rowPosition[1], rowPosition[2], rowPosition[3])),
         normals = {};
  Lanes3 shift = xyzOf(transposed(sums[0].shift, sums[1].shift, sums[2].shift, sums[3].shift));
  if (kNormals) normals = loadLanes3(job.normals + 3 * v);
  if (kScales) {
    const Columns stretches[4] = {sums[0].stretch, sums[1].stretch, sums[2].stretch, sums[3].stretch};
    const Lanes3 growth = growthOf(stretches, arm);
    shift = shift + growth;
    arm = arm + growth;
    if (kNormals) normals = normalsAfter(stretches, normals);
  }
  const Lanes4 q = transposed(sums[0].turn, sums[1].turn, sums[2].turn, sums[3].turn);
  const AppliedMotions motions = rotationsOf(q);
  storeLanes3(displaced(positions, shift + motions.factor * turnOf(motions, arm)), job.outPositions + 3 * v);
  if (kNormals) storeLanes3(turnedNormals(motions, normals), job.outNormals + 3 * v);
}

using DeformBlock = void (*)(const DeformJob& job, std::size_t v);

// The last one to three vertices, as a block with copies of the last.
template <DeformBlock kBlock>
void deformRest(const DeformJob& job, std::size_t begin, std::size_t end) {
  constexpr std::uint32_t kMaxSlots = 8;
  float positions[12] = {}, normals[12] = {}, centers[12] = {}, outPositions[12], outNormals[12],
        weights[4 * kMaxSlots] = {};
  std::uint32_t joints[4 * kMaxSlots] = {}, rows[4] = {};
  const std::size_t count = end - begin;
  for (std::size_t i = 0; i < 3 * count; ++i) positions[i] = job.positions[3 * begin + i];
  for (std::size_t i = 0; i < 3 * count && job.normals; ++i) normals[i] = job.normals[3 * begin + i];
  for (std::size_t i = 0; i < 3 * count && job.rotationCenters; ++i) centers[i] = job.rotationCenters[3 * begin + i];
  for (std::size_t i = 0; i < 4 && job.rowOf; ++i) rows[i] = job.rowOf[begin + (i < count ? i : count - 1)];
  for (std::size_t i = 0; i < job.slots * count; ++i) {
    joints[i] = job.joints[job.slots * begin + i];
    weights[i] = job.weights[job.slots * begin + i];
  }
  DeformJob rest = job;
  rest.positions = positions;
  rest.normals = normals;
  rest.rotationCenters = centers;
  rest.outPositions = outPositions;
  rest.outNormals = outNormals;
  rest.joints = joints;
  rest.weights = weights;
  rest.rowOf = rows;
  kBlock(rest, 0);
  for (std::size_t i = 0; i < 3 * count; ++i) job.outPositions[3 * begin + i] = outPositions[i];
  for (std::size_t i = 0; i < 3 * count && job.outNormals; ++i) job.outNormals[3 * begin + i] = outNormals[i];
}

template <DeformBlock kBlock>
void deformRange(const DeformJob& job, std::size_t begin, std::size_t end) {
  for (; begin + 4 <= end; begin += 4) kBlock(job, begin);
  if (begin < end) deformRest<kBlock>(job, begin, end);
}

constexpr DeformKernels kKernels = {
    {{&deformRange<linearBlock<0, false>>, &deformRange<linearBlock<0, true>>},
     {&deformRange<linearBlock<4, false>>, &deformRange<linearBlock<4, true>>}},
    {{{&deformRange<dualBlock<0, false, false>>, &deformRange<dualBlock<0, false, true>>},
      {&deformRange<dualBlock<0, true, false>>, &deformRange<dualBlock<0, true, true>>}},
     {{&deformRange<dualBlock<4, false, false>>, &deformRange<dualBlock<4, false, true>>},
      {&deformRange<dualBlock<4, true, false>>, &deformRange<dualBlock<4, true, true>>}}},
    {{{&deformRange<centeredBlock<0, false, false>>, &deformRange<centeredBlock<0, false, true>>},
      {&deformRange<centeredBlock<0, true, false>>, &deformRange<centeredBlock<0, true, true>>}},
     {{&deformRange<centeredBlock<4, false, false>>, &deformRange<centeredBlock<4, false, true>>},
      {&deformRange<centeredBlock<4, true, false>>, &deformRange<centeredBlock<4, true, true>>}}}};

[[maybe_unused]] constexpr DirectKernels kDirectKernels = {
    {{&deformRange<directBlock<false, false>>, &deformRange<directBlock<false, true>>},
     {&deformRange<directBlock<true, false>>, &deformRange<directBlock<true, true>>}}};

}  // namespace
}  // namespace limber
