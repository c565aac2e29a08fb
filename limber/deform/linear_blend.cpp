#include "limber/deform/linear_blend.h"

#include "limber/deform/deform_call.h"

namespace limber {

std::size_t linearBlendScratch(std::size_t /*vertexCount*/, Index jointCount) {
  return kFloatsPerColumns * jointCount + kScratchAlignment;
}

void linearBlend(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), linearBlendScratch(input.positions.size(), jointCount));
  float* columns = alignedScratch(scratch);
  for (Index j = 0; j < jointCount; ++j) packColumns(input.transforms[j], columns + kFloatsPerColumns * j);

  DeformJob job = deformJob(input, output);
  job.columns = columns;
  runDeformJob(deformKernels().linear[job.slots == 4][job.outNormals != nullptr], job, input.positions.size());
}

}  // namespace limber
