#include "limber/session/movement.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/pipeline/stand_upright.h"
#include "limber/retarget/retarget_clip.h"
#include "limber/retarget/retarget_method.h"
#include "limber/session/pose_transfer.h"
#include "limber/skeleton/clip_edit.h"
#include "limber/skeleton/keyframes.h"

namespace limber {

namespace {

[[noreturn]] void refuseEdit(std::string message) {
  throw Error(ErrorCode::kBadArgument, std::move(message));
}

std::optional<std::size_t> findClip(const Movement& movement, const std::string& name) {
  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    if (movement.clips[c].clip->name == name) return c;
  }
  return std::nullopt;
}

std::size_t requireClip(const Movement& movement, const std::string& name) {
  const std::optional<std::size_t> clip = findClip(movement, name);
  if (!clip) refuseEdit(fmt::format("no clip is called '{}'", name));
  return *clip;
}

void requireFreeName(const Movement& movement, const std::string& name) {
  if (name.empty()) refuseEdit("a clip needs a name");
  if (findClip(movement, name)) refuseEdit(fmt::format("there is a clip called '{}' already", name));
}

// `taken` says whether something has the name.
template <class Taken>
std::string freeName(const std::string& wanted, const Taken& taken) {
  std::string name = wanted;
  for (int number = 2; taken(name); ++number) name = fmt::format("{} {}", wanted, number);
  return name;
}

SessionClip& requireChosen(Movement& movement) {
  if (!movement.chosen) refuseEdit("no clip is chosen");
  return movement.clips[*movement.chosen];
}

// Changes a copy of the chosen clip.
template <class Edit>
void editChosen(Movement& movement, const Edit& edit) {
  SessionClip& chosen = requireChosen(movement);
  auto clip = std::make_shared<Clip>(*chosen.clip);
  edit(*clip);
  chosen.clip = std::move(clip);
  chosen.authored.reset();
  chosen.edited = chosen.source.has_value();
}

std::shared_ptr<const Motion> requireMotion(const Movement& movement, const std::string& name) {
  for (const std::shared_ptr<const Motion>& motion : movement.motions) {
    if (motion->name == name) return motion;
  }
  refuseEdit(fmt::format("no motion is called '{}'", name));
}

std::size_t clipOfMotion(const Motion& motion, const std::string& name) {
  if (motion.clips.empty()) refuseEdit(fmt::format("the motion '{}' has no clip", motion.name));
  for (std::size_t c = 0; c < motion.clips.size(); ++c) {
    if (name.empty() || motion.clips[c].name == name) return c;
  }
  refuseEdit(fmt::format("the motion '{}' has no clip called '{}'", motion.name, name));
}

Clip retargeted(const ClipSource& source, const Skeleton& skeleton) {
  const Motion motion = asItRests(*source.motion);
  RetargetOptions options;
  options.reach = source.command.reach;
  options.contacts = source.command.contacts;
  options.characterStands = true;
  Clip clip = retargetClip(findRetargetMethod(source.command.method), motion.skeleton, motion.clips[source.clip],
                           skeleton, source.map, options, frameRateOf(motion, source.clip));
  return turnClip(std::move(clip), skeleton, turnToStand(skeleton));
}

bool onlyNamesDiffer(const Skeleton& one, const Skeleton& other) {
  return std::equal(
      one.joints.begin(), one.joints.end(), other.joints.begin(), other.joints.end(),
      [](const Joint& a, const Joint& b) { return a.parent == b.parent && sameTransform(a.rest, b.rest); });
}

// The same source for other joints. A map made by hand holds where all its joints are there still, else joints are
// matched anew; none where they do not match.
std::optional<ClipSource> sourceOn(const AuthoredClip& authored, const Skeleton& skeleton) {
  if (!authored.source) return std::nullopt;
  ClipSource source = *authored.source;
  const Skeleton& moving = source.motion->skeleton;
  try {
    if (!source.command.map.empty()) {
      source.map = skeletonMapFromJson(source.command.map, moving, skeleton);
      return source;
    }
  } catch (const Error&) {
    source.command.map.clear();
  }
  try {
    source.map = matchSkeletons(moving, skeleton);
    return source;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

Movement movementOf(const std::vector<std::shared_ptr<const Clip>>& own) {
  Movement movement;
  for (const std::shared_ptr<const Clip>& clip : own) movement.clips.push_back({clip, {}});
  return movement;
}

std::vector<std::shared_ptr<const Clip>> clipsOf(const Movement& movement) {
  std::vector<std::shared_ptr<const Clip>> clips;
  for (const SessionClip& clip : movement.clips) clips.push_back(clip.clip);
  return clips;
}

Pose shownPose(const Movement& movement, const Skeleton& skeleton) {
  Pose pose = restPose(skeleton);
  if (const Clip* clip = movement.clip()) sampleClip(*clip, movement.seconds, pose);
  return pose;
}

void addMotion(Movement& movement, Motion motion) {
  motion.name = freeName(motion.name.empty() ? "motion" : motion.name, [&](const std::string& name) {
    return std::any_of(movement.motions.begin(), movement.motions.end(),
                       [&](const std::shared_ptr<const Motion>& known) { return known->name == name; });
  });
  movement.motions.push_back(std::make_shared<const Motion>(std::move(motion)));
}

void retargetMotion(Movement& movement, const Skeleton& skeleton, const RetargetMotion& command) {
  ClipSource source{requireMotion(movement, command.motion), 0, command, {}};
  const Motion& motion = *source.motion;
  source.clip = clipOfMotion(motion, command.clip);
  if (!(command.reach >= 0 && command.reach <= 1)) refuseEdit("the reach is not between 0 and 1");
  source.map = command.map.empty() ? matchSkeletons(motion.skeleton, skeleton)
                                   : skeletonMapFromJson(command.map, motion.skeleton, skeleton);
  Clip made = retargeted(source, skeleton);

  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    const std::optional<ClipSource>& known = movement.clips[c].source;
    if (!known || known->motion != source.motion || known->clip != source.clip) continue;
    made.name = movement.clips[c].clip->name;
    movement.clips[c] = {std::make_shared<const Clip>(std::move(made)), std::move(source)};
    if (movement.chosen != c) movement.seconds = 0;
    movement.chosen = c;
    return;
  }
  const std::string& ofClip = motion.clips[source.clip].name;
  made.name = freeName(motion.clips.size() == 1 || ofClip.empty() ? motion.name : ofClip,
                       [&](const std::string& name) { return findClip(movement, name).has_value(); });
  movement.clips.push_back({std::make_shared<const Clip>(std::move(made)), std::move(source)});
  movement.chosen = movement.clips.size() - 1;
  movement.seconds = 0;
}

void moveToRig(Movement& movement, const std::shared_ptr<const RiggedModel>& from,
               const std::shared_ptr<const RiggedModel>& to, Progress& progress) {
  std::map<const RiggedModel*, PoseTransfer> transfers;
  for (std::size_t c = 0; c < movement.clips.size(); ++c) {
    progress.update(static_cast<double>(c) / static_cast<double>(movement.clips.size()));
    SessionClip& entry = movement.clips[c];
    if (!entry.authored) {
      entry.authored = std::make_shared<const AuthoredClip>(AuthoredClip{entry.clip, entry.source, from});
    }
    const AuthoredClip& authored = *entry.authored;
    const std::string name = entry.clip->name;
    Clip made;
    if (authored.rig == to) {
      made = *authored.clip;
      entry.source = authored.source;
    } else if (onlyNamesDiffer(authored.rig->skeleton(), to->skeleton())) {
      made = *authored.clip;
      entry.source = sourceOn(authored, to->skeleton());
    } else if (std::optional<ClipSource> source = entry.edited ? std::nullopt : sourceOn(authored, to->skeleton())) {
      made = retargeted(*source, to->skeleton());
      entry.source = std::move(source);
    } else {
      const auto transfer = transfers.try_emplace(authored.rig.get(), *authored.rig, *to).first;
      made = transferClip(transfer->second, *authored.rig, *authored.clip, *to);
      entry.source.reset();
    }
    made.name = name;
    entry.clip = std::make_shared<const Clip>(std::move(made));
    if (authored.rig == to) entry.authored.reset();
  }
}

void addClip(Movement& movement, const std::string& name) {
  requireFreeName(movement, name);
  auto clip = std::make_shared<Clip>();
  clip->name = name;
  movement.clips.push_back({std::move(clip), {}});
  movement.chosen = movement.clips.size() - 1;
  movement.seconds = 0;
}

void removeClip(Movement& movement, const std::string& name) {
  const std::size_t clip = requireClip(movement, name);
  movement.clips.erase(movement.clips.begin() + static_cast<std::ptrdiff_t>(clip));
  if (movement.chosen == clip) {
    movement.chosen.reset();
    movement.seconds = 0;
  } else if (movement.chosen && *movement.chosen > clip) {
    --*movement.chosen;
  }
}

void renameClip(Movement& movement, const std::string& from, const std::string& to) {
  const std::size_t at = requireClip(movement, from);
  if (from == to) return;
  requireFreeName(movement, to);
  auto clip = std::make_shared<Clip>(*movement.clips[at].clip);
  clip->name = to;
  movement.clips[at].clip = std::move(clip);
}

void chooseClip(Movement& movement, const std::string& name) {
  movement.chosen = name.empty() ? std::nullopt : std::optional(requireClip(movement, name));
  movement.seconds = 0;
}

void setTime(Movement& movement, double seconds) {
  requireChosen(movement);
  if (!std::isfinite(seconds) || seconds < 0) refuseEdit("a moment is not a positive number of seconds");
  movement.seconds = seconds;
}

void setKeyOf(Movement& movement, const Skeleton& skeleton, const Pose& pose, double span) {
  editChosen(movement, [&](Clip& clip) { blendKey(clip, skeleton, pose, movement.seconds, span); });
}

void moveKeyOf(Movement& movement, double from, double to) {
  editChosen(movement, [&](Clip& clip) { moveKey(clip, from, to); });
}

void deleteKeyOf(Movement& movement, double seconds) {
  editChosen(movement, [&](Clip& clip) { deleteKey(clip, seconds); });
}

void setInterpolationOf(Movement& movement, Interpolation interpolation) {
  editChosen(movement, [&](Clip& clip) { setInterpolation(clip, interpolation); });
}

std::vector<Vec3> sourceJoints(const Movement& movement) {
  if (!movement.chosen || !movement.clips[*movement.chosen].source) return {};
  const ClipSource& source = *movement.clips[*movement.chosen].source;
  Pose pose = restPose(source.motion->skeleton);
  sampleClip(source.motion->clips[source.clip], movement.seconds, pose);
  return posePositions(source.motion->skeleton, pose);
}

}  // namespace limber
