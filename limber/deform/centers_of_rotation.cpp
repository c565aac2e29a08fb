#include "limber/deform/centers_of_rotation.h"

#include "limber/deform/deform_call.h"
#include "limber/deform/rotation_centers.h"

namespace limber {

namespace {

// Each takes its weight of the centre.
void addInfluences(const SkinWeights& weights, Index vertex, const Vec3f& center, DeformRows& rows) {
  std::size_t taken = 0;
  for (Index slot = 0; slot < weights.slots; ++slot) {
    const float weight = weights.weightsOf(vertex)[slot];
    if (!(weight > 0)) continue;
    const Index joint = weights.jointsOf(vertex)[slot];
    if (taken % 4 == 0) {
      rows.joints.insert(rows.joints.end(), 4, joint);
      rows.moments.resize(rows.moments.size() + kFloatsPerMoments, 0.0f);
    }
    float* moments = rows.moments.data() + rows.moments.size() - kFloatsPerMoments + taken % 4;
    rows.joints[rows.joints.size() - 4 + taken % 4] = joint;
    for (int axis = 0; axis < 3; ++axis) moments[4 * axis] = weight * center[axis];
    moments[12] = weight;
    ++taken;
  }
}

}  // namespace

std::shared_ptr<const DeformPreparation> prepareRotationCenters(const BoundSurface& surface, Index /*jointCount*/) {
  auto prepared = std::make_shared<RotationCenters>();
  prepared->centers = rotationCenters(surface.positions, surface.triangles, surface.weights);
  return prepared;
}

std::shared_ptr<const DeformRows> centersOfRotationRows(const BoundSurface& surface,
                                                        const std::shared_ptr<const DeformPreparation>& preparation) {
  const auto* prepared = dynamic_cast<const RotationCenters*>(preparation.get());
  if (!prepared || prepared->centers.size() != surface.positions.size()) refusePreparation();
  auto rows = std::make_shared<DeformRows>();
  rows->begin.push_back(0);
  for (Index v = 0; v < surface.positions.size(); ++v) {
    const Vec3f& center = prepared->centers[v];
    rows->rowOf.push_back(v);
    rows->positions.insert(rows->positions.end(), {center.x(), center.y(), center.z(), 0.0f});
    addInfluences(surface.weights, v, center, *rows);
    rows->begin.push_back(static_cast<Index>(rows->joints.size() / 4));
  }
  return rows;
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
