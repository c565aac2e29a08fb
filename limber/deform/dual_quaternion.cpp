#include "limber/deform/dual_quaternion.h"

#include "limber/deform/deform_call.h"

namespace limber {

std::size_t dualQuaternionScratch(std::size_t /*vertexCount*/, Index jointCount) {
  return (kFloatsPerMotion + kFloatsPerColumns) * jointCount + kScratchAlignment;
}

void dualQuaternion(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), dualQuaternionScratch(input.positions.size(), jointCount));
  float* scales = alignedScratch(scratch);
  float* motions = scales + kFloatsPerColumns * jointCount;
  bool scaled = false;
  for (Index j = 0; j < jointCount; ++j) {
    const Vec3 center = input.centers.empty() ? Vec3(Vec3::Zero()) : input.centers[j];
    scaled |= packMotion(input.transforms[j], center, motions + kFloatsPerMotion * j, scales + kFloatsPerColumns * j);
  }

  DeformJob job = deformJob(input, output);
  job.columns = scales;
  job.motions = motions;
  runDeformJob(deformKernels().dual[job.slots == 4][job.outNormals != nullptr][scaled], job, input.positions.size());
}

}  // namespace limber
