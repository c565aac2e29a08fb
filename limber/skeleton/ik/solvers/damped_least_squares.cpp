#include "limber/skeleton/ik/solvers/damped_least_squares.h"

#include "limber/core/small_solve.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kDampingFraction = 0.1;  // damping, of the squared distance left to go
constexpr double kMin = 1e-12;            // of the Gram matrix's trace, against singular ones

class DampedLeastSquares : public JacobianIteration {
 public:
  DampedLeastSquares(const IkSystem& system, std::vector<double> gains, double fraction)
      : JacobianIteration(system, std::move(gains)), fraction_(fraction) {}

 private:
  bool heedsCaution() const override { return true; }

  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const double damping = fraction_ * rows.caution * y.squaredNorm() + kMin * rows.gram.diagonal().sum();
    solveCholesky(rows.gram, damping, y);
  }

  double fraction_;
};

}  // namespace

std::unique_ptr<IkIteration> makeDampedLeastSquares(const IkSystem& system) {
  return makeDampedIteration(system, freedomsOf(system), kDampingFraction);
}

std::unique_ptr<IkIteration> makeDampedIteration(const IkSystem& system, std::vector<double> gains, double fraction) {
  return std::make_unique<DampedLeastSquares>(system, std::move(gains), fraction);
}

}  // namespace limber
