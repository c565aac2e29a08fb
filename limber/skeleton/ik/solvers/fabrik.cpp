#include "limber/skeleton/ik/solvers/fabrik.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/solvers/goal_iteration.h"

namespace limber {

namespace {

constexpr Index kFabrikPatience = 10;      // iterations after which there must have been
constexpr double kFabrikProgress = 0.999;  // this factor on the cost

// Of the squared length that a bone should have: so near to it, three terms of a series stand in for a root and a
// quotient, which would take most of the time. They are off by 4e-5 at most, and by the cube of what is left to go as
// the chain settles.
constexpr double kNearly = 0.05;
constexpr double kFurthestAim = 3;  // times what is left to go

// `joint` moved to the distance `length` from `fixed`, on the line between them. Each joint waits for the one before,
// so what counts is how few operations follow each other: the series is in the square itself.
inline Vec3 pulled(const Vec3& joint, const Vec3& fixed, const FabrikBone& bone) {
  const Vec3 line = joint - fixed;
  const double squared = line.squaredNorm();
  if (std::abs(squared * bone.perSquaredLength - 1) < kNearly) {
    const double factor = (1.875 + bone.linear * squared) + bone.quadratic * (squared * squared);
    return fixed + line * factor;
  }
  // Joints that coincide have no line; any will do, as the next pass moves them again.
  if (!(squared > 1e-300)) return fixed + bone.length * Vec3::UnitX();
  return fixed + line * (bone.length / std::sqrt(squared));
}

// Each iteration leaves about the same fraction r of the distance left. So the tip is pulled beyond its target, by the
// distance that the next iteration should leave: of the distance left, (1 + aim) * (1 - r) is then covered.
double nextAim(double aim, const Vec3& before, const Vec3& left) {
  const double gone = 1 - left.dot(before) / before.squaredNorm();
  return gone > 0 ? std::clamp((1 + aim) / gone - 1, 0.0, kFurthestAim) : 0;
}

}  // namespace

Index fabrikChain(std::span<Vec3> positions, std::span<const FabrikBone> bones, const Vec3& target, double tolerance,
                  Index budget) {
  const std::size_t last = positions.size() - 1;
  const Vec3 base = positions[0];
  double reach = 0;
  for (const FabrikBone& bone : bones) reach += bone.length;
  if ((target - base).norm() >= reach) {
    for (std::size_t i = 0; i < last; ++i) {
      positions[i + 1] = pulled(target, positions[i], bones[i]);
    }
    return 1;
  }
  Vec3 left = target - positions[last];
  double checked = left.squaredNorm(), aim = 0;
  bool aims = true;
  for (Index iteration = 0; iteration < budget; ++iteration) {
    Vec3 joint = positions[last] = target + aim * left;
    for (std::size_t i = last; i-- > 1;) positions[i] = joint = pulled(positions[i], joint, bones[i]);
    joint = base;
    for (std::size_t i = 0; i < last; ++i) positions[i + 1] = joint = pulled(positions[i + 1], joint, bones[i]);
    const Vec3 before = left;
    left = target - joint;
    const double cost = left.squaredNorm();
    if (cost <= tolerance * tolerance) return iteration + 1;
    aim = aims ? nextAim(aim, before, left) : 0;
    // Nothing is gained by an aim out of reach: it would straighten the chain.
    if ((target + aim * left - base).squaredNorm() >= reach * reach) aim = 0;
    if (iteration % kFabrikPatience != kFabrikPatience - 1) continue;
    if (!(cost < kFabrikProgress * checked)) {
      if (!aims) return iteration + 1;
      aims = false;
    }
    checked = cost;
  }
  return budget;
}

namespace {

// A free chain without branches, limits or anything else to mind.
class FabrikChain : public IkIteration {
 public:
  explicit FabrikChain(const IkSystem& system)
      : positions_(system.nodes.size()),
        offsets_(system.nodes.size(), Vec3::Zero()),
        bones_(system.nodes.size() - 1, FabrikBone(0)) {}

  static bool fits(const IkSystem& system) {
    if (system.effectors.size() != 1 || system.limited() || system.nodes[0].slides) return false;
    const auto free = [](const IkSystem::Node& node) { return node.freedom == 1; };
    return system.nodes.size() > 1 && std::all_of(system.nodes.begin(), system.nodes.end(), free);
  }

  Index run(IkSystem& system, Index budget) override {
    const IkSystem::Effector& effector = system.effectors[0];
    for (std::size_t n = 0; n < positions_.size(); ++n) {
      positions_[n] = system.positions[n];
      // Mostly the length is that of the last frame.
      if (n > 0 && system.offsets[n] != offsets_[n]) {
        offsets_[n] = system.offsets[n];
        bones_[n - 1] = FabrikBone(offsets_[n].norm());
      }
    }
    const double tolerance = std::max(0.99 * system.options().tolerance, 1e-9) * effector.reach;
    const Index iterations = fabrikChain(positions_, bones_, effector.target, tolerance, budget);
    turnBones(system);
    if (effector.angleScale > 0) {
      const std::size_t tip = positions_.size() - 1;
      system.locals[tip] =
          (system.parentRotation(static_cast<int>(tip)).conjugate() * effector.orientation).normalized();
      system.globals[tip] = effector.orientation;
    }
    return iterations;
  }

 private:
  // From the base on, the smallest turn of each bone, as its parent carries it, to where the joints have gone.
  void turnBones(IkSystem& system) const {
    Quat parent = system.parentRotation(0);
    Vec3 position = system.positions[0];
    const std::size_t last = positions_.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
      Quat& local = system.locals[n];
      if (n < last && bones_[n].length > 0) {
        const Vec3 wanted = parent.conjugate() * Vec3(positions_[n + 1] - position);
        local = shortestRotation(local * system.offsets[n + 1], wanted) * local;
        local.coeffs() *= 1.5 - 0.5 * local.squaredNorm();  // a Newton step to unit length, enough against rounding
      }
      system.positions[n] = position;
      parent = system.globals[n] = parent * local;
      if (n < last) position += parent * system.offsets[n + 1];
    }
  }

  std::vector<Vec3> positions_, offsets_;  // offsets_: those of bones_
  std::vector<FabrikBone> bones_;
};

class FabrikTree : public GoalIteration {
 public:
  explicit FabrikTree(const IkSystem& system) : GoalIteration(system), sums_(system.nodes.size()) {}

 private:
  // Where every joint should go: effectors to their targets, a joint above to the centroid, by weight, of where its
  // children and its own target want it.
  void setGoals(const IkSystem& system) override {
    std::fill(sums_.begin(), sums_.end(), Vec3::Zero());
    std::fill(weights_.begin(), weights_.end(), 0.0);
    for (std::size_t e = 0; e < heed_.size(); ++e) {
      const auto n = static_cast<std::size_t>(system.effectors[e].node);
      sums_[n] += heed_[e] * system.effectors[e].target;
      weights_[n] += heed_[e];
    }
    for (std::size_t n = system.nodes.size(); n-- > 0;) {
      goals_[n] = sums_[n] / weights_[n];
      if (system.nodes[n].parent < 0) continue;
      const auto p = static_cast<std::size_t>(system.nodes[n].parent);
      const Vec3 line = system.positions[p] - goals_[n];
      const double stretch = line.norm();
      const Vec3 wanted = stretch > 0 ? Vec3(goals_[n] + line * (system.offsets[n].norm() / stretch)) : goals_[n];
      sums_[p] += weights_[n] * wanted;
      weights_[p] += weights_[n];
    }
  }

  std::vector<Vec3> sums_;
};

}  // namespace

std::unique_ptr<IkIteration> makeFabrik(const IkSystem& system) {
  if (FabrikChain::fits(system)) return std::make_unique<FabrikChain>(system);
  return std::make_unique<FabrikTree>(system);
}

}  // namespace limber
