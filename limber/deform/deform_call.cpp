#include "limber/deform/deform_call.h"

#include <fmt/format.h>
#include <Eigen/SVD>

#include "limber/core/error.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr std::size_t kDeformGrain = 8192;  // vertices; 30 to 100 microseconds

constexpr double kRigid = 1e-9;  // largest entry of S - I that is rounding

// The rotation of the polar decomposition; `linear` may mirror or be flat.
Mat3 nearestRotation(const Mat3& linear) {
  if ((linear.transpose() * linear - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRigid && linear.determinant() > 0) {
    return linear;
  }
  const Eigen::JacobiSVD<Mat3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 flip = Mat3::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) flip(2, 2) = -1;
  return svd.matrixU() * flip * svd.matrixV().transpose();
}

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Index) == sizeof(std::uint32_t));

}  // namespace

void checkDeformCall(const DeformInput& input, const DeformOutput& output, std::size_t scratchSize,
                     std::size_t scratchNeeded) {
  const std::size_t count = input.positions.size();
  const auto check = [](bool fits, const char* what, std::size_t size, std::size_t wanted) {
    if (!fits) throw Error(ErrorCode::kBadArgument, fmt::format("{} {}, {} needed", size, what, wanted));
  };
  const SkinWeights& weights = input.weights;
  const std::size_t entries = count * weights.slots;
  check(weights.joints.size() == entries, "weight joints", weights.joints.size(), entries);
  check(weights.weights.size() == entries, "weights", weights.weights.size(), entries);
  check(output.positions.size() == count, "output positions", output.positions.size(), count);
  check(input.normals.empty() || input.normals.size() == count, "normals", input.normals.size(), count);
  check(output.normals.empty() || (output.normals.size() == count && !input.normals.empty()), "output normals",
        output.normals.size(), input.normals.size());
  check(input.centers.empty() || input.centers.size() == input.transforms.size(), "joint centers", input.centers.size(),
        input.transforms.size());
  check(!input.transforms.empty() || entries == 0, "joint transforms", 0, 1);
  check(scratchSize >= scratchNeeded, "floats of scratch", scratchSize, scratchNeeded);
}

void refusePreparation() {
  throw Error(ErrorCode::kBadArgument, "the deformer was not prepared for this surface", {}, "call prepareDeformer");
}

void checkPreparedFor(std::size_t vertexCount, std::size_t jointCount, const DeformInput& input) {
  if (vertexCount == input.positions.size() && jointCount == input.transforms.size()) return;
  throw Error(ErrorCode::kBadArgument,
              fmt::format("prepared for {} vertices and {} joints, not for {} and {}", vertexCount, jointCount,
                          input.positions.size(), input.transforms.size()));
}

float* alignedScratch(std::span<float> scratch) {
  constexpr std::uintptr_t kBytes = kScratchAlignment * sizeof(float);
  const auto address = reinterpret_cast<std::uintptr_t>(scratch.data());
  return scratch.data() + ((kBytes - address % kBytes) % kBytes) / sizeof(float);
}

void packColumns(const Affine& map, float* to) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double identity = row == column ? 1.0 : 0.0;
      to[4 * column + row] = static_cast<float>(map.matrix()(row, column) - identity);
    }
    to[4 * column + 3] = 0;
  }
}

bool packMotion(const Affine& map, const Vec3& center, float* motion, float* stretchColumns) {
  const Mat3 rotation = nearestRotation(map.linear());
  Affine stretch = Affine::Identity();
  stretch.linear() = rotation.transpose() * map.linear();
  const bool stretched = (stretch.linear() - Mat3::Identity()).cwiseAbs().maxCoeff() > kRigid;
  if (!stretched) stretch.linear().setIdentity();
  stretch.translation() = center - stretch.linear() * center;
  packColumns(stretch, stretchColumns);

  const Vec3 translation = map * center - rotation * center;
  const Quat real(rotation);
  const Quat dual = Quat(0, 0.5 * translation.x(), 0.5 * translation.y(), 0.5 * translation.z()) * real;
  for (int i = 0; i < 4; ++i) {
    motion[i] = static_cast<float>(real.coeffs()[i]);
    motion[4 + i] = static_cast<float>(dual.coeffs()[i]);
  }
  return stretched;
}

DeformJob deformJob(const DeformInput& input, const DeformOutput& output) {
  DeformJob job;
  job.positions = reinterpret_cast<const float*>(input.positions.data());
  job.outPositions = reinterpret_cast<float*>(output.positions.data());
  if (!output.normals.empty()) {
    job.normals = reinterpret_cast<const float*>(input.normals.data());
    job.outNormals = reinterpret_cast<float*>(output.normals.data());
  }
  job.joints = input.weights.joints.data();
  job.weights = input.weights.weights.data();
  job.slots = input.weights.slots;
  return job;
}

void runDeformJob(DeformKernel kernel, const DeformJob& job, std::size_t vertexCount) {
  // Two captured references, which std::function holds without allocating.
  parallelFor(vertexCount, kDeformGrain,
              [kernel, &job](std::size_t begin, std::size_t end) { kernel(job, begin, end); });
}

}  // namespace limber
