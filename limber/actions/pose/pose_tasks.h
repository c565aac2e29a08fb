// Tasks (limber/skeleton/ik/ik_task.h) in words, and what became of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/types.h"
#include "limber/skeleton/ik/ik_task.h"

namespace limber {

enum class TaskKind { kPosition, kOrientation, kLookAt, kDistance, kPlane, kBalance, kKeepOut, kCoupling };

// World space, metres. Which fields count depends on the kind.
struct TaskEdit {
  TaskKind kind = TaskKind::kPosition;
  std::string joint;                  // of all but balance
  std::string other;                  // coupling: the leader; distance: the other joint, none: `point`
  std::vector<std::string> supports;  // balance; none: the feet, as the anatomy has them
  Vec3 point = Vec3::Zero();          // target; one end of a capsule's segment, the middle of a sphere
  Vec3 end = Vec3::Zero();            // keep-out: the other end
  std::optional<Vec3> axis;           // plane: the normal; look-at: where it looks at rest, none: the body's front
  Quat turn = Quat::Identity();       // orientation: from the rest pose, about the world's axes
  double amount = 0;                  // distance, offset along the normal, radius, ratio
  bool exact = false;                 // plane: on it, not above; balance: centred, not anywhere within
  double weight = 1;
  int priority = 0;
  std::string where = {};  // as of JointTurn
};

// One of the forms below, with @weight=2,priority=1 behind it, either or both. Throws Error kBadArgument that quotes
// the text and says which form is accepted.
TaskEdit parseTask(std::string_view text);
// "position:JOINT=x,y,z" and so on, in the order of TaskKind.
struct TaskForm {
  std::string_view name, form, summary;
};
const std::vector<TaskForm>& taskForms();
// Of that name ("look-at"). Throws Error kBadArgument that lists them.
TaskKind findTaskKind(std::string_view name);

inline constexpr int kHighestPriority = 1000;  // of a task that is read

// As solveIkTasks, for joints by name (requireJoint). Throws Error kBadArgument, with the edit's `where`, for a joint
// or a number that cannot be, and for balance without supports on a body without feet.
std::vector<IkTask> resolveTasks(const Skeleton& skeleton, const std::vector<TaskEdit>& edits);
IkTaskResult applyTasks(const Skeleton& skeleton, Pose& pose, const std::vector<TaskEdit>& edits,
                        const JointLimits* limits = nullptr, const IkTaskOptions& options = {});

// "met", or "not met, 12.30 degrees left: the joints' limits are in the way".
std::string taskOutcome(const IkTaskReport& report);

}  // namespace limber
