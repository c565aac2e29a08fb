#include "limber/document/vrm/hang_bones.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/replace_clips.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/vrm/vrm_bones.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/clip/keys/movement_keys.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr double kBetweenKeys = 5e-6;  // of the skeleton's size, and radians: how far linear tracks may be off

struct Move {
  Index node = 0, parent = 0;  // nodes: what is moved, and where to
};

std::vector<Move> movesOf(const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  std::map<std::string_view, Index> jointOf;
  std::vector<Move> moves;
  for (const HumanoidJoint& bone : bones) {
    std::optional<std::string_view> above = humanoidParent(bone.bone);
    while (above && jointOf.count(*above) == 0) above = humanoidParent(*above);
    jointOf[bone.bone] = bone.joint;
    if (!above || isAncestorOrSelf(rig.skeleton, jointOf[*above], bone.joint)) continue;
    moves.push_back({rig.jointNode[bone.joint], rig.jointNode[jointOf[*above]]});
  }
  return moves;
}

std::optional<Index> jointOfNode(const AssetSkeleton& rig, Index node) {
  const auto found = std::find(rig.jointNode.begin(), rig.jointNode.end(), node);
  return found == rig.jointNode.end() ? std::nullopt : std::optional(static_cast<Index>(found - rig.jointNode.begin()));
}

std::optional<Index> parentNode(const AssetSkeleton& rig, Index joint) {
  const std::optional<Index> parent = rig.skeleton.joints[joint].parent;
  return parent ? std::optional(rig.jointNode[*parent]) : std::nullopt;
}

// The joint and all above it.
std::vector<Index> upward(const Skeleton& skeleton, Index joint) {
  std::vector<Index> joints;
  for (std::optional<Index> j = joint; j; j = skeleton.joints[*j].parent) joints.push_back(*j);
  return joints;
}

// The clips of a rig on the same joints under other parents.
class ClipMover {
 public:
  ClipMover(const AssetSkeleton& from, const AssetSkeleton& to) : from_(from), to_(to) {
    for (const Index node : from.jointNode) newJoint_.push_back(jointOfNode(to, node));
    for (Index j = 0; j < from.skeleton.jointCount(); ++j) {
      if (newJoint_[j] && parentNode(from, j) != parentNode(to, *newJoint_[j])) moved_.insert(j);
    }
  }

  Clip moved(const Clip& clip) const {
    Clip result;
    result.name = clip.name;
    copy(clip.translations, result.translations);
    copy(clip.rotations, result.rotations);
    copy(clip.scales, result.scales);
    for (const Index joint : moved_) addTracks(clip, joint, result);
    return result;
  }

 private:
  template <typename Value>
  void copy(const std::vector<Track<Value>>& tracks, std::vector<Track<Value>>& result) const {
    for (const Track<Value>& track : tracks) {
      if (moved_.count(track.joint) > 0 || !newJoint_[track.joint]) continue;
      result.push_back(track);
      result.back().joint = *newJoint_[track.joint];
    }
  }

  void addTracks(const Clip& clip, Index joint, Clip& result) const {
    const Index moved = *newJoint_[joint];
    std::optional<Index> parent;  // of the old skeleton
    if (const std::optional<Index> now = to_.skeleton.joints[moved].parent) {
      parent = jointOfNode(from_, to_.jointNode[*now]);
    }
    std::set<Index> deciding;
    for (const Index j : upward(from_.skeleton, joint)) deciding.insert(j);
    if (parent) {
      for (const Index j : upward(from_.skeleton, *parent)) deciding.insert(j);
    }
    std::vector<float> times = {0};
    forEachTrack(clip, [&](const auto& track) {
      if (deciding.count(track.joint) > 0) addKeyTimes(track, times);
    });
    Pose pose = restPose(from_.skeleton);
    Transform last = to_.skeleton.joints[moved].rest;
    const MovingTransform movement = [&](double seconds) {
      sampleClip(clip, seconds, pose);
      const std::vector<Affine> globals = poseGlobals(from_.skeleton, pose);
      const Affine local = parent ? globals[*parent].inverse(Eigen::Affine) * globals[joint] : globals[joint];
      if (local.matrix().allFinite()) last = decompose(local);  // below a scale of 0 nothing shows
      return last;
    };
    MovementKeys(movement, std::move(times), sizeSeenFrom(from_.skeleton, parent), kBetweenKeys)
        .writeTo(result, moved, true);
  }

  const AssetSkeleton& from_;
  const AssetSkeleton& to_;
  std::vector<std::optional<Index>> newJoint_;  // #J of `from`; none: it is no joint any more
  std::set<Index> moved_;                       // of `from`
};

void moveNodes(gltf::Document& document, std::span<const Move> moves) {
  for (const Move& move : moves) {
    for (gltf::Node& node : document.nodes) std::erase(node.children, move.node);
    for (gltf::Scene& scene : document.scenes) std::erase(scene.nodes, move.node);
    document.nodes[move.parent].children.push_back(move.node);
  }
}

}  // namespace

AssetSkeleton hangBones(Asset& asset, const AssetSkeleton& rig, std::span<HumanoidJoint> bones) {
  const std::vector<Move> moves = movesOf(rig, bones);
  if (moves.empty()) return rig;
  for (const Move& move : moves) {
    const Index joint = *jointOfNode(rig, move.node);
    if (!isAncestorOrSelf(rig.skeleton, joint, *jointOfNode(rig, move.parent))) continue;
    throw Error(ErrorCode::kUnsupported, "is above the bone that it should hang on",
                asset.name + ": " + rig.skeleton.joints[joint].name);
  }
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, rig, warnings);
  const std::vector<Affine> stand = poseGlobals(rig.skeleton, readNodePose(asset, rig));
  replaceClips(asset, rig, {});  // of joints that will be none any more, too
  moveNodes(asset.document, moves);
  AssetSkeleton hung = readSkeleton(asset);
  Pose pose = readNodePose(asset, hung);
  for (const Move& move : moves) {
    const Index joint = *jointOfNode(rig, move.node), parent = *jointOfNode(rig, move.parent);
    const Affine local = stand[parent].inverse(Eigen::Affine) * stand[joint];
    pose.locals[*jointOfNode(hung, move.node)] = decompose(local);
  }
  writeNodePose(asset, hung, pose);
  std::vector<Clip> movedClips;
  const ClipMover mover(rig, hung);
  for (const Clip& clip : clips) movedClips.push_back(mover.moved(clip));
  replaceClips(asset, hung, movedClips);
  for (HumanoidJoint& bone : bones) bone.joint = *jointOfNode(hung, rig.jointNode[bone.joint]);
  asset.warnings.add("vrm-moved-bones", "bones hang elsewhere than in the model: legs below hips, feet below legs", {},
                     moves.size());
  return hung;
}

}  // namespace limber
