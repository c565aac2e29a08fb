// The joints that targets can move, packed for solvers: what every method works on.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/ik/ik_mirror.h"
#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/ik/limits/limits.h"

namespace limber {

class IkTaskRows;

// The joints on the paths from bases to effectors ("nodes", parents first), their state, and what the targets require.
// Memory is taken in the constructor only. Bones keep their length: a method changes `locals`, and `offsets` only of
// nodes that slide; forward() derives the rest.
class IkSystem {
 public:
  struct Node {
    int parent = -1;                    // a node; -1: a base, whose parent frame is given
    Index joint = 0;                    // in the skeleton
    const JointLimit* limit = nullptr;  // none: turns freely
    double freedom = 1;                 // 1 - stiffness; 0: does not move
    bool slides = false;                // its offset may change too
    int childCount = 0;                 // nodes whose parent this is
    int onlyChild = -1;                 // where there is exactly one
  };

  struct Effector {
    int node = 0;
    double reach = 0;       // sum of the bone lengths from base to effector
    double weight = 1;      // with the priority folded in: each later level counts a millionth
    int level = 0;          // 0 for the first priority there is, then 1, ...
    double angleScale = 0;  // metres that a radian counts as; 0 without orientation
    Vec3 target = Vec3::Zero();
    Quat orientation = Quat::Identity();
    std::optional<Vec3> pole;
    std::vector<int> path;  // nodes from the base to the effector
  };

  // Skeleton and limits (may be null) must outlive the system. Targets give joints, bases, priorities and whether they
  // have orientations. Throws Error kBadArgument where a target is not possible: joint or base not there, base not
  // above the joint, weight not positive, numbers not finite, limits not one for each joint.
  IkSystem(const Skeleton& skeleton, std::span<const IkTarget> targets, const JointLimits* limits,
           const IkOptions& options);
  // The same for tasks, which must outlive the system, instead of targets: for Jacobian methods only.
  IkSystem(const Skeleton& skeleton, IkTaskRows& tasks, const JointLimits* limits, const IkOptions& options);

  // Takes over a pose and where the targets are now, bends the pose into the limits and derives all state. Throws Error
  // kBadArgument where the targets differ from those of the constructor in more than position, orientation, weight and
  // pole, and kUnsupported where a joint above a moving one has a scale that is not uniform.
  void load(const Pose& pose, std::span<const IkTarget> targets);
  // Uses this pose instead of the reference in the options. Before load().
  void setReference(const Pose& reference);
  // Writes the nodes' rotations, and translations of those that slide, into `pose`.
  void store(Pose& pose) const;

  // Global rotations and positions of all nodes from their locals and offsets; the second, of those from `first` on.
  // Where the problem is symmetric, forward() makes the locals and offsets so first.
  void forward() {
    if (symmetric_) mirror_.impose(*this);
    forwardFrom(0);
  }
  void forwardFrom(int first);
  // The node's local rotation and offset into its limits. Does not touch globals.
  void limitNode(int node);
  bool limited() const { return limited_; }
  // Whether the effector's target has an orientation.
  bool oriented(std::size_t effector) const { return shape_[effector].orientation.has_value(); }

  Vec3 parentPosition(int node) const;
  Quat parentRotation(int node) const;

  double distance(std::size_t effector) const;
  double angle(std::size_t effector) const;
  bool reached(std::size_t effector) const;
  bool allReached() const;
  // Sum over effectors of weight * (distance^2 + (angleScale * angle)^2); with tasks, IkTaskRows::cost().
  double cost() const;
  // True where no pose of free joints can reach the target: lengths alone say so.
  bool outOfReach(std::size_t effector) const;

  // What a method may change, to keep and bring back.
  struct State {
    std::vector<Quat> locals;
    std::vector<Vec3> offsets;
  };
  State makeState() const { return {locals, offsets}; }
  void save(State& state) const;
  void restore(const State& state);  // derives globals and positions too

  int nodeCount() const { return static_cast<int>(nodes.size()); }
  const IkOptions& options() const { return options_; }
  // Whether start pose, targets, limits and references are the same left and right.
  bool symmetric() const { return symmetric_; }
  // Effectors at or below a node.
  std::span<const int> effectorsBelow(int node) const;
  // Null for a system that was made for targets.
  IkTaskRows* tasks() const { return tasks_; }
  // -1 for joints that are not nodes.
  int nodeOf(Index joint) const { return nodeOf_[joint]; }

  std::vector<Node> nodes;
  std::vector<Effector> effectors;
  std::vector<Quat> locals;      // #nodes, in the frame of the parent joint
  std::vector<Vec3> offsets;     // #nodes, from the parent joint, in its frame, in metres of the global space
  std::vector<Quat> globals;     // #nodes
  std::vector<Vec3> positions;   // #nodes
  std::vector<Quat> references;  // #nodes, local rotations to stay near (IkOptions::reference)
  std::vector<Vec3> referenceOffsets;

 private:
  void setUp(std::span<const IkTarget> moved, const JointLimits* limits);
  void addNodes(const Skeleton& skeleton, std::span<const IkTarget> targets);
  void addEffectors(std::span<const IkTarget> targets);
  void listEffectorsBelow();
  void setUpNode(const Skeleton& skeleton, const JointLimits* limits, Node& node);
  void checkTargets(std::span<const IkTarget> targets) const;
  void loadFrames(const Pose& pose);
  void updateReach();

  const Skeleton* skeleton_;
  IkTaskRows* tasks_ = nullptr;
  IkOptions options_;
  bool limited_ = false;
  bool symmetric_ = false;
  IkMirror mirror_;
  std::vector<IkTarget> shape_;          // the targets of the constructor
  std::vector<int> nodeOf_;              // #J, -1 for joints that are not nodes
  std::vector<Quat> baseRotations_;      // #nodes; of the parent frame, for bases
  std::vector<Vec3> basePositions_;      // #nodes
  std::vector<double> scales_;           // #nodes; uniform scale of the parent frame
  std::vector<int> belowBegin_, below_;  // effectors below node n: below_[belowBegin_[n] .. belowBegin_[n + 1])
};

}  // namespace limber
