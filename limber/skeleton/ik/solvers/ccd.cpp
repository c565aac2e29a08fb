#include "limber/skeleton/ik/solvers/ccd.h"

#include <cmath>

#include "limber/core/rotation.h"
#include "limber/core/rotation_fit.h"
#include "limber/skeleton/ik/solvers/leap.h"

namespace limber {

namespace {

constexpr Index kCcdPatience = 10;      // sweeps after which there must have been
constexpr double kCcdProgress = 0.999;  // this factor on the cost
constexpr Index kUnaided = 10;          // sweeps of a single effector before leaps

// From the tip, the k-th free joint from the base turns by k^-kEvenness of its best angle. Whole turns curl the tip up
// before the base has moved: 70 sweeps for a chain of 10 to a millionth of its length, against 27 (0: whole turns;
// 0.35: 27; 0.5: 35; 1: 50).
constexpr double kEvenness = 0.4;

// A system sweeps over its joints and follows only the effectors: positions of the other joints are derived once a
// sweep.
class CcdIteration : public IkIteration {
 public:
  CcdIteration(const IkSystem& system, bool fromTips)
      : fromTips_(fromTips),
        positions_(system.effectors.size()),
        rotations_(system.effectors.size()),
        leap_(system),
        best_(system.makeState()) {
    for (const IkSystem::Effector& effector : system.effectors) {
      weights_.push_back(effector.weight);
      const IkSystem::Node& node = system.nodes[static_cast<std::size_t>(effector.node)];
      // A free joint at the end of its limb takes any orientation: no other joint need turn for it.
      turnsItself_.push_back(!node.limit && node.freedom == 1 && node.childCount == 0);
    }
    for (const IkSystem::Node& node : system.nodes) {
      const double depth = node.parent < 0 ? 1 : 1 + depths_[static_cast<std::size_t>(node.parent)];
      depths_.push_back(depth);
      fractions_.push_back(node.freedom * (fromTips ? std::pow(depth, -kEvenness) : 1));
    }
  }

  Index run(IkSystem& system, Index budget) override {
    const bool several = system.effectors.size() > 1;
    double best = system.cost(), checked = best;
    system.save(best_);
    leap_.restart();
    weights_[0] = system.effectors[0].weight;
    for (Index done = 1; done <= budget; ++done) {
      const bool leaps = several || done > kUnaided;
      if (leaps) leap_.mark(system);
      if (several) heedTheFurthest(system, weights_);
      sweep(system);
      if (system.allReached()) return done;
      if (!leaps) continue;
      const double cost = leap_.take(system);
      if (cost < best) {
        best = cost;
        system.save(best_);
        if (system.allReached()) return done;
      }
      if (done % kCcdPatience != 0) continue;
      if (!(best < kCcdProgress * checked)) {
        budget = done;
      }
      checked = best;
    }
    if (!(system.cost() <= best)) system.restore(best_);
    return budget;
  }

 private:
  void sweep(IkSystem& system) {
    for (std::size_t e = 0; e < system.effectors.size(); ++e) {
      const auto node = static_cast<std::size_t>(system.effectors[e].node);
      positions_[e] = system.positions[node];
      rotations_[e] = system.globals[node];
    }
    const int count = system.nodeCount();
    if (fromTips_) {
      for (int n = count; n-- > 0;) visit(system, n);
      system.forward();
    } else {
      for (int n = 0; n < count; ++n) {
        const auto i = static_cast<std::size_t>(n);
        const Quat parent = system.parentRotation(n);
        system.globals[i] = parent * system.locals[i];
        system.positions[i] = system.parentPosition(n) + parent * system.offsets[i];
        visit(system, n);
      }
    }
  }

  void visit(IkSystem& system, int node) {
    const IkSystem::Node& info = system.nodes[static_cast<std::size_t>(node)];
    if (info.freedom == 0) return;
    if (info.slides) slide(system, node);
    const std::span<const int> below = system.effectorsBelow(node);
    const auto first = static_cast<std::size_t>(below[0]);
    if (below.size() == 1 && !info.limit && !angleCounts(system, first, node)) {
      if (system.effectors[first].node == node) return;  // turning moves nothing
      const Vec3& pivot = system.positions[static_cast<std::size_t>(node)];
      const Vec3 from = positions_[first] - pivot, to = system.effectors[first].target - pivot;
      if (!(from.squaredNorm() > 0 && to.squaredNorm() > 0)) return;
      const double fraction = fractions_[static_cast<std::size_t>(node)];
      Quat turned = shortestRotation(from, to);
      if (fraction < 1) {  // about this fraction of its angle: exact enough, and much cheaper than slerp
        turned.coeffs() *= fraction;
        turned.w() += 1 - fraction;
        turned.coeffs() /= std::sqrt(turned.squaredNorm());
      }
      turnFreely(system, node, turned, first);
    } else if (info.limit) {
      const TurnAxes axes = turnAxes(*info.limit, system.locals[static_cast<std::size_t>(node)]);
      if (axes.count == 3) turn(system, node, bestRotation(correlation(system, node)));
      for (int k = 0; k < axes.count && axes.count < 3; ++k) {
        const Vec3 axis = system.globals[static_cast<std::size_t>(node)] * axes.axes[static_cast<std::size_t>(k)];
        turn(system, node, Quat(Eigen::AngleAxisd(bestAngle(correlation(system, node), axis), axis)));
      }
    } else {
      turn(system, node, bestRotation(correlation(system, node)));
    }
  }

  // turn() for a node without limits and with one effector, whose orientation does not matter here.
  void turnFreely(IkSystem& system, int node, const Quat& turn, std::size_t effector) {
    const auto n = static_cast<std::size_t>(node);
    const Vec3& pivot = system.positions[n];
    system.globals[n] = turn * system.globals[n];
    Quat& local = system.locals[n];
    local = system.parentRotation(node).conjugate() * system.globals[n];
    local.coeffs() *= 1.5 - 0.5 * local.squaredNorm();  // a Newton step to unit length, enough against rounding
    positions_[effector] = pivot + turn * Vec3(positions_[effector] - pivot);
    rotations_[effector] = turn * rotations_[effector];
  }

  bool angleCounts(const IkSystem& system, std::size_t effector, int node) const {
    const IkSystem::Effector& e = system.effectors[effector];
    return e.angleScale > 0 && (e.node == node || !turnsItself_[effector]);
  }

  Mat3 correlation(const IkSystem& system, int node) const {
    Mat3 sum = Mat3::Zero();
    const Vec3& pivot = system.positions[static_cast<std::size_t>(node)];
    for (const int below : system.effectorsBelow(node)) {
      const auto e = static_cast<std::size_t>(below);
      const IkSystem::Effector& effector = system.effectors[e];
      if (effector.node != node) {
        sum += weights_[e] * (effector.target - pivot) * (positions_[e] - pivot).transpose();
      }
      if (angleCounts(system, e, node)) {
        const double scale = weights_[e] * effector.angleScale * effector.angleScale;
        sum += scale * (effector.orientation * rotations_[e].conjugate()).toRotationMatrix();
      }
    }
    return sum;
  }

  // What the effectors below a node still have to go, as IkSystem::cost.
  double costBelow(const IkSystem& system, int node) const {
    double sum = 0;
    for (const int below : system.effectorsBelow(node)) {
      const auto e = static_cast<std::size_t>(below);
      const IkSystem::Effector& effector = system.effectors[e];
      sum += weights_[e] * (effector.target - positions_[e]).squaredNorm();
      if (!angleCounts(system, e, node)) continue;
      const double angle = effector.angleScale * angleBetween(rotations_[e], effector.orientation);
      sum += weights_[e] * angle * angle;
    }
    return sum;
  }

  void carry(const IkSystem& system, int node, const Quat& turn, const Vec3& pivot) {
    for (const int below : system.effectorsBelow(node)) {
      const auto e = static_cast<std::size_t>(below);
      positions_[e] = pivot + turn * Vec3(positions_[e] - pivot);
      rotations_[e] = turn * rotations_[e];
    }
  }

  // Turns the node by a global rotation, as far as its limits and stiffness let it.
  void turn(IkSystem& system, int node, Quat turn) {
    const auto n = static_cast<std::size_t>(node);
    const IkSystem::Node& info = system.nodes[n];
    const Vec3 pivot = system.positions[n];
    if (info.freedom < 1) turn = Quat::Identity().slerp(info.freedom, turn);
    const Quat parent = system.parentRotation(node);
    const Quat before = system.locals[n], beforeGlobal = system.globals[n];
    system.locals[n] = (parent.conjugate() * (turn * beforeGlobal)).normalized();
    if (!info.limit) {
      system.globals[n] = turn * beforeGlobal;
      carry(system, node, turn, pivot);
      return;
    }
    const double cost = costBelow(system, node);
    system.limitNode(node);
    system.globals[n] = parent * system.locals[n];
    const Quat turned = system.globals[n] * beforeGlobal.conjugate();
    carry(system, node, turned, pivot);
    if (costBelow(system, node) <= cost) return;
    carry(system, node, turned.conjugate(), pivot);
    system.locals[n] = before;
    system.globals[n] = beforeGlobal;
  }

  // Moves a sliding node by the weighted mean of what its effectors have to go.
  void slide(IkSystem& system, int node) {
    const auto n = static_cast<std::size_t>(node);
    Vec3 gap = Vec3::Zero();
    double weights = 0;
    for (const int below : system.effectorsBelow(node)) {
      const IkSystem::Effector& effector = system.effectors[static_cast<std::size_t>(below)];
      gap += effector.weight * (effector.target - positions_[static_cast<std::size_t>(below)]);
      weights += effector.weight;
    }
    const Quat parent = system.parentRotation(node);
    const Vec3 before = system.offsets[n];
    system.offsets[n] += parent.conjugate() * Vec3(system.nodes[n].freedom / weights * gap);
    system.limitNode(node);
    const Vec3 moved = parent * Vec3(system.offsets[n] - before);
    system.positions[n] += moved;
    for (const int below : system.effectorsBelow(node)) positions_[static_cast<std::size_t>(below)] += moved;
  }

  bool fromTips_;
  std::vector<Vec3> positions_;  // of the effectors, while a sweep goes on
  std::vector<Quat> rotations_;
  std::vector<double> weights_;  // of the effectors, in this sweep
  std::vector<char> turnsItself_;
  std::vector<double> depths_, fractions_;
  Leap leap_;
  IkSystem::State best_;
};

}  // namespace

std::unique_ptr<IkIteration> makeCcdBackward(const IkSystem& system) {
  return std::make_unique<CcdIteration>(system, true);
}

std::unique_ptr<IkIteration> makeCcdForward(const IkSystem& system) {
  return std::make_unique<CcdIteration>(system, false);
}

}  // namespace limber
