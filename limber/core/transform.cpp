#include "limber/core/transform.h"

#include <Eigen/SVD>

namespace limber {

Affine Transform::toAffine() const {
  Affine result;
  result.linear() = rotation.toRotationMatrix() * scale.asDiagonal();
  result.translation() = translation;
  result.makeAffine();
  return result;
}

namespace {

// Columns at right angles to each other, to single precision: then the map is rotation times scale exactly.
bool columnsOrthogonal(const Mat3& m) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (std::abs(m.col(i).dot(m.col(j))) > 1e-6 * m.col(i).norm() * m.col(j).norm()) return false;
  }
  return true;
}

}  // namespace

Transform decompose(const Affine& affine, bool* sheared) {
  Transform result;
  result.translation = affine.translation();
  const Mat3 linear = affine.linear();
  const bool orthogonal = columnsOrthogonal(linear);
  if (sheared) *sheared = !orthogonal;
  result.scale = linear.colwise().norm();
  if (linear.determinant() < 0) result.scale.x() = -result.scale.x();

  Mat3 rotation;
  if (orthogonal && result.scale.cwiseAbs().minCoeff() > 0) {
    for (int i = 0; i < 3; ++i) rotation.col(i) = linear.col(i) / result.scale[i];
  } else {
    const Eigen::JacobiSVD<Mat3> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 flip = Mat3::Identity();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) flip(2, 2) = -1;
    rotation = svd.matrixU() * flip * svd.matrixV().transpose();
    for (int i = 0; i < 3; ++i) result.scale[i] = rotation.col(i).dot(linear.col(i));
  }
  result.rotation = Quat(rotation).normalized();
  return result;
}

}  // namespace limber
