#include "limber/ik/jacobian_transpose.h"

#include "limber/ik/jacobian_iteration.h"

namespace limber {

namespace {

class JacobianTranspose : public JacobianIteration {
 public:
  explicit JacobianTranspose(const IkSystem& system) : JacobianIteration(system), moved_(system.effectors.size() * 6) {}

 private:
  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    auto moved = moved_.head(y.size());
    moved.noalias() = rows.gram.lazyProduct(y);
    const double squared = moved.squaredNorm();
    if (!(squared > 0)) {
      y.setZero();
      return;
    }
    constexpr double kRelaxation[] = {1.9, 0.7, 1.3, 0.5, 1.6};
    y *= kRelaxation[rows.iteration % 5] * y.dot(moved) / squared;
  }

  Eigen::VectorXd moved_;  // J * J^T * y: where the effectors go, per unit of step
};

}  // namespace

std::unique_ptr<IkIteration> makeJacobianTranspose(const IkSystem& system) {
  return std::make_unique<JacobianTranspose>(system);
}

}  // namespace limber
