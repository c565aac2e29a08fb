#include "limber/rigging/transfer/limb_alignment.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/rotation.h"
#include "limber/core/rotation_fit.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr std::size_t kMinLandmarks = 3;
// Bones of people of one height differ less; what differs more was not meant to be the same bone.
constexpr double kMinStretch = 0.4, kMaxStretch = 2.5;
constexpr std::size_t kBlendGrain = 1024;

struct Similarity {
  double scale = 1;
  Quat turn = Quat::Identity();
  Affine map = Affine::Identity();
};

// Least squares (Umeyama 1991).
Similarity bodySimilarity(std::span<const Affine> globals, std::span<const JointLandmark> landmarks) {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  const double count = static_cast<double>(landmarks.size());
  for (const JointLandmark& landmark : landmarks) {
    from += globals[landmark.joint].translation() / count;
    to += landmark.position / count;
  }
  Mat3 correlation = Mat3::Zero();
  double size = 0;
  for (const JointLandmark& landmark : landmarks) {
    const Vec3 a = globals[landmark.joint].translation() - from, b = landmark.position - to;
    correlation += b * a.transpose();
    size += a.squaredNorm();
  }
  Similarity result;
  result.turn = bestRotation(correlation);
  const Mat3 turn = result.turn.toRotationMatrix();
  const double trace = turn.cwiseProduct(correlation).sum();
  if (size > 0 && trace > 0) result.scale = trace / size;
  result.map.linear() = result.scale * turn;
  result.map.translation() = to - result.map.linear() * from;
  return result;
}

class Alignment {
 public:
  Alignment(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const JointLandmark> landmarks)
      : skeleton_(skeleton), whole_(bodySimilarity(globals, landmarks)), target_(skeleton.jointCount()) {
    Box box;
    for (const Affine& global : globals) {
      rest_.push_back(global.translation());
      box.add(rest_.back());
    }
    minSquare_ = 1e-6 * box.size().squaredNorm() + 1e-300;
    children_ = childrenOf(skeleton);
    for (const JointLandmark& landmark : landmarks) target_[landmark.joint] = landmark.position;
  }

  LimbAlignment run() {
    placeBetween();
    LimbAlignment result;
    result.whole = whole_.map;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      const Affine& above = parent ? result.maps[*parent] : whole_.map;
      const Quat turnAbove = parent ? result.rotations[*parent] : whole_.turn;
      const Vec3 position = target_[j] ? *target_[j] : Vec3(above * rest_[j]);
      result.rotations.push_back(turnOf(j, position, turnAbove));
      result.maps.push_back(mapOf(j, position, result.rotations[j]));
      result.positions.push_back(position);
    }
    return result;
  }

 private:
  struct Below {
    Vec3 rest = Vec3::Zero(), position = Vec3::Zero();
    double weight = 0;
  };

  // The nearest joints with a landmark on each path down from `from`, which count by nearness: hips lie by the legs,
  // not between head and hands.
  void addBelow(Index from, Index joint, Below& below) const {
    for (const Index child : children_[joint]) {
      if (!target_[child]) {
        addBelow(from, child, below);
        continue;
      }
      const double weight = 1 / std::max((rest_[child] - rest_[from]).squaredNorm(), minSquare_);
      below.rest += weight * rest_[child];
      below.position += weight * *target_[child];
      below.weight += weight;
    }
  }

  void placeBetween() {
    std::vector<std::optional<Index>> placedAbove(rest_.size());
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const std::optional<Index> parent = skeleton_.joints[j].parent;
      const std::optional<Index> above = parent ? (target_[*parent] ? parent : placedAbove[*parent]) : std::nullopt;
      placedAbove[j] = above;
      if (target_[j]) continue;
      Below below;
      addBelow(j, j, below);
      if (below.weight == 0) continue;
      below.rest /= below.weight;
      below.position /= below.weight;
      const Vec3 fromBelow = below.position + whole_.map.linear() * (rest_[j] - below.rest);
      if (!above) {
        target_[j] = fromBelow;
        continue;
      }
      const Vec3 displacement = whole_.turn * (below.rest - rest_[*above]),
                 targetOffset = below.position - *target_[*above];
      const double length = displacement.norm();
      if (!(length > 0)) {
        target_[j] = fromBelow;
        continue;
      }
      const Quat turn = shortestRotation(displacement, targetOffset) * whole_.turn;
      target_[j] = *target_[*above] + targetOffset.norm() / length * (turn * (rest_[j] - rest_[*above]));
    }
  }

  Quat turnOf(Index joint, const Vec3& position, const Quat& above) const {
    Mat3 correlation = Mat3::Zero();
    for (const Index child : children_[joint]) {
      if (target_[child])
        correlation += (*target_[child] - position) * (above * (rest_[child] - rest_[joint])).transpose();
    }
    return (bestRotation(correlation) * above).normalized();
  }

  Affine mapOf(Index joint, const Vec3& position, const Quat& turn) const {
    Vec3 along = Vec3::Zero();
    double rest = 0, there = 0;
    for (const Index child : children_[joint]) {
      if (!target_[child]) continue;
      const Vec3 displacement = rest_[child] - rest_[joint];
      along += displacement;
      rest += displacement.norm();
      there += (*target_[child] - position).norm();
    }
    Mat3 stretch = Mat3::Identity();
    // Where the paths down part, as at hips, the sum of their directions is no direction to stretch along.
    if (rest > 0 && along.norm() > 0.9 * rest) {
      const double ratio = std::clamp(there / (rest * whole_.scale), kMinStretch, kMaxStretch);
      along.normalize();
      stretch += (ratio - 1) * along * along.transpose();
    }
    Affine map = Affine::Identity();
    map.linear() = whole_.scale * turn.toRotationMatrix() * stretch;
    map.translation() = position - map.linear() * rest_[joint];
    return map;
  }

  const Skeleton& skeleton_;
  Similarity whole_;
  std::vector<Vec3> rest_;
  double minSquare_ = 0;  // squared distance, so that a joint at the position of another counts finitely
  std::vector<std::vector<Index>> children_;
  std::vector<std::optional<Vec3>> target_;
};

void checkLandmarks(const Skeleton& skeleton, std::span<const JointLandmark> landmarks) {
  if (landmarks.size() < kMinLandmarks) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} landmarks, but a body is laid on another by {} or more",
                                                     landmarks.size(), kMinLandmarks));
  }
  std::vector<bool> seen(skeleton.jointCount(), false);
  for (const JointLandmark& landmark : landmarks) {
    if (landmark.joint >= skeleton.jointCount() || seen[landmark.joint] || !landmark.position.allFinite()) {
      throw Error(ErrorCode::kBadArgument, fmt::format("the landmark of joint {} fits no joint", landmark.joint));
    }
    seen[landmark.joint] = true;
  }
}

}  // namespace

LimbAlignment alignLimbs(const Skeleton& skeleton, std::span<const Affine> globals,
                         std::span<const JointLandmark> landmarks) {
  checkLandmarks(skeleton, landmarks);
  return Alignment(skeleton, globals, landmarks).run();
}

std::vector<Quat> turnsBetween(const Skeleton& skeleton, std::span<const Affine> globals,
                               std::span<const Vec3> positions, const Quat& whole) {
  std::vector<Mat3> correlations(skeleton.jointCount(), Mat3::Zero());
  std::vector<Quat> turns;
  // Directions below a joint, before the rotation of its parent is applied.
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (const std::optional<Index> parent = skeleton.joints[j].parent) {
      correlations[*parent] +=
          (positions[j] - positions[*parent]) * (globals[j].translation() - globals[*parent].translation()).transpose();
    }
  }
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const Quat above = parent ? turns[*parent] : whole;
    turns.push_back((bestRotation(correlations[j] * above.toRotationMatrix().transpose()) * above).normalized());
  }
  return turns;
}

Skeleton movedSkeleton(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const Vec3> positions,
                       std::span<const Quat> rotations) {
  Skeleton result = skeleton;
  std::vector<Affine> moved;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Affine wanted = Affine::Identity();
    wanted.linear() = rotations[j].toRotationMatrix() * globals[j].linear();
    wanted.translation() = positions[j];
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const Affine above = parent ? moved[*parent] : Affine::Identity();
    result.joints[j].rest = decompose(above.inverse(Eigen::Affine) * wanted);
    moved.push_back(above * result.joints[j].rest.toAffine());
  }
  return result;
}

std::vector<Vec3f> alignedSurface(std::span<const Vec3f> positions, const SkinWeights& weights,
                                  const LimbAlignment& alignment) {
  std::vector<Vec3f> result(positions.size());
  parallelFor(positions.size(), kBlendGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 position = positions[v].cast<double>();
      Vec3 sum = Vec3::Zero();
      double total = 0;
      for (Index slot = 0; slot < weights.slots; ++slot) {
        const double weight = weights.weightsOf(static_cast<Index>(v))[slot];
        if (!(weight > 0)) continue;
        sum += weight * (alignment.maps[weights.jointsOf(static_cast<Index>(v))[slot]] * position);
        total += weight;
      }
      result[v] = (total > 0 ? Vec3(sum / total) : Vec3(alignment.whole * position)).cast<float>();
    }
  });
  return result;
}

}  // namespace limber
