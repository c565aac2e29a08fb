// What moves in a session: motions that were opened, clips of the model, and the moment that is shown.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limber/matching/skeleton_map.h"
#include "limber/session/command.h"
#include "limber/session/rigged_model.h"
#include "limber/skeleton/motion.h"

namespace limber {

// How a retargeted clip was made.
struct ClipSource {
  std::shared_ptr<const Motion> motion;
  std::size_t clip = 0;  // of the motion
  RetargetMotion command;
  SkeletonMap map;
};

// A clip as it was last edited, on the rig that it was edited on: other rigs start from it, so that going there and
// back again loses nothing.
struct AuthoredClip {
  std::shared_ptr<const Clip> clip;
  std::optional<ClipSource> source;
  std::shared_ptr<const RiggedModel> rig;
};

// Copies share the clip, so that each undo step is one.
struct SessionClip {
  std::shared_ptr<const Clip> clip;  // over the joints of the rig; its name is unique in the session
  std::optional<ClipSource> source;
  std::shared_ptr<const AuthoredClip> authored = {};  // null: on the rig that there is
  bool edited = false;                                // by hand, since it was made from the source
};

struct Movement {
  std::vector<std::shared_ptr<const Motion>> motions;  // names unique
  std::vector<SessionClip> clips;
  std::optional<std::size_t> chosen;  // the clip that is shown
  double seconds = 0;                 // the moment of it

  // Null where none is chosen.
  const Clip* clip() const { return chosen ? clips[*chosen].clip.get() : nullptr; }
};

// A clip for each clip of the model's own.
Movement movementOf(const std::vector<std::shared_ptr<const Clip>>& own);

std::vector<std::shared_ptr<const Clip>> clipsOf(const Movement& movement);

// The pose of the chosen clip at its moment; joints and parts without a track are at rest.
Pose shownPose(const Movement& movement, const Skeleton& skeleton);

// Below, what cannot be done throws Error kBadArgument (a clip or motion that is not there, a name that is empty or
// taken, a key where there is none, nothing chosen) and changes nothing.

void addMotion(Movement& movement, Motion motion);
// The clips for another rig of the same model: those of motions are retargeted anew where the motion fits the new
// joints and nobody has edited them since, the keys of all others are transferred (transferClip). The chosen clip and
// the moment stay.
void moveToRig(Movement& movement, const std::shared_ptr<const RiggedModel>& from,
               const std::shared_ptr<const RiggedModel>& to, Progress& progress);
// Makes the clip, or makes it anew where that clip of that motion is on the model already, and chooses it. Throws as
// matchSkeletons and skeletonMapFromJson do.
void retargetMotion(Movement& movement, const Skeleton& skeleton, const RetargetMotion& command);
void addClip(Movement& movement, const std::string& name);
void removeClip(Movement& movement, const std::string& name);
void renameClip(Movement& movement, const std::string& from, const std::string& to);
// An empty name chooses none. The moment goes back to 0.
void chooseClip(Movement& movement, const std::string& name);
void setTime(Movement& movement, double seconds);

// Of the chosen clip.
void setKeyOf(Movement& movement, const Skeleton& skeleton, const Pose& pose, double span);
void moveKeyOf(Movement& movement, double from, double to);
void deleteKeyOf(Movement& movement, double seconds);
void setInterpolationOf(Movement& movement, Interpolation interpolation);

// Where the joints of the skeleton that the chosen clip comes from stand at that moment; empty where the clip comes
// from none.
std::vector<Vec3> sourceJoints(const Movement& movement);

}  // namespace limber
