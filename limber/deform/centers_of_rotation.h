// Skinning with optimised centres of rotation: no volume lost where joints twist, no bulge where they bend.
#pragma once

#include <vector>

#include "limber/deform/deformer.h"

namespace limber {

struct RotationCenters : DeformPreparation {
  std::vector<Vec3f> centers;  // #V points as bound
};
std::shared_ptr<const DeformPreparation> prepareRotationCenters(const BoundSurface& surface, Index jointCount);
// A row for each vertex, about its centre.
std::shared_ptr<const DeformRows> centersOfRotationRows(const BoundSurface& surface,
                                                        const std::shared_ptr<const DeformPreparation>& preparation);

// v' = M c + R S (v - c) about the vertex' rotation centre c (rotation_centers.h): M is the linear blend of the joints'
// maps, R the blend of their rotations as unit quaternions on the half sphere of the strongest influence's, S the
// linear blend of their scales and shears (Le, Hodgins 2016, equations 2 to 4; S is an addition, the paper has rigid
// motions only). Cost: that of both the linear blend and dual quaternions.
void centersOfRotation(const DeformInput& input, const DeformOutput& output, std::span<float> scratch);
std::size_t centersOfRotationScratch(std::size_t vertexCount, Index jointCount);

}  // namespace limber
