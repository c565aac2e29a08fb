#include "limber/skeleton/ik/solvers/whole_body.h"

#include "limber/skeleton/ik/solvers/damped_least_squares.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kBodyDampingFraction = 0.05;  // damping, of the squared distance left to go
constexpr double kWillingness = 0.3;           // of a joint that carries everything, against one that carries nothing

// A node's freedom, reduced by the load it carries: the fraction of the length of all bones.
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

}  // namespace

std::unique_ptr<IkIteration> makeWholeBody(const IkSystem& system) {
  return makeDampedIteration(system, gainsByLoad(system), kBodyDampingFraction);
}

}  // namespace limber
