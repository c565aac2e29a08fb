#include "limber/skeleton/ik/solvers/damped_least_squares.h"

#include "limber/core/small_solve.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kDampingShare = 0.1;  // damping, of the squared distance left to go
constexpr double kLeast = 1e-12;       // of the Gram matrix's trace, against singular ones

class DampedLeastSquares : public JacobianIteration {
 public:
  DampedLeastSquares(const IkSystem& system, std::vector<double> gains, double share)
      : JacobianIteration(system, std::move(gains)), share_(share) {}

 private:
  bool heedsCaution() const override { return true; }

  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const double damping = share_ * rows.caution * y.squaredNorm() + kLeast * rows.gram.diagonal().sum();
    solveCholesky(rows.gram, damping, y);
  }

  double share_;
};

}  // namespace

std::unique_ptr<IkIteration> makeDampedLeastSquares(const IkSystem& system) {
  return makeDampedIteration(system, freedomsOf(system), kDampingShare);
}

std::unique_ptr<IkIteration> makeDampedIteration(const IkSystem& system, std::vector<double> gains, double share) {
  return std::make_unique<DampedLeastSquares>(system, std::move(gains), share);
}

}  // namespace limber
