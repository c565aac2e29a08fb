// What moves in a session: motions that were opened, clips of the model, and the moment that is shown.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limber/character/matching/skeleton_map.h"
#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/mix/crossfade_motions.h"
#include "limber/session/command.h"
#include "limber/session/rigged_model.h"
#include "limber/skeleton/clip/clip_layer.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct SessionState;

// How a retargeted clip was made.
struct ClipSource {
  std::shared_ptr<const Motion> motion;
  std::size_t clip = 0;  // of the motion
  RetargetMotion command;
  SkeletonMap map;
  std::vector<ContactEdit> contactEdits = {};
  std::vector<FootSpans> feet = {};  // of the motion's skeleton, as the clip has them (ClipWithContacts)
};

// Of which clips a clip was joined, and while each of them plays in it.
struct ClipSequence {
  std::vector<std::string> clips;
  double seconds = 0;  // that they overlap
  std::vector<TimeSpan> spans;
};

// What a clip is made of. A clip that was made by hand is its keys; recorded motion is left as it is, and what is
// corrected in it is a layer on top, which stays when the motion below is retargeted anew.
struct ClipContent {
  std::shared_ptr<const Clip> clip;  // over the joints of the rig, as it is shown; its name is unique in the session
  std::optional<ClipSource> source;
  std::shared_ptr<const Clip> base = {};  // recorded, without the layer; null: made by hand
  ClipLayer layer = {};
  std::optional<ClipSequence> sequence = {};
};

// A clip as it was last edited, on the rig that it was edited on: other rigs start from it, so that going there and
// back again loses nothing.
struct AuthoredClip {
  ClipContent content;
  std::shared_ptr<const RiggedModel> rig;
};

// Copies share the clip, so that each undo step is one.
struct SessionClip : ClipContent {
  std::shared_ptr<const AuthoredClip> authored = {};  // null: on the rig that there is
};

struct Movement {
  std::vector<std::shared_ptr<const Motion>> motions;  // names unique
  std::vector<SessionClip> clips;
  std::optional<std::size_t> chosen;  // the clip that is shown
  double seconds = 0;                 // the moment of it
  Warnings warnings = {};             // what commands had to leave out

  // Null where none is chosen.
  const Clip* clip() const { return chosen ? clips[*chosen].clip.get() : nullptr; }
};

// A clip for each clip of the model's own. Those with more than kRecordedRate keys a second are recorded motion.
inline constexpr double kRecordedRate = 10;
Movement movementOf(const std::vector<std::shared_ptr<const Clip>>& own);

std::vector<std::shared_ptr<const Clip>> clipsOf(const Movement& movement);
// Without their layers.
std::vector<std::shared_ptr<const Clip>> basesOf(const Movement& movement);
// Puts a layer on the clip of that name, whose motion counts as recorded from then on. Throws Error kBadArgument where
// no clip has that name.
void putLayer(Movement& movement, const Skeleton& skeleton, const std::string& clip, ClipLayer layer);
// The clip below the layer becomes another one.
void setBase(SessionClip& entry, const Skeleton& skeleton, std::shared_ptr<const Clip> base);

// The pose of the chosen clip at its moment; joints and parts without a track are at rest.
Pose shownPose(const Movement& movement, const Skeleton& skeleton);

// Below, what cannot be done throws Error kBadArgument (a clip or motion that is not there, a name that is empty or
// taken, a key where there is none, nothing chosen) and changes nothing.

void addMotion(Movement& movement, Motion motion);
// The same source for other joints. `map`, if any, holds where all its joints are there still, else joints are matched
// anew; none where they do not match.
std::optional<ClipSource> sourceOn(ClipSource source, const std::string& map, const RiggedModel& rig);
// The clips for another rig of the same model: those of motions are retargeted anew where the motion fits the new
// joints, the keys of all others are transferred (transferClip), layers too. The chosen clip and the moment stay.
void moveToRig(Movement& movement, const std::shared_ptr<const RiggedModel>& from,
               const std::shared_ptr<const RiggedModel>& to, Progress& progress);
// An empty name chooses none. The moment goes back to 0.
void chooseClip(Movement& movement, const std::string& name);
void setTime(Movement& movement, double seconds);

// Makes the clip, or makes it anew below its layer where that clip of that motion is on the model already, and chooses
// it. Throws as matchSkeletons and skeletonMapFromJson do.
void apply(const RetargetMotion& command, Movement& movement, const RiggedModel& rig);
// Makes the chosen clip anew with what the user says of a foot. Throws where the clip is from no motion, or keeps no
// such foot.
void apply(const SetContact& command, Movement& movement, const RiggedModel& rig);
// Chooses what it makes. Of a sequence that is joined anew, clips that it had and that were removed since are left out
// (warning "removed-clips"). Warns and throws as joinMotions does.
void apply(const JoinClips& command, Movement& movement, const RiggedModel& rig);
// A clip without keys shows nothing yet: the pose stays.
void apply(const AddClip& command, SessionState& state);
void apply(const RemoveClip& command, Movement& movement, const RiggedModel& rig);
void apply(const RenameClip& command, SessionState& state);
void apply(const ChooseClip& command, SessionState& state);
void apply(const AddSampleMotion& command, SessionState& state);
// The motion, and where that is asked for its first clip on the model.
void addMotionTo(SessionState& state, Motion motion, bool retarget);

// Of the chosen clip. Keys of recorded motion are those of its layer; only where that has none at a moment, and no joint
// is named, are those of the motion itself moved or taken out.
void apply(const SetKey& command, SessionState& state);
void apply(const EditKeys& command, Movement& movement, const RiggedModel& rig);
void apply(const DeleteKeys& command, Movement& movement, const RiggedModel& rig);
void apply(const SetJointKey& command, Movement& movement, const RiggedModel& rig);
void apply(const SetInterpolation& command, Movement& movement, const RiggedModel& rig);
// Of keys of a clip made by hand.
void apply(const SetTangents& command, Movement& movement, const RiggedModel& rig);
// Throws as appliedPose does.
void apply(const PasteKeys& command, Movement& movement, const RiggedModel& rig);

// What can be edited: all keys of a clip made by hand, those of the layer of recorded motion.
std::vector<JointKeyTimes> editableKeys(const ClipContent& clip);

// Where the joints of the skeleton that the chosen clip comes from stand at that moment; empty where the clip comes
// from none.
std::vector<Vec3> sourceJoints(const Movement& movement);

}  // namespace limber
