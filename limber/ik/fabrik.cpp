#include "limber/ik/fabrik.h"

#include <algorithm>
#include <cmath>

#include "limber/ik/leap.h"
#include "limber/ik/rotation.h"
#include "limber/ik/rotation_fit.h"

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

// Each iteration leaves about the same share of what was left to go. So the tip is pulled beyond its target, as far as
// the next iteration should leave: of 1 + aim times the way a share (1 + aim) * (1 - stays) is gone.
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

class FabrikTree : public IkIteration {
 public:
  explicit FabrikTree(const IkSystem& system)
      : goals_(system.nodes.size()),
        sums_(system.nodes.size()),
        weights_(system.nodes.size()),
        heed_(system.effectors.size()),
        leap_(system),
        best_(system.makeState()) {
    for (int n = 0; n < system.nodeCount(); ++n) {
      hangBegin_.push_back(hangs_.size());
      hangs_.resize(hangs_.size() + system.effectorsBelow(n).size());
    }
  }

  Index run(IkSystem& system, Index budget) override {
    double best = system.cost(), checked = best;
    system.save(best_);
    leap_.restart();
    Index done = 0;
    while (done < budget) {
      leap_.mark(system);
      heedTheFurthest(system, heed_);
      backward(system);
      servesEffectors_ = system.limited() && isTurnOfEffectors(done);
      forward(system);
      ++done;
      const double cost = system.allReached() ? system.cost() : leap_.take(system);
      if (cost < best) {
        best = cost;
        system.save(best_);
        if (system.allReached()) return done;
      }
      if (done % kFabrikPatience != 0) continue;
      if (!(best < kFabrikProgress * checked)) break;
      checked = best;
    }
    system.restore(best_);
    return done;
  }

 private:
  // A single limb is left to the joints' goals for its first iterations, which mostly do. Where limbs share joints at
  // their limits, the goals mislead more than they help: with every other iteration by them 74 of 100 humanoids were
  // solved, with every eighth 97.
  bool isTurnOfEffectors(Index done) const {
    return heed_.size() > 1 ? done % 8 != 0 : done >= kFabrikPatience && done % 2 == 1;
  }

  // Where every joint should go: effectors to their targets, a joint above to the centroid, by weight, of where its
  // children and its own target want it.
  void backward(const IkSystem& system) {
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

  void forward(IkSystem& system) {
    if (system.limited()) hang(system);
    for (int n = 0; n < system.nodeCount(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      const IkSystem::Node& node = system.nodes[i];
      if (node.slides) {
        const Quat parent = system.parentRotation(n);
        const Vec3 gap = goals_[i] - (system.parentPosition(n) + parent * system.offsets[i]);
        system.offsets[i] += parent.conjugate() * Vec3(node.freedom * gap);
        system.limitNode(n);
      }
      place(system, n);
      if (node.freedom > 0) turn(system, n);
    }
  }

  // Where each effector hangs in the frames of the joints above it. That holds until a joint below such a frame turns,
  // which forward() does later.
  void hang(const IkSystem& system) {
    for (int n = 0; n < system.nodeCount(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      std::size_t slot = hangBegin_[i];
      for (const int below : system.effectorsBelow(n)) {
        const int effector = system.effectors[static_cast<std::size_t>(below)].node;
        const Vec3 way = system.positions[static_cast<std::size_t>(effector)] - system.positions[i];
        hangs_[slot++] = system.globals[i].conjugate() * way;
      }
    }
  }

  static void place(IkSystem& system, int node) {
    const auto n = static_cast<std::size_t>(node);
    const Quat parent = system.parentRotation(node);
    system.globals[n] = parent * system.locals[n];
    system.positions[n] = system.parentPosition(node) + parent * system.offsets[n];
  }

  void turn(IkSystem& system, int node) const {
    const auto n = static_cast<std::size_t>(node);
    const IkSystem::Node& info = system.nodes[n];
    const Quat parent = system.parentRotation(node);
    Quat wanted = system.globals[n];
    if (servesEffectors_ && info.childCount > 0) {
      wanted = turnForEffectors(system, node) * wanted;
    } else {
      wanted = wantedTurn(system, node) * wanted;
      if (info.limit && info.childCount == 1) wanted = twistAlong(system, node, wanted) * wanted;
    }
    const Quat local = (parent.conjugate() * wanted).normalized();
    system.locals[n] = info.freedom < 1 ? system.locals[n].slerp(info.freedom, local) : local;
    system.limitNode(node);
    system.globals[n] = parent * system.locals[n];
  }

  // The turn that points the node's bones to their goals, and the node itself to its orientation.
  Quat wantedTurn(const IkSystem& system, int node) const {
    const auto n = static_cast<std::size_t>(node);
    const IkSystem::Node& info = system.nodes[n];
    if (info.onlyChild >= 0 && !hasOrientation(system, node)) {
      const auto child = static_cast<std::size_t>(info.onlyChild);
      const Vec3 bone = system.globals[n] * system.offsets[child];
      const Vec3 way = goals_[child] - system.positions[n];
      if (!(bone.squaredNorm() > 0 && way.squaredNorm() > 0)) return Quat::Identity();
      return shortestRotation(bone, way);
    }
    Mat3 correlation = Mat3::Zero();
    for (int c = node + 1; c < system.nodeCount() && info.childCount > 0; ++c) {
      const auto child = static_cast<std::size_t>(c);
      if (system.nodes[child].parent != node) continue;
      const Vec3 bone = system.globals[n] * system.offsets[child];
      correlation += weights_[child] * (goals_[child] - system.positions[n]) * bone.transpose();
    }
    for (const int below : system.effectorsBelow(node)) {
      const IkSystem::Effector& effector = system.effectors[static_cast<std::size_t>(below)];
      if (effector.node != node || effector.angleScale == 0) continue;
      const double weight = effector.weight * effector.angleScale * effector.angleScale;
      correlation += weight * (effector.orientation * system.globals[n].conjugate()).toRotationMatrix();
    }
    return bestRotation(correlation);
  }

  static bool hasOrientation(const IkSystem& system, int node) {
    for (const int below : system.effectorsBelow(node)) {
      const IkSystem::Effector& effector = system.effectors[static_cast<std::size_t>(below)];
      if (effector.node == node && effector.angleScale > 0) return true;
    }
    return false;
  }

  // The turn about the node's bone that brings the effectors nearest to their targets, as they hang now. Without it a
  // hinge further down could not choose the plane in which it bends.
  Quat twistAlong(const IkSystem& system, int node, const Quat& global) const {
    const auto n = static_cast<std::size_t>(node);
    const Vec3& offset = system.offsets[static_cast<std::size_t>(system.nodes[n].onlyChild)];
    if (!(offset.squaredNorm() > 0)) return Quat::Identity();
    const Vec3 axis = (global * offset).normalized();
    return Quat(Eigen::AngleAxisd(bestAngle(effectorsAgainstTargets(system, node, global), axis), axis));
  }

  // The turn that brings the effectors nearest, as they hang now, about the axes that the node has: as CCD turns. Many
  // iterations go so where there are limits, since by the goals of joints alone, limbs that bend into their limits stay
  // there: 30 of 100 limited humanoids were solved.
  Quat turnForEffectors(const IkSystem& system, int node) const {
    const auto n = static_cast<std::size_t>(node);
    const JointLimit* limit = system.nodes[n].limit;
    const Quat& global = system.globals[n];
    const TurnAxes axes = limit ? turnAxes(*limit, system.locals[n]) : TurnAxes{};
    if (!limit || axes.count == 3) return bestRotation(effectorsAgainstTargets(system, node, global));
    Quat turned = global;
    for (int k = 0; k < axes.count; ++k) {
      const Vec3 axis = turned * axes.axes[static_cast<std::size_t>(k)];
      turned = Quat(Eigen::AngleAxisd(bestAngle(effectorsAgainstTargets(system, node, turned), axis), axis)) * turned;
    }
    return turned * global.conjugate();
  }

  // The correlation of where the effectors below hang, were the node turned so, and where they should.
  Mat3 effectorsAgainstTargets(const IkSystem& system, int node, const Quat& global) const {
    const auto n = static_cast<std::size_t>(node);
    Mat3 correlation = Mat3::Zero();
    std::size_t slot = hangBegin_[n];
    for (const int below : system.effectorsBelow(node)) {
      const IkSystem::Effector& effector = system.effectors[static_cast<std::size_t>(below)];
      const Vec3 hangs = global * hangs_[slot++];
      correlation +=
          heed_[static_cast<std::size_t>(below)] * (effector.target - system.positions[n]) * hangs.transpose();
    }
    return correlation;
  }

  std::vector<Vec3> goals_, sums_;
  std::vector<double> weights_;
  std::vector<std::size_t> hangBegin_;  // #nodes, into hangs_
  std::vector<Vec3> hangs_;             // for each node and each effector below it
  std::vector<double> heed_;            // #effectors
  Leap leap_;
  IkSystem::State best_;
  bool servesEffectors_ = false;  // in this iteration, rather than the joints' goals
};

}  // namespace

std::unique_ptr<IkIteration> makeFabrik(const IkSystem& system) {
  if (FabrikChain::fits(system)) return std::make_unique<FabrikChain>(system);
  return std::make_unique<FabrikTree>(system);
}

}  // namespace limber
