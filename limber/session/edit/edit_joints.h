// Joints of a rig added, deleted and hung elsewhere, and what a session keeps of the joints there were.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/session/rigged_model.h"
#include "limber/session/session.h"

namespace limber {

// A rig after such a change, and what its joints were before.
struct JointEdit {
  std::shared_ptr<const RiggedModel> rig;
  std::vector<std::optional<Index>> before;  // #J of `rig`; none for a joint that is new
};

// A joint without weights, a child of `parent`, at the world position `position` while the model is in `pose`. Throws
// Error kBadArgument where the name is empty or taken, or the position is not finite in the parent's frame.
JointEdit withJoint(const RiggedModel& model, const Pose& pose, Index parent, const Vec3& position,
                    const std::string& name);

// What it moved the joint above moves, and what hung on it hangs there and stays where it is. A root's weights go to
// the nearest joint. Throws Error kBadArgument for the last root.
JointEdit withoutJoint(const RiggedModel& model, Index joint);

// At the same position, with all its descendants. Throws Error kBadArgument for a joint at or below itself.
JointEdit withJointOn(const RiggedModel& model, Index joint, Index parent);

// Pose, clips, targets, limits and locks for the joints as they are now: joints that are still there stay where they
// were, in clips at every key.
void takeJointEdit(SessionState& state, const JointEdit& edit);

void apply(const AddJoint& c, SessionState& next);
void apply(const DeleteJoint& c, SessionState& next);
void apply(const ReparentJoint& c, SessionState& next);
void apply(const RenameJoint& c, SessionState& next);
void apply(const LockWeights& c, SessionState& next);

}  // namespace limber
