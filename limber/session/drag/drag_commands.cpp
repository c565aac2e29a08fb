#include "limber/session/drag/drag_commands.h"

#include <algorithm>
#include <cmath>

#include "limber/session/drag/standing_feet.h"
#include "limber/session/edit/mirror_pose.h"
#include "limber/session/edit/pose_commands.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

std::vector<DragFollower> followersOf(const SessionState& now, Index joint, const std::vector<std::string>& with,
                                      bool mirrored) {
  std::vector<DragFollower> followers;
  const auto add = [&](Index follower, const Mat3& reflection, std::optional<Index> imageOf = std::nullopt) {
    const bool known = follower == joint || std::any_of(followers.begin(), followers.end(),
                                                        [&](const DragFollower& f) { return f.joint == follower; });
    if (!known) followers.push_back({follower, reflection, imageOf});
  };
  for (const std::string& name : with) add(requireJoint(now, name), Mat3::Identity());
  if (!mirrored) return followers;
  const auto [plane, images] = mirrorOfRig(*now.rig);
  const Mat3 reflection = Mat3::Identity() - 2 * plane.normal * plane.normal.transpose();
  const std::size_t onThisSide = followers.size();
  if (images[joint] != kNoIndex) add(images[joint], reflection, joint);
  for (std::size_t f = 0; f < onThisSide; ++f) {
    const Index original = followers[f].joint;
    if (images[original] != kNoIndex) add(images[original], reflection, original);
  }
  return followers;
}

// A drag without a pointer, from taking hold to letting go.
template <class Gesture, class Move>
void dragOnce(const Gesture& c, SessionState& next, DragMode mode, const Move& move) {
  const Index joint = requireJoint(next, c.joint);
  const Vec3 position = poseGlobals(next.rig->skeleton(), next.pose)[joint].translation();
  Drag drag(dragSceneOf(next, joint, c.with, c.mirrored), joint, mode, {position + Vec3::UnitZ(), -Vec3::UnitZ()},
            -Vec3::UnitZ());
  next.pose = move(drag, position);
  letGo(next, drag);
}

}  // namespace

DragScene dragSceneOf(const SessionState& now, Index joint, const std::vector<std::string>& with, bool mirrored) {
  DragScene scene;
  scene.skeleton = &now.rig->skeleton();
  scene.limits = now.limits.get();
  scene.start = now.pose;
  scene.ik = now.ik;
  scene.pinned = pinnedDuringDrag(*now.rig, now.pose, now.targets, joint);
  scene.rollRadius = std::max(2 * now.rig->radii[joint], longestSide(*now.rig) / 8);
  scene.solver = now.solver;
  scene.followers = followersOf(now, joint, with, mirrored);
  scene.snap = snapOf(*now.rig, joint);
  return scene;
}

void requireScalable(const SessionState& now) {
  if (now.movement.chosen && now.movement.clips[*now.movement.chosen].base) {
    refuse("keys over a recorded motion hold no scale", {}, "scale the joint where no clip is shown");
  }
}

void letGo(SessionState& next, const Drag& drag) {
  const Skeleton& skeleton = next.rig->skeleton();
  followPose(next, [&](const PinnedTarget& target) {
    if (drag.mode() == DragMode::kScale) return true;  // all that is below it has moved
    return std::any_of(drag.dragged().begin(), drag.dragged().end(), [&](const DragFollower& f) {
      return f.joint == target.joint || isInLimbAbove(skeleton, f.joint, target.joint);
    });
  });
  authored(next);
}

void apply(const PlaceJoint& c, SessionState& next) {
  if (!c.position.allFinite()) refuse("the position is no number");
  dragOnce(c, next, DragMode::kMove, [&](Drag& drag, const Vec3& position) {
    return drag.moved(c.relative ? c.position : Vec3(c.position - position));
  });
}

void apply(const SetTurn& c, SessionState& next) {
  if (!c.turn.allFinite()) refuse("the turn is no number");
  dragOnce(c, next, DragMode::kTurn, [&](Drag& drag, const Vec3&) {
    if (!c.relative) return drag.turnedTo(c.turn);
    const Vec3 axis = c.turn.isZero(0) ? Vec3(Vec3::UnitY()) : c.turn;  // no degrees: about any axis
    return drag.turned(axis, c.turn.norm());
  });
}

void apply(const SetScale& c, SessionState& next) {
  if (!std::isfinite(c.scale) || !(c.scale > 0)) refuse("the scale is not above 0");
  requireScalable(next);
  const Index joint = requireJoint(next, c.joint);
  std::vector<Index> scaled = {joint};
  for (const DragFollower& follower : followersOf(next, joint, c.with, c.mirrored)) scaled.push_back(follower.joint);
  const std::vector<Joint>& joints = next.rig->skeleton().joints;
  for (const Index j : scaled) {
    Vec3& local = next.pose.locals[j].scale;
    local = c.scale * (c.relative ? local : joints[j].rest.scale);
  }
  followPose(next, [](const PinnedTarget&) { return true; });
  authored(next);
}

}  // namespace limber
