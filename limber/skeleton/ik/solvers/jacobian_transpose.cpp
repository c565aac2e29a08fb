#include "limber/skeleton/ik/solvers/jacobian_transpose.h"

#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

// Steps of length that follow from J * J^T * y alone zigzag where effectors pull at the same joints: none of 30
// humanoids with five effectors was solved. Combined with the step before, as the method of conjugate residuals does
// (Stiefel 1952), all are.
class JacobianTranspose : public JacobianIteration {
 public:
  explicit JacobianTranspose(const IkSystem& system) : JacobianIteration(system) {
    const auto rows = static_cast<Eigen::Index>(system.effectors.size() * 6);
    moved_.resize(rows);
    movedBefore_.resize(rows);
    before_.resize(rows);
    now_.resize(rows);
  }

 private:
  // The combination a * y + b * (last step's y) after which least is left to go, were the effectors to go straight.
  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    if (rows.begin == 0 && rows.iteration != iteration_) before_ = now_;
    iteration_ = rows.iteration;
    auto moved = moved_.head(y.size()), movedBefore = movedBefore_.head(y.size());
    auto before = before_.segment(rows.begin, y.size());
    if (rows.iteration == 0) before.setZero();
    moved.noalias() = rows.gram.lazyProduct(y);
    movedBefore.noalias() = rows.gram.lazyProduct(before);
    const double yy = moved.squaredNorm(), yb = moved.dot(movedBefore), bb = movedBefore.squaredNorm();
    const double wantedY = moved.dot(y), wantedB = movedBefore.dot(y);
    const double determinant = yy * bb - yb * yb;
    double a = yy > 0 ? wantedY / yy : 0, b = 0;
    if (determinant > kIndependent * yy * bb) {
      a = (wantedY * bb - wantedB * yb) / determinant;
      b = (wantedB * yy - wantedY * yb) / determinant;
    }
    y = a * y + b * before;
    now_.segment(rows.begin, y.size()) = y;
  }

  static constexpr double kIndependent = 1e-12;

  Index iteration_ = 0;
  Eigen::VectorXd moved_, movedBefore_;  // J * J^T * y: where the effectors go
  Eigen::VectorXd before_, now_;         // weights of the last step and of this one
};

}  // namespace

std::unique_ptr<IkIteration> makeJacobianTranspose(const IkSystem& system) {
  return std::make_unique<JacobianTranspose>(system);
}

}  // namespace limber
