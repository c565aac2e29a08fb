#include "limber/ik/whole_body.h"

#include <cmath>

#include "limber/ik/jacobian_iteration.h"
#include "limber/ik/small_solve.h"

namespace limber {

namespace {

constexpr double kShare = 0.05;       // damping, of the squared distance left to go
constexpr double kLeast = 1e-12;      // of the Gram matrix's trace, against singular ones
constexpr double kWillingness = 0.3;  // of a joint that carries everything, against one that carries nothing

// A node's freedom, less for one that carries more: its share of the length of all bones.
std::vector<double> gainsByLoad(const IkSystem& system) {
  std::vector<double> carried(system.nodes.size(), 0.0);
  double total = 0;
  for (std::size_t n = system.nodes.size(); n-- > 0;) {
    const int parent = system.nodes[n].parent;
    if (parent < 0) {
      total += carried[n];
    } else {
      const double length = system.referenceOffsets[n].norm();
      carried[static_cast<std::size_t>(parent)] += carried[n] + length;
    }
  }
  std::vector<double> gains = freedomsOf(system);
  for (std::size_t n = 0; n < gains.size() && total > 0; ++n) gains[n] *= 1 - (1 - kWillingness) * carried[n] / total;
  return gains;
}

class WholeBody : public JacobianIteration {
 public:
  explicit WholeBody(const IkSystem& system) : JacobianIteration(system, gainsByLoad(system)) {}

 private:
  bool heedsCaution() const override { return true; }

  void weighRows(const JacobianRows& rows, Eigen::Ref<Eigen::VectorXd> y) override {
    const double damping = kShare * rows.caution * y.squaredNorm() + kLeast * rows.gram.diagonal().sum();
    solveCholesky(rows.gram, damping, y);
  }
};

}  // namespace

std::unique_ptr<IkIteration> makeWholeBody(const IkSystem& system) {
  return std::make_unique<WholeBody>(system);
}

}  // namespace limber
