#include "limber/ik/mass_spring.h"

#include <algorithm>
#include <cmath>

#include "limber/ik/damped_least_squares.h"
#include "limber/ik/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kSpringDamping = 0.1;  // of the squared distance left to go: what M / t^2 begins with
// What the lightest joint counts as of the heaviest at least. Without a bound tips whip about and the base stays.
constexpr double kLeastInertia = 1e-2;

// 1 / sqrt(inertia), so that a step damped evenly in the columns of IkJacobian is damped by inertia in the joints.
std::vector<double> gainsByInertia(const IkSystem& system) {
  std::vector<double> inertia(system.nodes.size(), 0.0);
  double most = 0;
  std::vector<Vec3> places(system.nodes.size(), Vec3::Zero());
  std::vector<Quat> turns(system.nodes.size(), Quat::Identity());
  for (std::size_t n = 0; n < places.size(); ++n) {
    const int parent = system.nodes[n].parent;
    const auto p = static_cast<std::size_t>(std::max(parent, 0));
    turns[n] = parent < 0 ? system.references[n] : turns[p] * system.references[n];
    if (parent < 0) continue;
    places[n] = places[p] + turns[p] * system.referenceOffsets[n];
    const double mass = system.referenceOffsets[n].norm();
    for (int above = parent; above >= 0; above = system.nodes[static_cast<std::size_t>(above)].parent) {
      const auto a = static_cast<std::size_t>(above);
      inertia[a] += mass * (0.5 * (places[p] + places[n]) - places[a]).squaredNorm() + mass * mass * mass / 12;
      most = std::max(most, inertia[a]);
    }
  }
  std::vector<double> gains = freedomsOf(system);
  for (std::size_t n = 0; n < gains.size() && most > 0; ++n) {
    gains[n] /= std::sqrt(std::max(inertia[n] / most, kLeastInertia));
  }
  return gains;
}

}  // namespace

std::unique_ptr<IkIteration> makeMassSpring(const IkSystem& system) {
  return makeDampedIteration(system, gainsByInertia(system), kSpringDamping);
}

}  // namespace limber
