// Direct delta mush: the smoothing of delta mush, taken from each frame into matrices that are made once.
#pragma once

#include <vector>

#include "limber/deform/deformer.h"

namespace limber {

// The paper smooths by B = (I + lambda L)^-p and C = (I + kappa L)^-p; here lambda and kappa follow from how far that
// reaches, so that a surface bends alike however finely it is cut (SmoothingSurface::stepsFor).
struct DirectDeltaMushOptions {
  // Of B and C: root mean square distance, in longest sides of the model; those of the paper's lambda = 3, kappa = 1
  // and p = 20 on a body of some 6,000 vertices.
  double rotationReach = 0.08, translationReach = 0.046;
  double translationWeight = 0.8;  // alpha of the paper, in [0, 1): 0 smooths as delta mush does, which shrinks bends
  int smoothings = 2;              // p; more make the reach end sooner
  // Least weight of a joint in a vertex; smaller ones are given to the others. On people the mean distance from the
  // paper's full form grows by 4 to 7 % with 1 / 96 against 1 / 256, by 12 to 21 % with 1 / 48.
  double minWeight = 1.0 / 64;
  // Of a vertex, the strongest; what the rest had is given to them. With 8 the mean distance from the full form is at
  // most 4 % above that with all joints, with 6 20 %, with 4 75 % (a person of 163 joints).
  Index maxJoints = 8;
  // Of the joints in an entry of four behind the first, together; where they have less, it is given to the others.
  // With 1 / 32 against 0 the mean distance from the full form grows by 1 % on 25 artists' creatures, by 4 % with
  // 1 / 8; on the bench's creature 95 of 100 vertices lie within 1.88 thousandths of the longest side against
  // 1.72, and a frame takes 1.99 times that of dual quaternions against 2.07 (maxJoints = 4: 2.16 and 1.94).
  double minEntry = 1.0 / 32;
};

// One row of moments for each vertex of the welded surface, with an entry for each joint that its surroundings are
// bound to: the sums over k of b_k w_kj [u_k; 1], by which the joints move the smoothed position p = sum of b_k u_k.
struct DirectDeltaMushRows : DeformPreparation, DeformRows {
  Index jointCount = 0;
};

std::shared_ptr<const DeformPreparation> prepareDirectDeltaMush(const BoundSurface& surface, Index jointCount);
// The preparation's own.
std::shared_ptr<const DeformRows> directDeltaMushDrawRows(const BoundSurface& surface,
                                                          const std::shared_ptr<const DeformPreparation>& preparation);
// Throws Error kBadArgument where an option is out of its range. In parallel; the result does not depend on the number
// of threads. Cost: two factorisations and about 2 solves of 8 columns, `smoothings` times, for each joint with
// weights.
std::shared_ptr<const DirectDeltaMushRows> directDeltaMushRows(const BoundSurface& surface, Index jointCount,
                                                               const DirectDeltaMushOptions& options = {});

// v' = q + R (v - p): q is where the joints move the surroundings' mean, as in the paper's variant 0, and R the joints'
// rotations blended as quaternions by the smoothed weights, instead of the rotation nearest to what they do to the
// surroundings. Joints' scales and shears are blended apart, as for centersOfRotation (the paper has rigid motions
// only). Vertices far from joints that bend follow theirs exactly.
// Against the full form (variant 0 with the fitted rotation) with a minWeight of 1/256, on three people of 1.8 m, each
// third joint bent by up to 1.5 rad: 95 of 100 vertices within 1.2 to 3.9 mm (linear blend: 2.8 to 9.7), at most 17 mm;
// that is with a minEntry of 0; the default adds up to 6 %.
// Memory: 80 bytes for each four joints of a vertex of the welded surface and 20, and 4 for each vertex.
// Cost: 5 multiplications and additions of four floats for each joint of a vertex, of which there are four or eight:
// 1.5 to 2 times that of dual quaternions.
void directDeltaMush(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);
std::size_t directDeltaMushScratch(std::size_t vertexCount, Index jointCount);

}  // namespace limber
