#include "limber/session/edit/pose_commands.h"

#include <algorithm>
#include <utility>

#include "limber/actions/edit_text.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/rig/body_masses.h"
#include "limber/session/drag/standing_feet.h"
#include "limber/session/edit/apply_pose.h"
#include "limber/session/edit/mirror_pose.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

// Returns pinned joints to their targets.
void holdTargets(SessionState& state) {
  if (!state.ik || state.targets.empty()) return;
  LimbPull pull(state.rig->skeleton(), state.targets, state.limits.get(), state.solver);
  pull.solve(state.pose, state.targets);
}

}  // namespace

std::vector<Index> jointsOf(const SessionState& state, const std::string& joint, const std::vector<std::string>& with) {
  std::vector<Index> joints = {requireJoint(state, joint)};
  for (const std::string& name : with) joints.push_back(requireJoint(state, name));
  return joints;
}

void followPose(SessionState& state, const std::function<bool(const PinnedTarget&)>& which) {
  const std::vector<Affine> globals = poseGlobals(state.rig->skeleton(), state.pose);
  for (PinnedTarget& target : state.targets) {
    if (!which(target)) continue;
    target.position = globals[target.joint].translation();
    if (target.rotation) target.rotation = decompose(globals[target.joint]).rotation;
  }
}

void holdStandingFeet(SessionState& state) {
  if (state.limbsFollow && state.ik) state.targets = standingFeet(*state.rig, state.pose);
}

void show(SessionState& state) {
  state.pose = shownPose(state.movement, state.rig->skeleton());
  holdStandingFeet(state);
  authored(state);
}

void apply(const SetIk& c, SessionState& next) {
  findIkMethod(c.solver);
  next.ik = c.on;
  next.solver = c.solver;
  holdTargets(next);
  authored(next);
}

void apply(const SetTarget& c, SessionState& next) {
  setTarget(next.targets, {requireJoint(next, c.joint), c.position});
  const std::vector<Affine> globals = poseGlobals(next.rig->skeleton(), next.pose);
  for (const std::string& name : c.with) {
    const Index joint = requireJoint(next, name);
    setTarget(next.targets, {joint, globals[joint].translation()});
  }
  holdTargets(next);
  authored(next);
}

void apply(const ClearTarget& c, SessionState& next) {
  for (const Index joint : jointsOf(next, c.joint, c.with)) eraseTarget(next.targets, joint);
}

void apply(const SetLimits& c, SessionState& next) {
  setLimits(next, c.limits);
  holdTargets(next);
  authored(next);
}

void apply(const ResetJoint& c, SessionState& next) {
  const std::vector<PinnedTarget> feet =
      next.limbsFollow ? standingFeet(*next.rig, next.rig->home) : std::vector<PinnedTarget>();
  for (const Index joint : jointsOf(next, c.joint, c.with)) {
    next.pose.locals[joint] = next.rig->home.locals[joint];
    eraseTarget(next.targets, joint);
    for (const PinnedTarget& foot : feet) {
      if (foot.joint == joint) next.targets.push_back(foot);
    }
  }
  holdTargets(next);
  authored(next);
}

void apply(const ResetPose&, SessionState& next) {
  next.pose = next.rig->home;
  next.targets.clear();
  holdStandingFeet(next);
  authored(next);
}

void apply(const MirrorPose& c, SessionState& next) {
  const auto [plane, images] = mirrorOfRig(*next.rig);
  next.pose = mirrorPose(next.rig->skeleton(), next.pose, plane, images, c.from);
  followPose(next, [](const PinnedTarget&) { return true; });
  authored(next);
}

void apply(const ApplyPose& command, SessionState& state) {
  state.pose = appliedPose(*state.rig, state.pose, command);
  if (state.limbsFollow && state.ik) {
    std::erase_if(state.targets, [](const PinnedTarget& target) { return target.rotation.has_value(); });
  }
  followPose(state, [](const PinnedTarget&) { return true; });
  if (state.limbsFollow && state.ik) {
    for (const PinnedTarget& foot : standingFeet(*state.rig, state.pose)) setTarget(state.targets, foot);
  }
  authored(state);
}

void apply(const ApplyTasks& command, SessionState& state) {
  const Skeleton& skeleton = state.rig->skeleton();
  std::vector<TaskEdit> edits;
  for (const std::string& text : command.tasks) edits.push_back(parseTask(text));
  if (edits.empty()) refuse("there are no tasks");
  std::vector<IkTask> tasks = resolveTasks(skeleton, edits);
  const auto isAsked = [&](Index joint) {
    return std::any_of(edits.begin(), edits.end(), [&](const TaskEdit& edit) {
      return !edit.joint.empty() && requireJoint(skeleton, edit.joint, edit.where) == joint;
    });
  };
  for (const PinnedTarget& target : state.targets) {
    if (!state.ik || isAsked(target.joint)) continue;
    tasks.push_back({PositionTask{target.joint, target.position}, 1, -1});
    if (target.rotation) tasks.push_back({OrientationTask{target.joint, *target.rotation}, 1, -1});
  }
  IkTaskOptions options;
  options.ik.rootMotion = command.rootMoves ? RootMotion::kTranslate : RootMotion::kFixed;
  options.masses = bodyMasses(state.rig->geometry(), state.rig->weights, skeleton);
  const IkTaskResult result = solveIkTasks(skeleton, state.pose, tasks, state.limits.get(), options);
  followPose(state, [&](const PinnedTarget& target) { return isAsked(target.joint); });
  authored(state);
  for (std::size_t t = 0; t < edits.size(); ++t) {
    state.tasks.push_back({command.tasks[t], taskOutcome(result.tasks[t]), result.tasks[t].met});
  }
}

}  // namespace limber
