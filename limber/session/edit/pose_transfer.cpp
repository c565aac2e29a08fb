#include "limber/session/edit/pose_transfer.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation_fit.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

namespace {

constexpr double kMinWeight = 1e-9;
constexpr double kMinSpread = 1e-12;  // of the longest side squared: less is a point
constexpr double kRounding = 1e-5;    // of the longest side
constexpr double kAtRest = 1e-6;      // metres and radians: what differs less from the rest pose is no movement

Box boxOf(const std::vector<Vec3f>& positions) {
  Box box;
  for (const Vec3f& position : positions) box.add(position.cast<double>());
  return box;
}

bool sameVertices(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b, double tolerance) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Vec3f& p, const Vec3f& q) { return (p - q).norm() <= tolerance; });
}

template <class Visit>
void forEachWeight(const SkinWeights& weights, Index vertex, Visit&& visit) {
  for (Index k = 0; k < weights.slots; ++k) {
    const float weight = weights.weightsOf(vertex)[k];
    if (weight > 0) visit(weights.jointsOf(vertex)[k], double{weight});
  }
}

}  // namespace

PoseTransfer::PoseTransfer(const RiggedModel& from, const RiggedModel& to) : from_(from), to_(to) {
  const Box box = boxOf(from.geometry().positions);
  if (from.geometry().positions.empty()) return;
  if (!sameVertices(from.geometry().positions, to.geometry().positions, kRounding * box.longestSide())) return;
  middle_ = box.center();
  patches_.resize(to.skeleton().joints.size());
  gather();
  const double least = kMinSpread * box.longestSide() * box.longestSide();
  for (Patch& patch : patches_) {
    if (patch.weight < kMinWeight) continue;
    patch.mean /= patch.weight;
    patch.spread -= patch.weight * patch.mean.squaredNorm();
    if (patch.spread < least * patch.weight) patch.spread = 0;
  }
}

void PoseTransfer::gather() {
  const auto momentsOf = [](Patch& patch, Index joint) -> JointMoments& {
    for (JointMoments& jointMoments : patch.moments) {
      if (jointMoments.joint == joint) return jointMoments;
    }
    patch.moments.push_back({joint});
    return patch.moments.back();
  };
  for (Index v = 0; v < to_.weights.vertexCount(); ++v) {
    const Vec3 position = to_.geometry().positions[v].cast<double>() - middle_;
    const Mat3 square = position * position.transpose();
    forEachWeight(to_.weights, v, [&](Index joint, double ownWeight) {
      // Squared: a joint follows what it holds, not what it merely touches.
      const double own = ownWeight * ownWeight;
      Patch& patch = patches_[joint];
      patch.weight += own;
      patch.mean += own * position;
      patch.spread += own * position.squaredNorm();
      double totalWeight = 0;
      const auto add = [&](Index by, double weight) {
        JointMoments& jointMoments = momentsOf(patch, by);
        jointMoments.weight += own * weight;
        jointMoments.first += own * weight * position;
        jointMoments.second += own * weight * square;
        totalWeight += weight;
      };
      forEachWeight(from_.weights, v, add);
      if (totalWeight == 0) add(from_.skeleton().jointCount(), 1);
    });
  }
}

// With linear blending a vertex p comes to lie at the sum over the joints i of w_i (A_i p + t_i), so that sums over
// vertices of what they come to are sums over joints of A_i and t_i times what was gathered.
Pose PoseTransfer::apply(const Pose& pose) const {
  Pose result = to_.home;
  if (patches_.empty() || samePose(pose, from_.home)) return result;
  std::vector<Affine> skin(from_.inverseBind.size());
  skinTransforms(poseGlobals(from_.skeleton(), pose), from_.inverseBind, skin);
  skin.push_back(Affine::Identity());
  for (Affine& transform : skin) {
    transform.translation() += transform.linear() * middle_ - middle_;
  }

  const std::vector<Affine> rest = restGlobals(to_.skeleton());
  std::vector<Affine> motions(patches_.size()), globals(patches_.size());
  for (Index j = 0; j < patches_.size(); ++j) {
    const std::optional<Index> parent = to_.skeleton().joints[j].parent;
    const Patch& patch = patches_[j];
    if (patch.weight >= kMinWeight && patch.spread > 0) {
      Vec3 after = Vec3::Zero();
      Mat3 correlation = Mat3::Zero();
      for (const JointMoments& jointMoments : patch.moments) {
        const Affine& moved = skin[jointMoments.joint];
        after += moved.linear() * jointMoments.first + jointMoments.weight * moved.translation();
        correlation += moved.linear() * jointMoments.second + moved.translation() * jointMoments.first.transpose();
      }
      correlation -= after * patch.mean.transpose();
      const Quat rotation = bestRotation(correlation);
      motions[j] = Eigen::Translation3d(middle_ + after / patch.weight) * rotation *
                   Eigen::Translation3d(-(middle_ + patch.mean));
    } else {
      motions[j] = parent ? motions[*parent] : Affine::Identity();
    }
    globals[j] = motions[j] * rest[j];
    result.locals[j] = decompose(parent ? Affine(globals[*parent].inverse(Eigen::Affine) * globals[j]) : globals[j]);
  }
  return result;
}

Pose transferPose(const RiggedModel& from, const Pose& pose, const RiggedModel& to) {
  return PoseTransfer(from, to).apply(pose);
}

// Not key by key with setKey(): recorded motion has thousands.
Clip transferClip(const PoseTransfer& transfer, const RiggedModel& from, const Clip& clip, const RiggedModel& to) {
  const std::vector<double> seconds = keyTimes(clip);
  const std::vector<float> times(seconds.begin(), seconds.end());
  std::vector<Pose> poses;
  for (const double moment : seconds) {
    Pose pose = restPose(from.skeleton());
    sampleClip(clip, moment, pose);
    poses.push_back(transfer.apply(pose));
  }
  Clip result;
  result.name = clip.name;
  for (Index j = 0; j < to.skeleton().jointCount() && !poses.empty(); ++j) {
    const Joint& joint = to.skeleton().joints[j];
    Track<Vec3f> displacement{j, Interpolation::kLinear, times, {}};
    Track<Eigen::Quaternionf> turns{j, Interpolation::kLinear, times, {}};
    bool moves = false, rotates = !joint.parent;
    for (const Pose& pose : poses) {
      const Transform& local = pose.locals[j];
      moves |= (local.translation - joint.rest.translation).norm() > kAtRest;
      rotates |= local.rotation.angularDistance(joint.rest.rotation) > kAtRest;
      displacement.values.push_back(local.translation.cast<float>());
      turns.values.push_back(local.rotation.cast<float>().normalized());
    }
    if (moves) result.translations.push_back(std::move(displacement));
    if (rotates) result.rotations.push_back(std::move(turns));
  }
  if (!poses.empty()) setInterpolation(result, interpolationOf(clip));
  return result;
}

ClipLayer transferLayer(const PoseTransfer& transfer, const RiggedModel& from, const Clip& clip,
                        const ClipLayer& layer) {
  ClipLayer result;
  if (layer.empty()) return result;
  const Clip corrected = applyLayer(clip, layer, from.skeleton());
  for (const double seconds : keyTimes(layer)) {
    double span = 0;
    for (const LayerTrack& track : layer.tracks) {
      for (const LayerKey& key : track.keys) {
        if (std::abs(key.seconds - seconds) < kKeySnap) span = std::max(span, key.span);
      }
    }
    Pose below = restPose(from.skeleton()), above = below;
    sampleClip(clip, seconds, below);
    sampleClip(corrected, seconds, above);
    const Pose base = transfer.apply(below);
    setKey(result, base, base, transfer.apply(above), seconds, span);
  }
  return result;
}

}  // namespace limber
