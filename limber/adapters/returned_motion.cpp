#include "limber/adapters/returned_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/adapters/space_check.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kSameFrameTime = 0.01;  // of it: programs write as few as two digits
constexpr double kStill = 1e-5;          // of the skeleton's size: what a text with 6 digits rounds off
constexpr std::size_t kNamesListed = 8;
constexpr std::string_view kKeepSkeleton = "the program must keep the skeleton that it is given";

Motion readWhole(const ProgramOutput& output, const Adapter& adapter) {
  BvhOptions options;
  options.metresPerUnit = adapter.outputMetresPerUnit;
  options.up = options.restUp = adapter.outputUp == AdapterUp::kZ ? UpAxis::kZ : UpAxis::kY;
  Motion motion = readBvh(output.bytes, output.name, options);
  // What is repaired in a file of the user's is an error in one that was made a moment ago.
  constexpr std::array<std::string_view, 6> kDamage = {"bad-numbers", "cut-frame", "frame-count",
                                                       "frame-time",  "no-motion", "duplicate-names"};
  for (const Warning& warning : motion.warnings.items()) {
    if (std::find(kDamage.begin(), kDamage.end(), warning.kind) == kDamage.end()) continue;
    throw Error(ErrorCode::kBadData, warning.message, warning.where).within(output.name);
  }
  if (motion.clips.empty()) throw Error(ErrorCode::kBadData, "has no frame", output.name);
  return motion;
}

// As the writer and the reader of BVH call them.
constexpr std::string_view kEnd = "_end";

// A leaf of the character's that was handed over as an end site, without its name.
bool isHandedAsEndSite(const Skeleton& skeleton, const std::vector<std::vector<Index>>& children, Index j) {
  const std::string_view name = skeleton.joints[j].name;
  return skeleton.joints[j].parent && children[j].empty() && name.size() > kEnd.size() && name.ends_with(kEnd);
}

// An end site of the file's, or a joint that a program made of one.
bool isEndSite(const Skeleton& file, Index j) {
  const std::optional<Index> parent = file.joints[j].parent;
  return parent && file.joints[j].name == file.joints[*parent].name + std::string(kEnd);
}

std::string listed(const std::vector<std::string>& names) {
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kNamesListed));
  return fmt::format("{}{}", fmt::join(names.begin(), end, ", "), names.size() > kNamesListed ? ", ..." : "");
}

// The nearest joint above that the other skeleton has, too.
std::optional<Index> sharedAbove(const Skeleton& skeleton, const std::vector<std::optional<Index>>& other, Index j) {
  std::optional<Index> above = skeleton.joints[j].parent;
  while (above && !other[*above]) above = skeleton.joints[*above].parent;
  return above;
}

// Which joint of the one skeleton is which of the other; none for end sites.
struct SameJoints {
  std::vector<std::optional<Index>> inFile, ofCharacter;
  std::vector<std::string> missing, unknown;

  SameJoints(const Skeleton& character, const Skeleton& file)
      : inFile(character.joints.size()), ofCharacter(file.joints.size()) {
    const std::vector<std::vector<Index>> children = childrenOf(character);
    for (Index j = 0; j < character.jointCount(); ++j) {
      if (isHandedAsEndSite(character, children, j)) continue;
      inFile[j] = file.find(character.joints[j].name);
      if (inFile[j]) ofCharacter[*inFile[j]] = j;
      if (!inFile[j]) missing.push_back(character.joints[j].name);
    }
    for (Index j = 0; j < file.jointCount(); ++j) {
      if (!ofCharacter[j] && !isEndSite(file, j)) unknown.push_back(file.joints[j].name);
    }
  }
};

void checkTree(const Skeleton& character, const Skeleton& file, const SameJoints& same, const std::string& where) {
  const auto nameOf = [&](std::optional<Index> j) {
    return j ? fmt::format("'{}'", character.joints[*j].name) : std::string("nothing");
  };
  const auto isShared = [](const std::optional<Index>& joint) { return joint.has_value(); };
  if (std::none_of(same.inFile.begin(), same.inFile.end(), isShared)) {
    throw Error(ErrorCode::kBadData,
                fmt::format("none of its joints is one of the character's: {}", listed(same.unknown)), where,
                std::string(kKeepSkeleton));
  }
  for (Index j = 0; j < character.jointCount(); ++j) {
    if (!same.inFile[j]) continue;
    Index root = j;
    while (character.joints[root].parent) root = *character.joints[root].parent;
    if (!same.inFile[root]) {
      throw Error(ErrorCode::kBadData, fmt::format("lacks the character's root, '{}'", character.joints[root].name),
                  where, std::string(kKeepSkeleton));
    }
    const auto own = sharedAbove(character, same.inFile, j),
               filed = sharedAbove(file, same.ofCharacter, *same.inFile[j]);
    const std::optional<Index> other = filed ? same.ofCharacter[*filed] : std::nullopt;
    if (own == other) continue;
    throw Error(
        ErrorCode::kBadData,
        fmt::format("the joint '{}' hangs on {} in place of {}", character.joints[j].name, nameOf(other), nameOf(own)),
        where, std::string(kKeepSkeleton));
  }
}

// From the joint above that both have; a root's is no matter, since its positions say where it is.
void checkOffsets(const Skeleton& character, const Skeleton& file, const SameJoints& same, const std::string& where) {
  const std::vector<Vec3> ownAt = restPositions(character), filedAt = restPositions(file);
  std::vector<JointOffset> offsets;
  for (Index j = 0; j < character.jointCount(); ++j) {
    const auto above = same.inFile[j] ? sharedAbove(character, same.inFile, j) : std::nullopt;
    if (!above) continue;
    offsets.push_back(
        {character.joints[j].name, ownAt[j] - ownAt[*above], filedAt[*same.inFile[j]] - filedAt[*same.inFile[*above]]});
  }
  checkSameOffsets(offsets, where);
}

void checkFrames(const Motion& motion, Index count, const HandedFrames& handed, const std::string& where) {
  if (count == 1 && handed.count > 1) {
    if (handed.isStill) return;
    throw Error(ErrorCode::kBadData, "nothing moves in it, or it has a single frame", where);
  }
  const double given = 1 / handed.framesPerSecond, returned = 1 / motion.framesPerSecond;
  if (count > 1 && std::abs(returned - given) > kSameFrameTime * given) {
    throw Error(ErrorCode::kBadData, fmt::format("its frames last {:.6g} s each in place of {:.6g} s", returned, given),
                where, "the program must keep the frame time that it is given; --fps gives it another");
  }
  if (count != handed.count) {
    throw Error(ErrorCode::kBadData, fmt::format("has {} frames in place of {}", count, handed.count), where,
                "the program must give a frame for each that it is given");
  }
}

// Frames of the file's skeleton as frames of the character's.
class FrameTransfer {
 public:
  FrameTransfer(const Skeleton& character, const Skeleton& file, const SameJoints& same, const PoseSequence& frames)
      : character_(character), file_(file), same_(same), rest_(restPose(character)), moves_(character.joints.size()) {
    for (const Affine& global : restGlobals(character)) restTurns_.push_back(decompose(global).rotation);
    Box box;
    for (const Vec3& position : restPositions(character)) box.add(position);
    const double still = kStill * box.diagonal();
    for (Index j = 0; j < character.jointCount(); ++j) {
      if (!same.inFile[j] || !character.joints[j].parent || !isBelowItsParent(j)) continue;
      moves_[j] = std::any_of(frames.poses.begin(), frames.poses.end(),
                              [&](const Pose& pose) { return displacement(pose, j).norm() > still; });
    }
  }

  Pose frame(const Pose& filed) const {
    const std::vector<Affine> globals = poseGlobals(file_, filed);
    Pose pose = rest_;
    std::vector<Quat> turns(restTurns_.size());  // global, of the character
    for (Index j = 0; j < character_.jointCount(); ++j) {
      const std::optional<Index> parent = character_.joints[j].parent;
      Transform& local = pose.locals[j];
      const Quat above = parent ? turns[*parent] : Quat::Identity();
      if (!same_.inFile[j]) {
        turns[j] = above * local.rotation;
        continue;
      }
      const Affine& global = globals[*same_.inFile[j]];
      turns[j] = decompose(global).rotation * restTurns_[j];
      local.rotation = (above.conjugate() * turns[j]).normalized();
      if (!parent) local.translation = global.translation();
      if (moves_[j]) local.translation += inParent(displacement(filed, j), *parent);
    }
    return pose;
  }

 private:
  bool isBelowItsParent(Index j) const {
    const std::optional<Index> parent = file_.joints[*same_.inFile[j]].parent;
    return parent && same_.ofCharacter[*parent] == character_.joints[j].parent;
  }
  // By how much the file has it elsewhere than its offset, in its parent's frame there.
  Vec3 displacement(const Pose& filed, Index j) const {
    const Index joint = *same_.inFile[j];
    return filed.locals[joint].translation - file_.joints[joint].rest.translation;
  }
  Vec3 inParent(const Vec3& moved, Index parent) const {
    return (restTurns_[parent].conjugate() * moved).cwiseQuotient(restScale(parent));
  }
  // Of what hangs on it, even in all directions.
  Vec3 restScale(Index j) const {
    Vec3 scale = Vec3::Ones();
    for (std::optional<Index> at = j; at; at = character_.joints[*at].parent) {
      scale = scale.cwiseProduct(character_.joints[*at].rest.scale);
    }
    return scale;
  }

  const Skeleton &character_, &file_;
  const SameJoints& same_;
  Pose rest_;
  std::vector<Quat> restTurns_;  // #J, global
  std::vector<bool> moves_;      // #J, away from its offset
};

void warnOfNames(const std::vector<std::string>& names, std::string_view kind, std::string_view what,
                 const std::string& where, Warnings& warnings) {
  if (!names.empty()) warnings.add(kind, fmt::format("{}: {}", what, listed(names)), where, names.size());
}

}  // namespace

ReturnedMotion readReturnedMotion(const ProgramOutput& output, const Adapter& adapter, const Skeleton& skeleton,
                                  const HandedFrames& handed) {
  try {
    const Motion motion = readWhole(output, adapter);
    const SameJoints same(skeleton, motion.skeleton);
    checkTree(skeleton, motion.skeleton, same, output.name);
    checkOffsets(skeleton, motion.skeleton, same, output.name);
    const PoseSequence filed = sampleFrames(motion.skeleton, motion.clips.front(), motion.framesPerSecond);
    checkFrames(motion, static_cast<Index>(filed.poses.size()), handed, output.name);

    ReturnedMotion returned;
    returned.frames.frameSeconds = 1 / handed.framesPerSecond;
    const FrameTransfer transfer(skeleton, motion.skeleton, same, filed);
    for (const Pose& pose : filed.poses) returned.frames.poses.push_back(transfer.frame(pose));
    returned.frames.poses.resize(handed.count, returned.frames.poses.back());
    warnOfNames(same.missing, "missing-joints", "joints of the character that the program left out stay at rest",
                adapter.name, returned.warnings);
    warnOfNames(same.unknown, "unknown-joints", "joints that the character has not are passed over", adapter.name,
                returned.warnings);
    return returned;
  } catch (const Error& error) {
    throw error.within(adapter.name);
  }
}

}  // namespace limber
