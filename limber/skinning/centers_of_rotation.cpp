#include "limber/skinning/centers_of_rotation.h"

#include "limber/skinning/deform_call.h"
#include "limber/skinning/rotation_centers.h"

namespace limber {

std::shared_ptr<const DeformPreparation> prepareRotationCenters(const BoundSurface& surface, Index /*jointCount*/) {
  auto prepared = std::make_shared<RotationCenters>();
  prepared->centers = rotationCenters(surface.positions, surface.triangles, surface.weights);
  return prepared;
}

std::size_t centersOfRotationScratch(std::size_t /*vertexCount*/, Index jointCount) {
  return (kFloatsPerMotion + 2 * kFloatsPerColumns) * jointCount + kScratchAlignment;
}

void centersOfRotation(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), centersOfRotationScratch(input.positions.size(), jointCount));
  const auto& prepared = preparationOf<RotationCenters>(input);
  checkPreparedFor(prepared.centers.size(), jointCount, input);
  float* columns = alignedScratch(scratch);
  float* stretches = columns + kFloatsPerColumns * jointCount;
  float* motions = stretches + kFloatsPerColumns * jointCount;
  bool stretched = false;
  for (Index j = 0; j < jointCount; ++j) {
    packColumns(input.transforms[j], columns + kFloatsPerColumns * j);
    // About the origin: only the linear part of the stretch is used.
    stretched |= packMotion(input.transforms[j], Vec3::Zero(), motions + kFloatsPerMotion * j,
                            stretches + kFloatsPerColumns * j);
  }

  DeformJob job = deformJob(input, output);
  job.columns = columns;
  job.stretches = stretches;
  job.motions = motions;
  job.rotationCenters = reinterpret_cast<const float*>(prepared.centers.data());
  runDeformJob(deformKernels().centered[job.slots == 4][job.outNormals != nullptr][stretched], job,
               input.positions.size());
}

}  // namespace limber
