#include "limber/skeleton/ik/solvers/selectively_damped.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/core/small_solve.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kLargestChange = kPi / 4;  // gamma_max of the paper, of any one angle
constexpr double kEqual = 1e-8;             // singular values whose squares differ by less of the largest are equal

class SelectivelyDamped : public JacobianIteration {
 public:
  explicit SelectivelyDamped(const IkSystem& system) : JacobianIteration(system) {
    const auto rows = static_cast<Eigen::Index>(system.effectors.size() * 6);
    vectors_.resize(rows, rows);
    weights_.resize(rows);
    sum_.resize(rows);
    std::size_t columns = 0;
    for (const IkSystem::Node& node : system.nodes) columns += node.slides ? 6 : 3;
    sizes_.resize(rows / 3, static_cast<Eigen::Index>(columns));
  }

 private:
  // Of vectors with equal singular values, as left and right ones have, only the span says anything: of that, the part
  // of the error in it is taken for the vector. So mirrored problems have mirrored answers.
  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const Eigen::Index m = y.size(), blocks = m / 3, columns = rows.jacobian.cols();
    for (Eigen::Index c = 0; c < columns; ++c) {
      for (Eigen::Index b = 0; b < blocks; ++b) sizes_(b, c) = rows.jacobian.col(c).segment<3>(3 * b).norm();
    }
    auto vectors = vectors_.topLeftCorner(m, m);
    symmetricEigen(rows.gram, vectors);
    const double most = rows.gram.diagonal().maxCoeff();
    Eigen::Ref<Eigen::MatrixXd> gram(rows.gram);
    auto weights = weights_.head(m);
    weights.setZero();
    auto sum = sum_.head(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      if (!(gram(i, i) > 1e-14 * most)) continue;
      sum.setZero();
      double square = 0;
      for (Eigen::Index k = m; k-- > i;) {
        if (std::abs(gram(k, k) - gram(i, i)) > kEqual * most) continue;
        const double along = vectors.col(k).dot(y);
        sum += along * vectors.col(k);
        square += along * along * gram(k, k);
        if (k > i) gram(k, k) = 0;
      }
      const double length = sum.norm();
      if (!(length > 0)) continue;
      sum /= length;
      weights += weightOf(rows, y, sum, std::sqrt(square) / length) * sum;
    }
    y = weights;
  }

  // How far to go along one left singular vector: phi_i of the paper, as a multiple of J^T u_i.
  double weightOf(const JacobianRows& rows, const Eigen::Ref<Eigen::VectorXd>& error,
                  const Eigen::Ref<const Eigen::VectorXd>& u, double sigma) {
    const Eigen::Index blocks = error.size() / 3, columns = rows.jacobian.cols();
    double moves = 0;  // N_i: how far the effectors go for a unit along u
    for (Eigen::Index b = 0; b < blocks; ++b) moves += u.segment<3>(3 * b).norm();
    double couldMove = 0;  // M_i: how far they would if all joints moved them in the same direction
    double largest = 0;
    for (Eigen::Index c = 0; c < columns; ++c) {
      const double v = std::abs(rows.jacobian.col(c).dot(u)) / sigma;
      largest = std::max(largest, v);
      couldMove += v * sizes_.col(c).head(blocks).sum();
    }
    couldMove /= sigma;
    const double bound = kLargestChange * std::min(1.0, couldMove > 0 ? moves / couldMove : 1.0);
    const double wanted = u.dot(error) / sigma;
    const double allowed =
        wanted * largest > bound || wanted * largest < -bound ? std::copysign(bound / largest, wanted) : wanted;
    return allowed / sigma;
  }

  Eigen::MatrixXd vectors_;
  Eigen::VectorXd weights_, sum_;
  Eigen::MatrixXd sizes_;  // blocks of three rows x columns: how far a joint moves an effector
};

}  // namespace

std::unique_ptr<IkIteration> makeSelectivelyDamped(const IkSystem& system) {
  return std::make_unique<SelectivelyDamped>(system);
}

}  // namespace limber
