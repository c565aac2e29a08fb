#include "limber/skeleton/ik/solvers/pseudo_inverse.h"

#include <algorithm>
#include <cmath>

#include "limber/core/small_solve.h"
#include "limber/core/text/numbers.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kNegligible = 1e-6;  // squared singular values below this fraction of the largest are taken for 0
constexpr double kMaxStep = kPi / 4;  // radians, of all joints together, along one singular vector

class PseudoInverse : public JacobianIteration {
 public:
  explicit PseudoInverse(const IkSystem& system) : JacobianIteration(system) {
    const auto rows = static_cast<Eigen::Index>(system.effectors.size() * 6);
    vectors_.resize(rows, rows);
    coordinates_.resize(rows);
  }

 private:
  bool heedsCaution() const override { return true; }

  // Along a chain that is all but straight only a very long step would reach. Were the whole step shortened to one that
  // joints can make, nothing would be left of what the other directions have to go: so each is shortened by itself.
  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const Eigen::Index m = y.size();
    auto vectors = vectors_.topLeftCorner(m, m);
    symmetricEigen(rows.gram, vectors);
    const double least = kNegligible * rows.gram.diagonal().maxCoeff();
    const double longest = kMaxStep / std::max(1.0, rows.caution);
    for (Eigen::Index i = 0; i < m; ++i) {
      const double value = rows.gram(i, i);
      if (!(value > least)) {
        coordinates_[i] = 0;
        continue;
      }
      const double singular = std::sqrt(value);
      coordinates_[i] = std::clamp(vectors.col(i).dot(y) / singular, -longest, longest) / singular;
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
