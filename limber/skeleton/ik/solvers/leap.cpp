#include "limber/skeleton/ik/solvers/leap.h"

#include <algorithm>

#include "limber/core/rotation.h"

namespace limber {

namespace {

constexpr double kFurthest = 64;     // times the last sweep's turns
constexpr double kMinWeight = 0.01;  // of an effector that has arrived

}  // namespace

double Leap::take(IkSystem& system) {
  const double cost = system.cost();
  system.save(after_);
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3 turned = toRotationVector(before_.locals[i].conjugate() * after_.locals[i]);
    system.locals[i] = (after_.locals[i] * fromRotationVector(factor_ * turned)).normalized();
    if (system.nodes[i].slides) system.offsets[i] += factor_ * (after_.offsets[i] - before_.offsets[i]);
    system.limitNode(n);
  }
  system.forward();
  const double further = system.cost();
  if (further < cost) {
    factor_ = std::min(2 * factor_, kFurthest);
    return further;
  }
  system.restore(after_);
  factor_ = std::max(factor_ / 2, 1.0);
  return cost;
}

void heedTheFurthest(const IkSystem& system, std::vector<double>& weights) {
  const auto left = [&](std::size_t e) {
    const double reach = system.effectors[e].reach;
    return reach > 0 ? system.distance(e) / reach : 0;
  };
  double most = 0;
  for (std::size_t e = 0; e < weights.size(); ++e) most = std::max(most, left(e));
  for (std::size_t e = 0; e < weights.size(); ++e) {
    const double fraction = most > 0 ? left(e) / most : 1;
    weights[e] = system.effectors[e].weight * (kMinWeight + (1 - kMinWeight) * fraction * fraction);
  }
}

}  // namespace limber
