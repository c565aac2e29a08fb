#include "limber/session/edit/movement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/rest_form.h"
#include "limber/motion/limbs/body/skin_tube.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/session/edit/apply_pose.h"
#include "limber/session/edit/clip_curves.h"
#include "limber/session/edit/pose_commands.h"
#include "limber/session/edit/pose_transfer.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_io.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

namespace {

std::optional<std::size_t> findClip(const Movement& movement, const std::string& name) {
  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    if (movement.clips[c].clip->name == name) return c;
  }
  return std::nullopt;
}

std::size_t requireClip(const Movement& movement, const std::string& name) {
  const std::optional<std::size_t> clip = findClip(movement, name);
  if (!clip) refuse(fmt::format("no clip is called '{}'", name));
  return *clip;
}

void requireFreeName(const Movement& movement, const std::string& name) {
  if (name.empty()) refuseNoName("clip");
  if (findClip(movement, name)) refuseNameTaken("clip", name);
}

// `taken` says whether something has the name.
template <class Taken>
std::string freeName(const std::string& wanted, const Taken& taken) {
  std::string name = wanted;
  for (int number = 2; taken(name); ++number) name = fmt::format("{} {}", wanted, number);
  return name;
}

SessionClip& requireChosen(Movement& movement) {
  if (!movement.chosen) refuse(ErrorKind::kNoClip, "no clip is chosen");
  return movement.clips[*movement.chosen];
}

// The clip from what it is made of. Without a layer it is the motion itself.
void applyLayerOf(ClipContent& content, const Skeleton& skeleton) {
  content.clip = content.layer.empty()
                     ? content.base
                     : std::make_shared<const Clip>(applyLayer(*content.base, content.layer, skeleton));
}

// Changes a copy of the chosen clip's own keys: those that were set by hand, or recorded.
template <class Edit>
void editOwnKeys(SessionClip& chosen, const Skeleton& skeleton, const Edit& edit) {
  auto clip = std::make_shared<Clip>(chosen.base ? *chosen.base : *chosen.clip);
  edit(*clip);
  chosen.authored.reset();
  if (chosen.base) {
    setBase(chosen, skeleton, std::move(clip));
  } else {
    chosen.clip = std::move(clip);
  }
}

template <class Edit>
void editLayer(SessionClip& chosen, const Skeleton& skeleton, const Edit& edit) {
  ClipLayer layer = chosen.layer;
  edit(layer);
  chosen.layer = std::move(layer);
  chosen.authored.reset();
  applyLayerOf(chosen, skeleton);
}

JointKey keyNamed(const Skeleton& skeleton, const KeyOfJoint& key) {
  const std::optional<Index> joint = skeleton.find(key.joint);
  if (!joint) refuse(fmt::format("no joint is called '{}'", key.joint));
  return {*joint, key.seconds};
}

// `timed` has the keys that a name without a joint means.
std::vector<JointKey> keysNamed(const Skeleton& skeleton, const std::vector<KeyOfJoint>& named,
                                const std::vector<JointKeyTimes>& timed) {
  if (named.empty()) refuse("no keys are given");
  std::vector<JointKey> keys;
  for (const KeyOfJoint& key : named) {
    if (!key.joint.empty()) {
      keys.push_back(keyNamed(skeleton, key));
      continue;
    }
    for (const auto& [joint, times] : timed) {
      const auto isThen = [&](double seconds) { return std::abs(seconds - key.seconds) < kKeySnap; };
      if (std::any_of(times.begin(), times.end(), isThen)) keys.push_back({joint, key.seconds});
    }
  }
  return keys;
}

// `edit` takes what has the keys, a layer or a clip, and the keys.
template <class Edit>
void editNamedKeys(SessionClip& chosen, const Skeleton& skeleton, const std::vector<KeyOfJoint>& named,
                   const Edit& edit) {
  if (chosen.base) {
    const std::vector<JointKey> keys = keysNamed(skeleton, named, keyTimesOfJoints(chosen.layer));
    if (!keys.empty()) return editLayer(chosen, skeleton, [&](ClipLayer& layer) { edit(layer, keys); });
  }
  const Clip& own = chosen.base ? *chosen.base : *chosen.clip;
  const std::vector<JointKey> keys = keysNamed(skeleton, named, keyTimesOfJoints(own));
  if (keys.empty()) refuse(fmt::format("there is no key at {} s", named.front().seconds));
  editOwnKeys(chosen, skeleton, [&](Clip& clip) { edit(clip, keys); });
}

double spanNear(const ClipLayer& layer, const JointKey& jointKey) {
  double span = 0, nearest = std::numeric_limits<double>::infinity();
  for (const LayerTrack& track : layer.tracks) {
    for (const LayerKey& key : track.keys) {
      const double away = std::abs(key.seconds - jointKey.seconds);
      if (track.joint != jointKey.joint || away >= nearest) continue;
      nearest = away;
      span = key.span;
    }
  }
  return span;
}

Pose clipPose(const Clip& clip, const Skeleton& skeleton, double seconds) {
  Pose pose = restPose(skeleton);
  sampleClip(clip, seconds, pose);
  return pose;
}

bool isRecorded(const Clip& clip) {
  constexpr std::size_t kFewKeys = 3;  // of a clip so short that they say nothing of a rate
  const std::size_t keys = keyTimes(clip).size();
  return keys > kFewKeys && static_cast<double>(keys) > kRecordedRate * clip.duration();
}

std::shared_ptr<const Motion> requireMotion(const Movement& movement, const std::string& name) {
  for (const std::shared_ptr<const Motion>& motion : movement.motions) {
    if (motion->name == name) return motion;
  }
  refuse(fmt::format("no motion is called '{}'", name));
}

std::size_t clipOfMotion(const Motion& motion, const std::string& name) {
  if (motion.clips.empty()) {
    refuse(ErrorKind::kNoMotion, fmt::format("the motion '{}' has no clip", motion.name), {{"name", motion.name}});
  }
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    if (name.empty() || motion.clips[c].name == name) return c;
  }
  refuse(fmt::format("the motion '{}' has no clip called '{}'", motion.name, name));
}

// Tells `source` which feet stand in it.
Clip retargeted(ClipSource& source, const RiggedModel& rig) {
  const Skeleton& skeleton = rig.skeleton();
  const Motion motion = asItRests(*source.motion, source.motion->skeleton);
  RetargetOptions options;
  options.reach = source.command.reach;
  options.contacts = source.command.contacts;
  options.contactEdits = source.contactEdits;
  options.characterOnGround = true;
  options.skin = makeBodySkin(skeleton, rig.geometry().positions, rig.weights);
  const RetargetMethod& method = findRetargetMethod(source.command.method);
  const Clip& moving = motion.clips[source.clip];
  const double rate = frameRateOf(motion, source.clip);
  ClipWithContacts made =
      retargetClipWithContacts(method, motion.skeleton, moving, skeleton, source.map, options, rate);
  source.feet = std::move(made.feet);
  return turnClip(std::move(made.clip), skeleton, turnToStand(rig.character.reading()));
}

// From its beginning, unless it is shown already.
void showOther(Movement& movement, std::size_t clip) {
  if (movement.chosen != clip) movement.seconds = 0;
  movement.chosen = clip;
}

// The motion below the layer.
void makeAnew(SessionClip& entry, const RiggedModel& rig, ClipSource source) {
  Clip made = retargeted(source, rig);
  made.name = entry.clip->name;
  setInterpolation(made, interpolationOf(*entry.base));
  entry.source = std::move(source);
  entry.authored.reset();
  setBase(entry, rig.skeleton(), std::make_shared<const Clip>(std::move(made)));
}

// What was said of a foot, but for what `change` says anew.
std::vector<ContactEdit> editsBeside(const SetContact& change, const std::vector<ContactEdit>& edits) {
  std::vector<ContactEdit> left;
  for (const ContactEdit& edit : edits) {
    if (edit.foot != change.foot || edit.to < change.from || edit.from > change.to) {
      left.push_back(edit);
      continue;
    }
    if (edit.from < change.from) left.push_back({edit.foot, edit.from, change.from, edit.planted});
    if (edit.to > change.to) left.push_back({edit.foot, change.to, edit.to, edit.planted});
  }
  return left;
}

bool onlyNamesDiffer(const Skeleton& one, const Skeleton& other) {
  return std::equal(
      one.joints.begin(), one.joints.end(), other.joints.begin(), other.joints.end(),
      [](const Joint& a, const Joint& b) { return a.parent == b.parent && sameTransform(a.rest, b.rest); });
}

}  // namespace

Movement movementOf(const std::vector<std::shared_ptr<const Clip>>& own) {
  Movement movement;
  for (const std::shared_ptr<const Clip>& clip : own) {
    movement.clips.push_back({{clip, {}, isRecorded(*clip) ? clip : nullptr}});
  }
  return movement;
}

std::vector<std::shared_ptr<const Clip>> clipsOf(const Movement& movement) {
  std::vector<std::shared_ptr<const Clip>> clips;
  for (const SessionClip& clip : movement.clips) clips.push_back(clip.clip);
  return clips;
}

std::vector<std::shared_ptr<const Clip>> basesOf(const Movement& movement) {
  std::vector<std::shared_ptr<const Clip>> clips;
  for (const SessionClip& clip : movement.clips) clips.push_back(clip.base ? clip.base : clip.clip);
  return clips;
}

void putLayer(Movement& movement, const Skeleton& skeleton, const std::string& clip, ClipLayer layer) {
  SessionClip& entry = movement.clips[requireClip(movement, clip)];
  entry.layer = std::move(layer);
  setBase(entry, skeleton, entry.base ? entry.base : entry.clip);
}

void setBase(SessionClip& entry, const Skeleton& skeleton, std::shared_ptr<const Clip> base) {
  entry.base = std::move(base);
  applyLayerOf(entry, skeleton);
}

Pose shownPose(const Movement& movement, const Skeleton& skeleton) {
  const Clip* clip = movement.clip();
  return clip ? clipPose(*clip, skeleton, movement.seconds) : restPose(skeleton);
}

void addMotion(Movement& movement, Motion motion) {
  motion.name = freeName(motion.name.empty() ? "motion" : motion.name, [&](const std::string& name) {
    return std::any_of(movement.motions.begin(), movement.motions.end(),
                       [&](const std::shared_ptr<const Motion>& known) { return known->name == name; });
  });
  movement.motions.push_back(std::make_shared<const Motion>(std::move(motion)));
}

void apply(const RetargetMotion& command, Movement& movement, const RiggedModel& rig) {
  ClipSource source{requireMotion(movement, command.motion), 0, command, {}};
  const Motion& motion = *source.motion;
  source.clip = clipOfMotion(motion, command.clip);
  if (!(command.reach >= 0 && command.reach <= 1)) refuse("the reach is not between 0 and 1");
  source.map = command.map.empty() ? matchMotion(motion, motion.skeleton, rig.character.reading())
                                   : skeletonMapFromJson(command.map, motion.skeleton, rig.skeleton());

  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    const std::optional<ClipSource>& known = movement.clips[c].source;
    if (!known || known->motion != source.motion || known->clip != source.clip) continue;
    source.contactEdits = known->contactEdits;
    makeAnew(movement.clips[c], rig, std::move(source));
    showOther(movement, c);
    return;
  }
  Clip made = retargeted(source, rig);
  const std::string& ofClip = motion.clips[source.clip].name;
  made.name = freeName(motion.clips.size() == 1 || ofClip.empty() ? motion.name : ofClip,
                       [&](const std::string& name) { return findClip(movement, name).has_value(); });
  auto clip = std::make_shared<const Clip>(std::move(made));
  movement.clips.push_back({{clip, std::move(source), clip}});
  showOther(movement, movement.clips.size() - 1);
}

void apply(const JoinClips& command, Movement& movement, const RiggedModel& rig) {
  std::optional<std::size_t> into;
  if (!command.into.empty()) into = requireClip(movement, command.into);
  if (into && !movement.clips[*into].sequence) refuse(fmt::format("the clip '{}' is no sequence", command.into));
  const std::vector<std::string> known = into ? movement.clips[*into].sequence->clips : std::vector<std::string>();
  const auto isRemoved = [&](const std::string& name) {
    return !findClip(movement, name) && std::find(known.begin(), known.end(), name) != known.end();
  };
  std::vector<std::string> names = command.clips;
  const std::size_t removed = std::erase_if(names, isRemoved);
  if (names.size() < 2) {
    refuse(
        fmt::format("a sequence takes two clips or more{}", removed > 0 ? ", and of its own some were removed" : ""));
  }
  const Skeleton& skeleton = rig.skeleton();
  const Quat toUpright = turnToStand(rig.character.reading());
  std::vector<ClipWithContacts> clips;
  for (const std::string& name : names) {
    if (name == command.into) refuse(fmt::format("the clip '{}' cannot be a part of itself", name));
    const Clip& clip = *movement.clips[requireClip(movement, name)].clip;
    clips.push_back({turnClip(clip, skeleton, toUpright.conjugate()), {}});
  }
  JoinedMotions joined = joinMotions(skeleton, clips, {command.seconds, std::nullopt}, &movement.warnings);
  Clip made = turnClip(std::move(joined.motion.clip), skeleton, toUpright);
  if (!into) {
    made.name = freeName(fmt::format("{}", fmt::join(names, "_")),
                         [&](const std::string& name) { return findClip(movement, name).has_value(); });
    movement.clips.emplace_back();
  } else {
    made.name = command.into;
    setInterpolation(made, interpolationOf(*movement.clips[*into].base));
  }
  const std::size_t at = into.value_or(movement.clips.size() - 1);
  SessionClip& entry = movement.clips[at];
  entry.sequence = {std::move(names), command.seconds, std::move(joined.spans)};
  entry.authored.reset();
  setBase(entry, skeleton, std::make_shared<const Clip>(std::move(made)));
  movement.warnings.add("removed-clips", "clips that a sequence was joined of were removed, and are left out of it",
                        command.into, removed);
  showOther(movement, at);
}

void apply(const SetContact& command, Movement& movement, const RiggedModel& rig) {
  SessionClip& chosen = requireChosen(movement);
  if (!chosen.source) refuse(fmt::format("the clip '{}' is from no motion", chosen.clip->name));
  if (!(command.from >= 0 && command.to >= command.from)) refuse("a contact ends before it begins");
  ClipSource source = *chosen.source;
  const std::vector<Joint>& joints = source.motion->skeleton.joints;
  const bool isKept = std::any_of(source.feet.begin(), source.feet.end(),
                                  [&](const FootSpans& feet) { return joints[feet.foot].name == command.foot; });
  if (!isKept) refuse(fmt::format("the clip keeps no foot that its motion calls '{}'", command.foot));
  source.contactEdits = editsBeside(command, source.contactEdits);
  if (command.contact != ContactChange::kFound) {
    source.contactEdits.push_back({command.foot, command.from, command.to, command.contact == ContactChange::kPlanted});
  }
  makeAnew(chosen, rig, std::move(source));
}

std::optional<ClipSource> sourceOn(ClipSource source, const std::string& map, const RiggedModel& rig) {
  try {
    if (!map.empty()) {
      source.map = skeletonMapFromJson(map, source.motion->skeleton, rig.skeleton());
      return source;
    }
  } catch (const Error&) {
    source.command.map.clear();
  }
  try {
    source.map = matchMotion(*source.motion, source.motion->skeleton, rig.character.reading());
    return source;
  } catch (const Error&) {
    return std::nullopt;
  }
}

namespace {

using Transfers = std::map<const RiggedModel*, PoseTransfer>;

void rename(ClipContent& content, const std::string& name) {
  const auto renamed = [&](const std::shared_ptr<const Clip>& clip) {
    if (clip->name == name) return clip;
    auto copy = std::make_shared<Clip>(*clip);
    copy->name = name;
    return std::shared_ptr<const Clip>(std::move(copy));
  };
  const bool same = content.clip == content.base;
  content.clip = renamed(content.clip);
  if (content.base) content.base = same ? content.clip : renamed(content.base);
}

// What a clip is on another rig than that which it was made on.
ClipContent contentOn(const AuthoredClip& authored, Transfers& transfers,
                      const std::shared_ptr<const RiggedModel>& to) {
  const Skeleton& skeleton = to->skeleton();
  ClipContent made = authored.content;
  if (made.source) made.source = sourceOn(*made.source, made.source->command.map, *to);
  if (onlyNamesDiffer(authored.rig->skeleton(), skeleton)) return made;
  const PoseTransfer& transfer = transfers.try_emplace(authored.rig.get(), *authored.rig, *to).first->second;
  const auto transferred = [&](const Clip& clip) {
    return std::make_shared<const Clip>(transferClip(transfer, *authored.rig, clip, *to));
  };
  if (!made.base) {
    made.clip = transferred(*authored.content.clip);
    made.source.reset();
    return made;
  }
  made.base =
      made.source ? std::make_shared<const Clip>(retargeted(*made.source, *to)) : transferred(*authored.content.base);
  made.layer = transferLayer(transfer, *authored.rig, *authored.content.base, authored.content.layer);
  applyLayerOf(made, skeleton);
  return made;
}

}  // namespace

void moveToRig(Movement& movement, const std::shared_ptr<const RiggedModel>& from,
               const std::shared_ptr<const RiggedModel>& to, Progress& progress) {
  Transfers transfers;
  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    progress.update(static_cast<double>(c) / static_cast<double>(movement.clips.size()));
    SessionClip& entry = movement.clips[c];
    if (!entry.authored) entry.authored = std::make_shared<const AuthoredClip>(AuthoredClip{entry, from});
    const AuthoredClip& authored = *entry.authored;
    const std::string name = entry.clip->name;
    static_cast<ClipContent&>(entry) = authored.rig == to ? authored.content : contentOn(authored, transfers, to);
    rename(entry, name);
    if (authored.rig == to) entry.authored.reset();
  }
}

void apply(const AddClip& command, SessionState& state) {
  Movement& movement = state.movement;
  requireFreeName(movement, command.clip);
  auto clip = std::make_shared<Clip>();
  clip->name = command.clip;
  movement.clips.push_back({{std::move(clip), {}}});
  showOther(movement, movement.clips.size() - 1);
}

void apply(const RemoveClip& command, Movement& movement, const RiggedModel&) {
  const std::size_t clip = requireClip(movement, command.clip);
  movement.clips.erase(movement.clips.begin() + static_cast<std::ptrdiff_t>(clip));
  if (movement.chosen == clip) {
    movement.chosen.reset();
    movement.seconds = 0;
  } else if (movement.chosen && *movement.chosen > clip) {
    --*movement.chosen;
  }
}

void apply(const RenameClip& command, SessionState& state) {
  Movement& movement = state.movement;
  const auto& [from, to] = command;
  const std::size_t at = requireClip(movement, from);
  if (from == to) return;
  requireFreeName(movement, to);
  rename(movement.clips[at], to);
  for (SessionClip& entry : movement.clips) {
    if (entry.sequence) std::replace(entry.sequence->clips.begin(), entry.sequence->clips.end(), from, to);
  }
}

void chooseClip(Movement& movement, const std::string& name) {
  movement.chosen = name.empty() ? std::nullopt : std::optional(requireClip(movement, name));
  movement.seconds = 0;
}

void setTime(Movement& movement, double seconds) {
  requireChosen(movement);
  if (!std::isfinite(seconds) || seconds < 0) refuse("a moment is not a positive number of seconds");
  movement.seconds = seconds;
}

void apply(const SetKey& command, SessionState& state) {
  SessionClip& chosen = requireChosen(state.movement);
  const Skeleton& skeleton = state.rig->skeleton();
  const Pose& pose = state.pose;
  const double seconds = state.movement.seconds;
  if (!chosen.base) return editOwnKeys(chosen, skeleton, [&](Clip& clip) { setKey(clip, skeleton, pose, seconds); });
  const Pose base = clipPose(*chosen.base, skeleton, seconds), shown = clipPose(*chosen.clip, skeleton, seconds);
  editLayer(chosen, skeleton, [&](ClipLayer& layer) { setKey(layer, base, shown, pose, seconds, command.span); });
}

void apply(const EditKeys& command, Movement& movement, const RiggedModel& rig) {
  const KeyRetiming retiming{command.shift, command.scale, command.pivot, command.copy};
  editNamedKeys(requireChosen(movement), rig.skeleton(), command.keys,
                [&](auto& keyed, const std::vector<JointKey>& keys) { retimeKeys(keyed, keys, retiming); });
}

void apply(const DeleteKeys& command, Movement& movement, const RiggedModel& rig) {
  editNamedKeys(requireChosen(movement), rig.skeleton(), command.keys,
                [](auto& keyed, const std::vector<JointKey>& keys) { deleteKeys(keyed, keys); });
}

// Where the layer has no key at that moment, the new one comes and goes as the joint's nearest does.
void apply(const SetJointKey& command, Movement& movement, const RiggedModel& rig) {
  const Skeleton& skeleton = rig.skeleton();
  SessionClip& chosen = requireChosen(movement);
  const JointKey key = keyNamed(skeleton, {command.joint, command.seconds});
  if (!command.turn.allFinite() || !command.offset.allFinite()) refuse("a key's value is no number");
  const Pose shown = clipPose(*chosen.clip, skeleton, key.seconds);
  Pose pose = shown;
  setFromRest(pose.locals[key.joint], skeleton.joints[key.joint].rest, {command.turn, command.offset});
  if (!chosen.base) {
    return editOwnKeys(chosen, skeleton, [&](Clip& clip) {
      setJointKey(clip, skeleton, key.joint, pose.locals[key.joint], key.seconds);
    });
  }
  const Pose base = clipPose(*chosen.base, skeleton, key.seconds);
  const double span = spanNear(chosen.layer, key);
  editLayer(chosen, skeleton, [&](ClipLayer& layer) { setKey(layer, base, shown, pose, key.seconds, span); });
}

namespace {

// The joint's local transform at a key, and what it changes by in a second, for what its curves change by.
KeySlope slopeOf(const Transform& local, const Transform& rest, const SetTangents& command) {
  constexpr double kStep = 1e-3;  // seconds
  const CurvePoint at = pointFromRest(local, rest);
  const auto turnedAfter = [&](double seconds) {
    Transform after = local;
    setFromRest(after, rest, {at.turn + seconds * command.turn, at.offset});
    return Eigen::Vector4d(after.rotation.coeffs() * (after.rotation.dot(local.rotation) < 0 ? -1 : 1));
  };
  return {command.tangents, command.offset, (turnedAfter(kStep) - turnedAfter(-kStep)) / (2 * kStep)};
}

}  // namespace

void apply(const SetTangents& command, Movement& movement, const RiggedModel& rig) {
  const Skeleton& skeleton = rig.skeleton();
  SessionClip& chosen = requireChosen(movement);
  if (chosen.base) refuse("corrections of recorded motion have no tangents", chosen.clip->name);
  if (!command.turn.allFinite() || !command.offset.allFinite()) refuse("a tangent is no number");
  const std::vector<JointKey> keys = keysNamed(skeleton, command.keys, keyTimesOfJoints(*chosen.clip));
  editOwnKeys(chosen, skeleton, [&](Clip& clip) {
    for (const JointKey& key : keys) {
      const Transform local = clipPose(clip, skeleton, key.seconds).locals[key.joint];
      setSlope(clip, key, slopeOf(local, skeleton.joints[key.joint].rest, command), local.rotation);
    }
  });
}

void apply(const PasteKeys& command, Movement& movement, const RiggedModel& rig) {
  SessionClip& chosen = requireChosen(movement);
  const Skeleton& skeleton = rig.skeleton();
  if (command.keys.empty()) refuse("no keys are given");
  for (const PoseKey& key : command.keys) {
    if (key.joints.empty()) refuse("no joints are given");
    std::vector<JointKey> keys;
    for (const std::string& joint : key.joints) keys.push_back(keyNamed(skeleton, {joint, key.seconds}));
    const Pose shown = clipPose(*chosen.clip, skeleton, key.seconds);
    const Pose pose = appliedPose(rig, shown, {key.pose, key.joints});
    if (!chosen.base) {
      editOwnKeys(chosen, skeleton, [&](Clip& clip) {
        for (const JointKey& jointKey : keys) {
          setJointKey(clip, skeleton, jointKey.joint, pose.locals[jointKey.joint], key.seconds);
        }
      });
      continue;
    }
    const Pose base = clipPose(*chosen.base, skeleton, key.seconds);
    const double span = spanNear(chosen.layer, keys.front());
    editLayer(chosen, skeleton, [&](ClipLayer& layer) { setKey(layer, base, shown, pose, key.seconds, span); });
  }
}

void apply(const SetInterpolation& command, Movement& movement, const RiggedModel& rig) {
  editOwnKeys(requireChosen(movement), rig.skeleton(),
              [&](Clip& clip) { setInterpolation(clip, command.interpolation); });
}

void addMotionTo(SessionState& state, Motion motion, bool retarget) {
  addMotion(state.movement, std::move(motion));
  if (!retarget) return;
  RetargetMotion command;
  command.motion = state.movement.motions.back()->name;
  apply(command, state.movement, *state.rig);
  show(state);
}

void apply(const AddSampleMotion& command, SessionState& state) {
  addMotionTo(state, makeSampleMotion(command.name), command.retarget);
}

void apply(const ChooseClip& command, SessionState& state) {
  chooseClip(state.movement, command.clip);
  if (state.movement.chosen) return show(state);
  state.pose = state.rig->home;
  holdStandingFeet(state);
  authored(state);
}

std::vector<JointKeyTimes> editableKeys(const ClipContent& clip) {
  return clip.base ? keyTimesOfJoints(clip.layer) : keyTimesOfJoints(*clip.clip);
}

std::vector<Vec3> sourceJoints(const Movement& movement) {
  if (!movement.chosen || !movement.clips[*movement.chosen].source) return {};
  const ClipSource& source = *movement.clips[*movement.chosen].source;
  Pose pose = restPose(source.motion->skeleton);
  sampleClip(source.motion->clips[source.clip], movement.seconds, pose);
  return posePositions(source.motion->skeleton, pose);
}

}  // namespace limber
