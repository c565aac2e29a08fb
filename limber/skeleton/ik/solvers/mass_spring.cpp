#include "limber/skeleton/ik/solvers/mass_spring.h"

#include <algorithm>
#include <cmath>

#include "limber/skeleton/ik/solvers/damped_least_squares.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {

namespace {

constexpr double kSpringDamping = 0.1;  // of the squared distance left to go: what M / t^2 begins with
// What the lightest joint counts as of the heaviest at least. Without a bound tips whip about and the base stays.
constexpr double kMinInertia = 1e-2;

// Some of the rods together.
struct Rods {
  double mass = 0;
  Vec3 center = Vec3::Zero();
  double inertia = 0;  // polar, about the center

  void add(const Rods& more) {
    const double sum = mass + more.mass;
    if (!(sum > 0)) return;
    inertia += more.inertia + mass * more.mass / sum * (center - more.center).squaredNorm();
    center += more.mass / sum * (more.center - center);
    mass = sum;
  }
  double inertiaAbout(const Vec3& point) const { return inertia + mass * (center - point).squaredNorm(); }
};

// 1 / sqrt(inertia), so that a step damped evenly in the columns of IkJacobian is damped by inertia in the joints.
std::vector<double> gainsByInertia(const IkSystem& system) {
  const std::size_t count = system.nodes.size();
  std::vector<Vec3> positions(count, Vec3::Zero());
  std::vector<Quat> turns(count, Quat::Identity());
  for (std::size_t n = 0; n < count; ++n) {
    const int parent = system.nodes[n].parent;
    const auto p = static_cast<std::size_t>(std::max(parent, 0));
    turns[n] = parent < 0 ? system.references[n] : turns[p] * system.references[n];
    if (parent >= 0) positions[n] = positions[p] + turns[p] * system.referenceOffsets[n];
  }
  std::vector<Rods> below(count);  // each node
  std::vector<double> inertia(count, 0.0);
  double most = 0;
  for (std::size_t n = count; n-- > 0;) {
    inertia[n] = below[n].inertiaAbout(positions[n]);
    most = std::max(most, inertia[n]);
    if (system.nodes[n].parent < 0) continue;
    const auto p = static_cast<std::size_t>(system.nodes[n].parent);
    const double mass = system.referenceOffsets[n].norm();
    below[p].add(below[n]);
    below[p].add({mass, 0.5 * (positions[p] + positions[n]), mass * mass * mass / 12});
  }
  std::vector<double> gains = freedomsOf(system);
  for (std::size_t n = 0; n < gains.size() && most > 0; ++n) {
    gains[n] /= std::sqrt(std::max(inertia[n] / most, kMinInertia));
  }
  return gains;
}

}  // namespace

std::unique_ptr<IkIteration> makeMassSpring(const IkSystem& system) {
  return makeDampedIteration(system, gainsByInertia(system), kSpringDamping);
}

}  // namespace limber
