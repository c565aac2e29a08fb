#include "limber/skinning/dual_quaternion.h"

#include <Eigen/SVD>

#include "limber/skinning/deform_call.h"

namespace limber {

namespace {

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

// map = motion * stretch, the stretch about `center`. Returns whether there is any stretch.
bool packJoint(const Affine& map, const Vec3& center, float* motion, float* stretchColumns) {
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

}  // namespace

std::size_t dualQuaternionScratch(Index jointCount) {
  return (kFloatsPerMotion + kFloatsPerColumns) * jointCount + kScratchAlignment;
}

void dualQuaternion(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), dualQuaternionScratch(jointCount));
  float* scales = alignedScratch(scratch);
  float* motions = scales + kFloatsPerColumns * jointCount;
  bool scaled = false;
  for (Index j = 0; j < jointCount; ++j) {
    const Vec3 center = input.centers.empty() ? Vec3(Vec3::Zero()) : input.centers[j];
    scaled |= packJoint(input.transforms[j], center, motions + kFloatsPerMotion * j, scales + kFloatsPerColumns * j);
  }

  DeformJob job = deformJob(input, output);
  job.columns = scales;
  job.motions = motions;
  runDeformJob(deformKernels().dual[job.slots == 4][job.outNormals != nullptr][scaled], job, input.positions.size());
}

}  // namespace limber
