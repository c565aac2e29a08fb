#include "limber/core/rotation_fit.h"

#include <cmath>

#include <Eigen/SVD>

namespace limber {

namespace {

constexpr double kOnAxis = 1e-4;

}  // namespace

Quat bestRotation(const Mat3& correlation) {
  const double size = correlation.norm();
  if (!(size > 1e-300)) return Quat::Identity();
  // A little of the identity decides where the directions leave a choice.
  const Mat3 b = correlation / size + 1e-7 * Mat3::Identity();
  const Eigen::JacobiSVD<Mat3> svd(b, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  return Quat(Mat3(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose())).normalized();
}

double bestAngle(const Mat3& correlation, const Vec3& axis) {
  const Vec3 turn(correlation(2, 1) - correlation(1, 2), correlation(0, 2) - correlation(2, 0),
                  correlation(1, 0) - correlation(0, 1));
  const double sine = axis.dot(turn);
  const double cosine = correlation.trace() - axis.dot(correlation * axis);
  // What hangs on the axis does not say how to turn about it, and rounding must not.
  return std::hypot(sine, cosine) <= kOnAxis * correlation.norm() ? 0 : std::atan2(sine, cosine);
}

}  // namespace limber
