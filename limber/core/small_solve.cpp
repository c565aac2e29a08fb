#include "limber/core/small_solve.h"

#include <cmath>

namespace limber {

void solveCholesky(Eigen::Ref<Eigen::MatrixXd> a, double damping, Eigen::Ref<Eigen::VectorXd> x) {
  const Eigen::Index m = a.rows();
  const double floor = 1e-15 * a.diagonal().cwiseAbs().sum();
  for (Eigen::Index j = 0; j < m; ++j) {
    double pivot = a(j, j) + damping;
    for (Eigen::Index k = 0; k < j; ++k) pivot -= a(j, k) * a(j, k);
    // An infinite pivot takes the row out: what it scales becomes 0.
    const double inverse = pivot > floor ? 1 / std::sqrt(pivot) : 0;
    a(j, j) = inverse;
    for (Eigen::Index i = j + 1; i < m; ++i) {
      double sum = a(i, j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= a(i, k) * a(j, k);
      a(i, j) = sum * inverse;
    }
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) x[i] -= a(i, k) * x[k];
    x[i] *= a(i, i);
  }
  for (Eigen::Index i = m; i-- > 0;) {
    for (Eigen::Index k = i + 1; k < m; ++k) x[i] -= a(k, i) * x[k];
    x[i] *= a(i, i);
  }
}

void roundTogether(int bits, Eigen::Ref<Eigen::VectorXd> x) {
  const double largest = x.lpNorm<Eigen::Infinity>();
  if (!(largest > 1e-200 && largest < 1e200)) return;
  const double unit = std::ldexp(1.0, std::ilogb(largest) - bits), perUnit = 1 / unit;
  for (double& entry : x) entry = unit * std::round(perUnit * entry);
}

namespace {

// The rotation of rows and columns p and q that makes a(p, q) zero.
void rotate(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> vectors, Eigen::Index p, Eigen::Index q) {
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1 / (std::abs(theta) + std::sqrt(theta * theta + 1)), theta);
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const double kp = a(k, p), kq = a(k, q);
    a(k, p) = c * kp - s * kq;
    a(k, q) = s * kp + c * kq;
  }
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const double pk = a(p, k), qk = a(q, k);
    a(p, k) = c * pk - s * qk;
    a(q, k) = s * pk + c * qk;
    const double vp = vectors(k, p), vq = vectors(k, q);
    vectors(k, p) = c * vp - s * vq;
    vectors(k, q) = s * vp + c * vq;
  }
  a(p, q) = a(q, p) = 0;
}

}  // namespace

void symmetricEigen(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> vectors) {
  const Eigen::Index m = a.rows();
  vectors.setIdentity();
  const double negligible = 1e-15 * a.diagonal().cwiseAbs().sum() / static_cast<double>(m);
  for (int sweep = 0; sweep < 30; ++sweep) {
    bool rotated = false;
    for (Eigen::Index p = 0; p < m; ++p) {
      for (Eigen::Index q = p + 1; q < m; ++q) {
        if (std::abs(a(p, q)) <= negligible) continue;
        rotate(a, vectors, p, q);
        rotated = true;
      }
    }
    if (!rotated) return;
  }
}

}  // namespace limber
