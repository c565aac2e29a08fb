#include "limber/skinning/centers_of_rotation.h"

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skinning/deform_call.h"

namespace limber {

std::size_t centersOfRotationScratch(Index jointCount) {
  return (kFloatsPerMotion + 2 * kFloatsPerColumns) * jointCount + kScratchAlignment;
}

void centersOfRotation(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), centersOfRotationScratch(jointCount));
  if (input.rotationCenters.size() != input.positions.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("0 rotation centers, {} needed", input.positions.size()));
  }
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
  job.rotationCenters = reinterpret_cast<const float*>(input.rotationCenters.data());
  runDeformJob(deformKernels().centered[job.slots == 4][job.outNormals != nullptr][stretched], job,
               input.positions.size());
}

}  // namespace limber
