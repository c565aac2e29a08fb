#include "limber/ik/pseudo_inverse.h"

#include "limber/ik/jacobian_iteration.h"
#include "limber/ik/small_solve.h"

namespace limber {

namespace {

// Squared singular values below this share of the largest are taken for 0. Where a step gains nothing, more of them
// are: along a chain that is all but straight only a very long step would reach, and shortened to one that joints can
// make it would leave nothing of what the other directions have to go.
constexpr double kNegligible = 1e-6;

class PseudoInverse : public JacobianIteration {
 public:
  explicit PseudoInverse(const IkSystem& system) : JacobianIteration(system) {
    const auto rows = static_cast<Eigen::Index>(system.effectors.size() * 6);
    vectors_.resize(rows, rows);
    coordinates_.resize(rows);
  }

 private:
  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const Eigen::Index m = y.size();
    auto vectors = vectors_.topLeftCorner(m, m);
    symmetricEigen(rows.gram, vectors);
    const double least = kNegligible * rows.caution * rows.caution * rows.gram.diagonal().maxCoeff();
    for (Eigen::Index i = 0; i < m; ++i) {
      const double value = rows.gram(i, i);
      coordinates_[i] = value > least ? vectors.col(i).dot(y) / value : 0;
    }
    y.setZero();
    for (Eigen::Index i = 0; i < m; ++i) y += coordinates_[i] * vectors.col(i);
  }

  Eigen::MatrixXd vectors_;
  Eigen::VectorXd coordinates_;
};

}  // namespace

std::unique_ptr<IkIteration> makePseudoInverse(const IkSystem& system) {
  return std::make_unique<PseudoInverse>(system);
}

}  // namespace limber
