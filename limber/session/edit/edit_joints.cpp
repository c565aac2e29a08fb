#include "limber/session/edit/edit_joints.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/document/clip/moving_parents.h"
#include "limber/document/rig/joint_edit.h"
#include "limber/document/scene/node_edit.h"
#include "limber/rigging/weights/weight_edit.h"
#include "limber/session/edit/pose_commands.h"
#include "limber/session/refuse.h"
#include "limber/session/scene/session_io.h"
#include "limber/skeleton/clip/keys/keyframes.h"
#include "limber/skeleton/ik/limits/limits_json.h"

namespace limber {

namespace {

constexpr double kSameScale = 1e-6;

// Its clips are the session's, which writes them when a file is made.
Asset documentToEdit(const RiggedModel& model) {
  Asset asset = documentOf(model);
  settleMovingParents(asset, model.binding());
  std::vector<bool> moves(asset.document.nodes.size(), false);
  for (const Index node : model.binding().jointNode) moves[node] = true;
  removeChannels(asset, [&](Index node, std::string_view path) { return moves[node] && path != "weights"; });
  return asset;
}

// The pose of the joints of `from`, for those of `to`: at the same world positions, new ones at rest.
Pose carriedPose(const Skeleton& from, const Pose& pose, const Skeleton& to,
                 const std::vector<std::optional<Index>>& before) {
  const std::vector<Affine> stood = poseGlobals(from, pose);
  std::vector<Affine> globals;
  Pose result = restPose(to);
  for (Index j = 0; j < to.jointCount(); ++j) {
    const std::optional<Index> parent = to.joints[j].parent;
    if (before[j]) {
      const std::optional<Index> hung = from.joints[*before[j]].parent;
      const bool same = parent ? before[*parent] == hung && hung : !hung;
      const Affine local =
          parent ? Affine(globals[*parent].inverse(Eigen::Affine) * stood[*before[j]]) : stood[*before[j]];
      result.locals[j] = same ? pose.locals[*before[j]] : decompose(local);
    }
    const Affine local = result.locals[j].toAffine();
    globals.push_back(parent ? Affine(globals[*parent] * local) : local);
  }
  return result;
}

JointEdit edited(const RiggedModel& model, Asset document) {
  JointEdit edit;
  const std::shared_ptr<RiggedModel> rig = readRiggedModel(std::move(document));
  for (const Joint& joint : rig->skeleton().joints) edit.before.push_back(model.skeleton().find(joint.name));
  rig->home = carriedPose(model.skeleton(), model.home, rig->skeleton(), edit.before);
  rig->report = model.report;
  rig->renamed = model.renamed;
  rig->edited = true;
  edit.rig = rig;
  return edit;
}

bool isAtOrBelow(const Skeleton& skeleton, Index joint, Index top) {
  std::optional<Index> at = joint;
  while (at && *at != top) at = skeleton.joints[*at].parent;
  return at.has_value();
}

Index nearestOther(const Skeleton& skeleton, Index joint) {
  const std::vector<Vec3> positions = restPositions(skeleton);
  std::optional<Index> nearest;
  const auto distance = [&](Index other) { return (positions[other] - positions[joint]).squaredNorm(); };
  for (Index other = 0; other < positions.size(); ++other) {
    if (other != joint && (!nearest || distance(other) < distance(*nearest))) nearest = other;
  }
  return *nearest;
}

void giveWeights(SkinWeights& weights, Index joint, Index heir, Index jointCount) {
  const std::vector<bool> unlocked(jointCount, false);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    WeightRow row(weights, v, unlocked);
    if (!(row.of(joint) > 0)) continue;
    std::vector<Influence> influences = {{heir, row.of(joint) + row.of(heir)}};
    for (Index k = 0; k < weights.slots; ++k) {
      const Index other = weights.jointsOf(v)[k];
      if (weights.weightsOf(v)[k] > 0 && other != joint && other != heir) influences.push_back({other, row.of(other)});
    }
    row.replace(std::move(influences));
  }
}

// The tracks of joints that hang as they did, under their new numbers.
template <typename Value>
std::vector<Track<Value>> keptTracks(const std::vector<Track<Value>>& tracks,
                                     const std::vector<std::optional<Index>>& after) {
  std::vector<Track<Value>> result;
  for (const Track<Value>& track : tracks) {
    if (!after[track.joint]) continue;
    result.push_back(track);
    result.back().joint = *after[track.joint];
  }
  return result;
}

// A joint that hangs elsewhere gets a key wherever the clip has one.
class ClipCarrier {
 public:
  ClipCarrier(const Skeleton& from, const Skeleton& to, const std::vector<std::optional<Index>>& before)
      : from_(from), to_(to), before_(before), kept_(from.jointCount()) {
    for (Index j = 0; j < before.size(); ++j) {
      if (!before[j]) continue;
      const std::optional<Index> parent = to.joints[j].parent, hung = from.joints[*before[j]].parent;
      const bool same = parent ? before[*parent] == hung && hung : !hung;
      if (same) {
        kept_[*before[j]] = j;
      } else {
        moved_.push_back(j);
      }
    }
  }

  // Tracks are those of `clip`; joints that hang elsewhere move as in `shown`.
  Clip carry(const Clip& clip, const Clip& shown) const {
    Clip result;
    result.name = clip.name;
    result.translations = keptTracks(clip.translations, kept_);
    result.rotations = keptTracks(clip.rotations, kept_);
    result.scales = keptTracks(clip.scales, kept_);
    if (!moved_.empty()) bake(shown, result);
    return result;
  }

  // What it says of joints that hang elsewhere is part of the clip below it from now on.
  ClipLayer carry(const ClipLayer& layer) const {
    ClipLayer result;
    for (const LayerTrack& track : layer.tracks) {
      if (kept_[track.joint]) result.tracks.push_back({*kept_[track.joint], track.keys});
    }
    std::sort(result.tracks.begin(), result.tracks.end(),
              [](const LayerTrack& a, const LayerTrack& b) { return a.joint < b.joint; });
    return result;
  }

 private:
  void bake(const Clip& clip, Clip& result) const {
    const std::vector<double> seconds = keyTimes(clip);
    if (seconds.empty()) return;
    const std::vector<float> times(seconds.begin(), seconds.end());
    std::vector<Pose> poses;
    for (const double moment : seconds) {
      Pose pose = restPose(from_);
      sampleClip(clip, moment, pose);
      poses.push_back(carriedPose(from_, pose, to_, before_));
    }
    for (const Index j : moved_) {
      Track<Vec3f> positions{j, Interpolation::kLinear, times, {}}, scales = positions;
      Track<Eigen::Quaternionf> turns{j, Interpolation::kLinear, times, {}};
      bool scaled = false;
      for (const Pose& pose : poses) {
        const Transform& local = pose.locals[j];
        positions.values.push_back(local.translation.cast<float>());
        turns.values.push_back(local.rotation.cast<float>().normalized());
        scales.values.push_back(local.scale.cast<float>());
        scaled = scaled || (local.scale - to_.joints[j].rest.scale).norm() > kSameScale;
      }
      result.translations.push_back(std::move(positions));
      result.rotations.push_back(std::move(turns));
      if (scaled) result.scales.push_back(std::move(scales));
    }
  }

  const Skeleton& from_;
  const Skeleton& to_;
  const std::vector<std::optional<Index>>& before_;
  std::vector<std::optional<Index>> kept_;  // #J of `from`: their numbers now
  std::vector<Index> moved_;                // of `to`, that hang elsewhere
};

// Limits are turned as the joints' parents are.
std::string carriedLimits(const JointLimits& limits, const Skeleton& from, const Skeleton& to,
                          const std::vector<std::optional<Index>>& before) {
  JointLimits result;
  for (Index j = 0; j < to.jointCount(); ++j) {
    JointLimit limit;
    if (before[j]) {
      limit = limits.joints[*before[j]];
      const Transform &was = from.joints[*before[j]].rest, &is = to.joints[j].rest;
      if (!sameTransform(was, is)) {
        limit.neutral = is.rotation * was.rotation.conjugate() * limit.neutral;
        limit.restTranslation = is.translation;
      }
    }
    result.joints.push_back(std::move(limit));
  }
  return limitsToJson(result, to);
}

}  // namespace

JointEdit withJoint(const RiggedModel& model, const Pose& pose, Index parent, const Vec3& position,
                    const std::string& name) {
  if (name.empty()) refuseNoName("joint");
  if (model.skeleton().find(name)) refuseNameTaken("joint", name);
  const Affine above = poseGlobals(model.skeleton(), pose)[parent];
  const Vec3 translation = above.inverse(Eigen::Affine) * position;
  if (!translation.allFinite()) refuse("a joint cannot be there", model.skeleton().joints[parent].name);
  Asset document = documentToEdit(model);
  addJoint(document, model.binding(), parent, translation, name);
  return edited(model, std::move(document));
}

JointEdit withoutJoint(const RiggedModel& model, Index joint) {
  const Skeleton& skeleton = model.skeleton();
  const auto isRoot = [](const Joint& other) { return !other.parent; };
  if (isRoot(skeleton.joints[joint]) && std::count_if(skeleton.joints.begin(), skeleton.joints.end(), isRoot) == 1) {
    const std::string& name = skeleton.joints[joint].name;
    refuse(ErrorKind::kOnlyRoot, "the root of the rig cannot be deleted", {{"joint", name}}, name);
  }
  const Index heir = skeleton.joints[joint].parent.value_or(nearestOther(skeleton, joint));
  auto given = std::make_shared<RiggedModel>(model);
  giveWeights(given->weights, joint, heir, skeleton.jointCount());
  given->painted = true;
  Asset document = documentToEdit(*given);
  const Geometry geometry = collectGeometry(document);
  const SkinWeights weights = readWeights(document, geometry, model.binding());
  removeJoint(document, geometry, model.binding(), weights, joint, heir);
  return edited(model, std::move(document));
}

JointEdit withJointOn(const RiggedModel& model, Index joint, Index parent) {
  const Skeleton& skeleton = model.skeleton();
  if (isAtOrBelow(skeleton, parent, joint)) {
    const std::string &above = skeleton.joints[joint].name, &below = skeleton.joints[parent].name;
    refuse(ErrorKind::kJointBelowItself, fmt::format("'{}' hangs on it", below), {{"joint", above}, {"parent", below}},
           above);
  }
  Asset document = documentToEdit(model);
  hangJoint(document, model.binding(), joint, parent);
  return edited(model, std::move(document));
}

void takeJointEdit(SessionState& state, const JointEdit& edit) {
  const Skeleton &from = state.rig->skeleton(), &to = edit.rig->skeleton();
  state.pose = carriedPose(from, state.pose, to, edit.before);
  const ClipCarrier carrier(from, to, edit.before);
  for (SessionClip& entry : state.movement.clips) {
    const std::shared_ptr<const Clip> shown = entry.clip;
    entry.clip = std::make_shared<const Clip>(carrier.carry(*shown, *shown));
    if (entry.base) entry.base = std::make_shared<const Clip>(carrier.carry(*entry.base, *shown));
    entry.layer = carrier.carry(entry.layer);
    if (!entry.source) continue;
    const std::string map = skeletonMapToJson(entry.source->map, entry.source->motion->skeleton, from);
    entry.source = sourceOn(*entry.source, map, *edit.rig);
  }
  std::vector<std::optional<Index>> after(from.jointCount());
  for (Index j = 0; j < edit.before.size(); ++j) {
    if (edit.before[j]) after[*edit.before[j]] = j;
  }
  std::erase_if(state.targets, [&](const PinnedTarget& target) { return !after[target.joint]; });
  for (PinnedTarget& target : state.targets) target.joint = *after[target.joint];
  std::erase_if(state.locked, [&](const std::string& name) { return !to.find(name); });
  const std::string limits = state.limits ? carriedLimits(*state.limits, from, to, edit.before) : std::string();
  state.rig = edit.rig;
  setLimits(state, limits);
  authored(state);
}

void apply(const AddJoint& c, SessionState& next) {
  const Skeleton& skeleton = next.rig->skeleton();
  std::string name = c.name;
  for (int number = 1; name.empty() || (c.name.empty() && skeleton.find(name)); ++number) {
    name = fmt::format("joint_{}", number);
  }
  takeJointEdit(next, withJoint(*next.rig, next.pose, requireJoint(next, c.parent), c.position, name));
}

void apply(const DeleteJoint& c, SessionState& next) {
  takeJointEdit(next, withoutJoint(*next.rig, requireJoint(next, c.joint)));
}

void apply(const ReparentJoint& c, SessionState& next) {
  takeJointEdit(next, withJointOn(*next.rig, requireJoint(next, c.joint), requireJoint(next, c.parent)));
}

void apply(const LockWeights& c, SessionState& next) {
  for (const Index joint : jointsOf(next, c.joint, c.with)) {
    const std::string& name = next.rig->skeleton().joints[joint].name;
    if (c.on) {
      next.locked.insert(name);
    } else {
      next.locked.erase(name);
    }
  }
}

// Limits speak of joints by name.
void apply(const RenameJoint& c, SessionState& next) {
  next.rig = renameJoint(*next.rig, requireJoint(next, c.joint), c.name);
  if (next.limits) next.limitsText = limitsToJson(*next.limits, next.rig->skeleton());
  if (next.locked.erase(c.joint) > 0) next.locked.insert(c.name);
  authored(next);
}

}  // namespace limber
