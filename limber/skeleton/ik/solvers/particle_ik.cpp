#include "limber/skeleton/ik/solvers/particle_ik.h"

#include "limber/skeleton/ik/solvers/goal_iteration.h"

namespace limber {

namespace {

constexpr int kSpineSweeps = 4;  // of one iteration, over all bones
constexpr int kLimbSweeps = 8;
// Of a bone's error, what the particle ahead takes, the rest the one behind. With halves errors go to and fro: chains
// of 30 joints take 763 iterations to a millionth, so 12.
constexpr double kAhead = 0.8;

// Moves two particles along their line to the distance `length`; the first by `fraction` of the gap, the second by the
// rest.
void keepLength(Vec3& a, Vec3& b, double length, double fraction) {
  const Vec3 line = b - a;
  const double distance = line.norm();
  if (!(distance > 0)) return;  // the next sweep parts them
  const Vec3 gap = line * ((distance - length) / distance);
  a += fraction * gap;
  b -= (1 - fraction) * gap;
}

class ParticleIk : public GoalIteration {
 public:
  explicit ParticleIk(const IkSystem& system) : GoalIteration(system), pinned_(system.nodes.size(), 0) {
    for (const IkSystem::Effector& effector : system.effectors) pinned_[static_cast<std::size_t>(effector.node)] = 1;
  }

 private:
  void setGoals(const IkSystem& system) override {
    goals_ = system.positions;
    std::fill(weights_.begin(), weights_.end(), 0.0);
    for (std::size_t e = 0; e < heed_.size(); ++e) {
      for (const int n : system.effectors[e].path) weights_[static_cast<std::size_t>(n)] += heed_[e];
    }
    for (int sweep = 0; sweep < kSpineSweeps && heed_.size() > 1; ++sweep) {
      pullSpine(system);
      relax(system, true);
    }
    for (int sweep = 0; sweep < kLimbSweeps; ++sweep) {
      for (const IkSystem::Effector& effector : system.effectors) {
        goals_[static_cast<std::size_t>(effector.node)] = effector.target;
      }
      relax(system, false);
    }
  }

  bool isSpine(const IkSystem& system, int node) const { return system.effectorsBelow(node).size() > 1; }
  static bool isPinned(const IkSystem& system, int node) {
    const IkSystem::Node& info = system.nodes[static_cast<std::size_t>(node)];
    return info.parent < 0 && !info.slides;
  }

  // The last spine particle before each limb comes as near to the target as the limb is long.
  void pullSpine(const IkSystem& system) {
    for (std::size_t e = 0; e < heed_.size(); ++e) {
      const IkSystem::Effector& effector = system.effectors[e];
      double length = 0;
      for (std::size_t i = effector.path.size(); i-- > 0;) {
        const int node = effector.path[i];
        const auto n = static_cast<std::size_t>(node);
        if (!isSpine(system, node)) {
          length += system.offsets[n].norm();
          continue;
        }
        if (isPinned(system, node)) break;
        const Vec3 gap = effector.target - goals_[n];
        const double distance = gap.norm();
        if (distance > length) goals_[n] += heed_[e] / weights_[n] * (distance - length) / distance * gap;
        break;
      }
    }
  }

  // The bones of the spine, or those of the limbs, from the tips to the base and back. The base stays, and what a limb
  // hangs on does while the limb is relaxed.
  void relax(const IkSystem& system, bool spine) {
    const int count = system.nodeCount();
    for (int n = count; n-- > 0;) keepBone(system, n, spine, true);
    for (int n = 0; n < count; ++n) keepBone(system, n, spine, false);
  }

  void keepBone(const IkSystem& system, int node, bool spine, bool inwards) {
    const auto n = static_cast<std::size_t>(node);
    const int parent = system.nodes[n].parent;
    if (parent < 0 || isSpine(system, node) != spine) return;
    const auto p = static_cast<std::size_t>(parent);
    const bool parentStays = isPinned(system, parent) || (!spine && isSpine(system, parent));
    const bool nodeStays = inwards && !spine && pinned_[n] != 0;
    if (parentStays && nodeStays) return;
    keepLength(goals_[p], goals_[n], system.offsets[n].norm(),
               parentStays ? 0.0
               : nodeStays ? 1.0
               : inwards   ? kAhead
                           : 1 - kAhead);
  }

  std::vector<char> pinned_;  // #nodes, whether it is an effector's
};

}  // namespace

std::unique_ptr<IkIteration> makeParticleIk(const IkSystem& system) {
  return std::make_unique<ParticleIk>(system);
}

}  // namespace limber
