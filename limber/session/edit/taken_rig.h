// Rigs for the session's model that come from elsewhere than a rigger: from another model, or from its own animation.
#pragma once

#include <memory>

#include "limber/session/session.h"

namespace limber {

// The rig of another file's body on the session's model (transferOnto). `bytes` are a model that readAsset reads, or an
// .npz in SMPL's layout (smplBody) whose arrays are stored. Where the limbs of the model are tells its rig, if that
// came with the file or was corrected by hand, else its surface. Throws as these do; where() begins with a file's name.
std::shared_ptr<const RiggedModel> rigOfOther(const SessionState& state, ByteSpan bytes, const std::string& file,
                                              const Resolver& files, Progress& progress);

// The rig that makes the animation of `base` from bones, with its clips. Throws as readVertexAnimation and
// rigFromAnimation do.
std::shared_ptr<const RiggedModel> rigOfAnimation(const Asset& base, const RigFromAnimation& command,
                                                  Progress& progress);

// Adds the rig's own clips, replacing those of the same names; the first of them is chosen where none is.
void takeOwnClips(Movement& movement, const RiggedModel& rig);

}  // namespace limber
