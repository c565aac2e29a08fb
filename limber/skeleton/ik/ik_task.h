// Tasks for a whole body: goals and constraints of its joints, several at once, the important ones first.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/ik/limits/limits.h"
#include "limber/skeleton/pose.h"

namespace limber {

// Points, directions and orientations are in the space of the skeleton's globals, lengths in metres, angles in radians.

struct PositionTask {  // the joint's origin is there
  Index joint = 0;
  Vec3 target = Vec3::Zero();
};
struct OrientationTask {  // the joint's global rotation is this
  Index joint = 0;
  Quat target = Quat::Identity();
};
struct LookAtTask {  // the joint's axis points there
  Index joint = 0;
  Vec3 target = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  // unit vector in the joint's own frame
};
struct DistanceTask {  // so far from another joint or a point
  Index joint = 0;
  std::variant<Index, Vec3> from = Vec3(Vec3::Zero());
  double distance = 0;  // 0 or more
};
struct PlaneTask {  // normal . position = offset, or at least that
  Index joint = 0;
  Vec3 normal = Vec3::UnitY();  // unit vector
  double offset = 0;
  bool above = true;  // inequality: false keeps the joint on the plane
};
struct BalanceTask {            // the centre of mass lies over the supports, seen along Y
  std::vector<Index> supports;  // 1 to kMostSupports
  bool centred = false;         // over their mean; false: anywhere over their convex hull
};
struct KeepOutTask {  // the joint stays out of a sphere, or of a capsule round the segment
  Index joint = 0;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // the same: a sphere
  double radius = 0;                            // above 0
};
struct CouplingTask {  // the joint's turn from its rest pose is `ratio` of the leader's, as world axes lie at rest
  Index joint = 0;
  Index leader = 0;
  double ratio = 1;
};

using IkTaskGoal = std::variant<PositionTask, OrientationTask, LookAtTask, DistanceTask, PlaneTask, BalanceTask,
                                KeepOutTask, CouplingTask>;

struct IkTask {
  IkTaskGoal goal;
  double weight = 1;  // above 0, against tasks of the same priority
  int priority = 0;   // 0 first; a later one gets what the earlier leave free
};

// For balance.
struct PointMass {
  Index joint = 0;
  Vec3 offset = Vec3::Zero();  // in the joint's own frame, metres
  double mass = 1;             // above 0, in any unit
};

struct IkTaskOptions {
  IkOptions ik;                   // tolerance: a fraction of the longest path from the root to a joint that takes part
  std::vector<PointMass> masses;  // none: each bone is a rod as heavy as it is long
};

// Why a task is not met, as far as it can be told.
enum class IkTaskObstacle {
  kNone,        // it is met
  kTooFar,      // the bones are too short
  kLimits,      // alone and without limits it could be met
  kOtherTasks,  // alone it could be met
  kUnknown,     // no pose was found, even alone
};

struct IkTaskReport {
  double residual = 0;   // left, metres or radians; 0 where an inequality holds
  bool isAngle = false;  // radians
  bool met = false;
  IkTaskObstacle obstacle = IkTaskObstacle::kNone;
};

struct IkTaskResult {
  std::vector<IkTaskReport> tasks;  // in the order asked for
  Index iterations = 0;

  bool met() const;
};

// Each unmet task is solved alone once or twice more, and the steps' systems grow with the rows.
inline constexpr std::size_t kMaxIkTasks = 200;  // two and more for each joint of a body with hands
inline constexpr std::size_t kMaxSupports = 100;

// Brings `pose`, the start, to one that serves the tasks: priority by priority, each within what leaves the earlier
// ones as well served as they were (to the tolerance), by the damped steps in null spaces of the whole-body solver;
// after iTaSC (De Schutter and others 2007) and Baerlocher, Boulic 2004. An inequality takes part where it is violated
// or a step would violate it (an active set). Limits (none: null) and the lengths of bones are kept. The same calls
// give the same bits. Where a task is not met, further attempts start from poses nearby (IkOptions::restarts), and
// solving that task alone shows what prevents it.
//
// Throws Error kBadArgument for more than kMaxIkTasks, and, with "task 2" as the location, for joints that are not
// there, numbers that are not finite, weights and radii that are not positive, axes and normals that are not unit
// vectors; otherwise as IkSystem. Joints that are at or above none of a task stay as they are; balance is every joint's
// task. On 60 joints 0.4 ms for a reach, a look and two feet, 3 ms with balance and three more; what cannot be met
// takes some ten times as long, by restarts.
IkTaskResult solveIkTasks(const Skeleton& skeleton, Pose& pose, std::span<const IkTask> tasks,
                          const JointLimits* limits = nullptr, const IkTaskOptions& options = {});

}  // namespace limber
