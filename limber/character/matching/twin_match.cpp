#include "limber/character/matching/twin_match.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/SVD>

#include "limber/character/anatomy/half_body.h"
#include "limber/character/anatomy/names/joint_words.h"
#include "limber/core/rotation.h"

namespace limber {

namespace {

struct TwinTolerances {
  // Fraction of a bone, or of a hundredth of the skeleton for the shortest; 1e-3 to 0.05; between twins' bones; set by
  // hand.
  double sameLength = 0.02;
  // Mean distance of joints laid on each other, in mean distances from their middle; 0.1 to 0.5; of twins; set by hand.
  double maxDeviation = 0.35;
  // The same, and of a bone; 1e-5 to 1e-2; candidates that differ by less are told apart by names; set by hand.
  double alike = 1e-3;
  // Fraction of a limb's reach; 1e-6 to 1e-4 (1e-3 before); by which its joints may be off to have been turned as a
  // whole. A tenth of what the motion may be off in the end (0.1 mm of a person); positions in files, in float, are
  // exact to a hundredth of it.
  double rigid = 1e-5;
  // Second singular value over the first; 1e-10 to 1e-6; joints within 1e-4 of their length lie on one line; rounding
  // only.
  double onLine = 1e-8;
};
constexpr TwinTolerances kTwinTolerances;

// The rotation that brings `from` nearest to `to`, both about their origin (Kabsch 1976). What lies on one line does
// not tell how it is twisted about that: the shortest.
Quat rotationBetween(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) sum += to[i] * from[i].transpose();
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] <= kTwinTolerances.onLine * svd.singularValues()[0]) {
    return shortestRotation(svd.matrixV().col(0), svd.matrixU().col(0));
  }
  Mat3 sign = Mat3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return Quat(Mat3(svd.matrixU() * sign * svd.matrixV().transpose())).normalized();
}

class TwinMatcher {
 public:
  TwinMatcher(const Skeleton& source, const Skeleton& target)
      : source_(source),
        target_(target),
        sourceTree_(source),
        targetTree_(target),
        from_(restPositions(source)),
        to_(restPositions(target)) {}

  std::optional<Twins> match() {
    if (source_.jointCount() != target_.jointCount() || source_.jointCount() < 2) return std::nullopt;
    std::map<std::vector<Index>, Index> shapes;
    sourceShapes_ = shapesOf(sourceTree_, shapes);
    targetShapes_ = shapesOf(targetTree_, shapes);
    if (!sameRoots()) return std::nullopt;
    const double own = lengthOf(sourceTree_, from_), other = lengthOf(targetTree_, to_);
    if (!(own > 0) || !(other > 0)) return std::nullopt;
    scale_ = other / own;
    short_ = 0.01 * other / static_cast<double>(target_.jointCount());

    std::optional<Twins> best;
    double least = kTwinTolerances.maxDeviation, names = -1;
    std::size_t most = 0;  // bones that are alike to the bit, but for limbs that rest otherwise
    for (const Quat& turn : turns()) {
      Twins twins{std::vector<Index>(target_.jointCount(), 0), turn, scale_};
      if (!layOn(twins)) continue;
      if (distance(twins) > kTwinTolerances.alike) {
        const Quat near = turnOf(twins);
        if (bonesAlike(twins, near) > bonesAlike(twins, turn)) twins.turn = near;
        if (!layOn(twins)) continue;
      }
      const double off = distance(twins), common = namesInCommon(twins);
      const std::size_t alike = bonesAlike(twins, twins.turn);
      const bool better = alike > most || (alike == most && (off < least - kTwinTolerances.alike ||
                                                             (off < least + kTwinTolerances.alike && common > names)));
      if (!better || off > kTwinTolerances.maxDeviation) continue;
      most = alike;
      least = std::min(off, least);
      names = common;
      best = std::move(twins);
    }
    return best;
  }

 private:
  // Numbers of tree shapes: two joints have one number where what hangs on them is the same tree.
  static std::vector<Index> shapesOf(const JointTree& tree, std::map<std::vector<Index>, Index>& numbers) {
    std::vector<Index> shapes(tree.size());
    for (auto joint = tree.order().rbegin(); joint != tree.order().rend(); ++joint) {
      std::vector<Index> below;
      for (const Index child : tree.children(*joint)) below.push_back(shapes[child]);
      std::sort(below.begin(), below.end());
      shapes[*joint] = numbers.emplace(std::move(below), static_cast<Index>(numbers.size())).first->second;
    }
    return shapes;
  }

  bool sameRoots() const {
    std::vector<Index> one, other;
    for (const Index root : sourceTree_.roots()) one.push_back(sourceShapes_[root]);
    for (const Index root : targetTree_.roots()) other.push_back(targetShapes_[root]);
    std::sort(one.begin(), one.end());
    std::sort(other.begin(), other.end());
    return one == other;
  }

  static double lengthOf(const JointTree& tree, const std::vector<Vec3>& positions) {
    double length = 0;
    for (Index j = 0; j < tree.size(); ++j) {
      if (tree.parent(j)) length += (positions[j] - positions[*tree.parent(j)]).norm();
    }
    return length;
  }

  // All turns of a cube, and those that lay one plane of symmetry on the other.
  std::vector<Quat> turns() const {
    std::vector<Quat> all;
    for (const Quat& side :
         {Quat(Quat::Identity()), Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX())),
          Quat(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX())), Quat(Eigen::AngleAxisd(kPi, Vec3::UnitX())),
          Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ())), Quat(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()))}) {
      for (int quarter = 0; quarter < 4; ++quarter)
        all.push_back((side * Quat(Eigen::AngleAxisd(quarter * kPi / 2, Vec3::UnitY()))).normalized());
    }
    const Mat3 own = frameOf(sourceTree_, from_), other = frameOf(targetTree_, to_);
    if (own.isZero() || other.isZero()) return all;
    for (const Vec3& signs : {Vec3(1, 1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1), Vec3(-1, -1, 1)}) {
      all.push_back(Quat(Mat3(other * signs.asDiagonal() * own.transpose())).normalized());
    }
    return all;
  }

  // Across the plane of symmetry; in it, from the first root to the middle of all joints; square to both.
  static Mat3 frameOf(const JointTree& tree, const std::vector<Vec3>& positions) {
    const Vec3 lateral = foldBody(tree, positions).lateral;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& position : positions) middle += position / static_cast<double>(positions.size());
    Vec3 along = middle - positions[tree.roots().front()];
    along -= along.dot(lateral) * lateral;
    if (!(along.norm() > 1e-9)) return Mat3::Zero();
    along.normalize();
    Mat3 frame;
    frame << lateral, along, lateral.cross(along);
    return frame;
  }

  // Children to the nearest of equal trees and bones. Children of a bone that points elsewhere are turned along with
  // it: the fingers of an arm in another rest pose would else be swapped.
  bool layOn(Twins& twins) const {
    if (!pairUp(sourceTree_.roots(), targetTree_.roots(), std::nullopt, std::nullopt, twins.turn, twins)) return false;
    std::vector<Quat> turns(target_.jointCount(), twins.turn);
    for (const Index joint : targetTree_.order()) {
      const Index own = twins.sourceOf[joint];
      if (const std::optional<Index>& parent = targetTree_.parent(joint)) {
        const Vec3 bone = to_[joint] - to_[*parent],
                   other = turns[*parent] * (from_[own] - from_[twins.sourceOf[*parent]]);
        const bool points = std::min(bone.norm(), scale_ * other.norm()) > short_;
        turns[joint] = points ? (shortestRotation(other, bone) * turns[*parent]).normalized() : turns[*parent];
      }
      if (!pairUp(sourceTree_.children(own), targetTree_.children(joint), own, joint, turns[joint], twins))
        return false;
    }
    return true;
  }

  bool pairUp(std::span<const Index> sources, std::span<const Index> targets, std::optional<Index> sourceParent,
              std::optional<Index> targetParent, const Quat& turn, Twins& twins) const {
    if (sources.size() != targets.size()) return false;
    struct Pair {
      double off;
      Index source, target;
    };
    std::vector<Pair> pairs;
    for (const Index s : sources) {
      for (const Index t : targets) {
        if (sourceShapes_[s] != targetShapes_[t]) continue;
        Vec3 one = from_[s], other = to_[t];
        if (sourceParent) {
          one -= from_[*sourceParent];
          other -= to_[*targetParent];
          const double length = scale_ * one.norm();
          if (std::abs(length - other.norm()) > kTwinTolerances.sameLength * std::max(length, short_)) continue;
        }
        pairs.push_back({(scale_ * (turn * limbMiddle(sourceTree_, from_, s, sourceParent)) -
                          limbMiddle(targetTree_, to_, t, targetParent))
                             .norm(),
                         s, t});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.off < b.off; });
    std::size_t paired = 0;
    std::vector<Index> usedSources, usedTargets;
    for (const Pair& pair : pairs) {
      if (std::find(usedSources.begin(), usedSources.end(), pair.source) != usedSources.end()) continue;
      if (std::find(usedTargets.begin(), usedTargets.end(), pair.target) != usedTargets.end()) continue;
      usedSources.push_back(pair.source);
      usedTargets.push_back(pair.target);
      twins.sourceOf[pair.target] = pair.source;
      ++paired;
    }
    return paired == targets.size();
  }

  // Of what hangs there, from its parent.
  static Vec3 limbMiddle(const JointTree& tree, const std::vector<Vec3>& positions, Index joint,
                         std::optional<Index> parent) {
    const std::span<const Index> joints = tree.subtree(joint);
    const std::size_t step = joints.size() / 16 + 1;
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < joints.size(); i += step, ++count) sum += positions[joints[i]];
    return sum / count - (parent ? positions[*parent] : Vec3(Vec3::Zero()));
  }

  // Of joints, about their middles, in mean distances from it.
  double distance(const Twins& twins) const {
    Vec3 own = Vec3::Zero(), other = Vec3::Zero();
    const auto count = static_cast<double>(to_.size());
    for (Index j = 0; j < to_.size(); ++j) {
      own += from_[twins.sourceOf[j]] / count;
      other += to_[j] / count;
    }
    double off = 0, size = 0;
    for (Index j = 0; j < to_.size(); ++j) {
      off += (scale_ * (twins.turn * (from_[twins.sourceOf[j]] - own)) - (to_[j] - other)).norm();
      size += (to_[j] - other).norm();
    }
    return size > 0 ? off / size : HUGE_VAL;
  }

  // That brings most joints nearest: limbs that rest otherwise, the half that is farthest off, have no say.
  Quat turnOf(const Twins& twins) const {
    std::vector<Vec3> from, to;
    for (Index j = 0; j < to_.size(); ++j) {
      if (!targetTree_.parent(j)) continue;
      const Index own = twins.sourceOf[j];
      if (!sourceTree_.parent(own)) continue;
      from.push_back(scale_ * (from_[own] - from_[*sourceTree_.parent(own)]));
      to.push_back(to_[j] - to_[*targetTree_.parent(j)]);
    }
    Quat turn = twins.turn;
    for (int round = 0; round < 8 && from.size() >= 4; ++round) {
      std::vector<double> off;
      for (std::size_t i = 0; i < from.size(); ++i)
        off.push_back((turn * from[i] - to[i]).norm() / std::max(to[i].norm(), short_));
      std::vector<double> sorted = off;
      const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
      std::nth_element(sorted.begin(), middle, sorted.end());
      std::vector<Vec3> nearFrom, nearTo;
      for (std::size_t i = 0; i < from.size(); ++i) {
        if (off[i] > *middle * (1 + 1e-9)) continue;
        nearFrom.push_back(from[i]);
        nearTo.push_back(to[i]);
      }
      turn = rotationBetween(nearFrom, nearTo);
    }
    return turn;
  }

  // Bones that are parallel and equally long, turned so: where most limbs rest otherwise, a fitted turn meets none.
  std::size_t bonesAlike(const Twins& twins, const Quat& turn) const {
    std::size_t alike = 0;
    for (Index j = 0; j < to_.size(); ++j) {
      const Index own = twins.sourceOf[j];
      if (!targetTree_.parent(j) || !sourceTree_.parent(own)) continue;
      const Vec3 bone = to_[j] - to_[*targetTree_.parent(j)];
      const Vec3 other = scale_ * (turn * (from_[own] - from_[*sourceTree_.parent(own)]));
      alike += (bone - other).norm() < kTwinTolerances.alike * std::max(bone.norm(), short_);
    }
    return alike;
  }

  double namesInCommon(const Twins& twins) const {
    double common = 0;
    for (Index j = 0; j < target_.jointCount(); ++j) {
      const Joint &one = target_.joints[j], &other = source_.joints[twins.sourceOf[j]];
      const bool declared = !one.declaredBone.empty() && !other.declaredBone.empty();
      common += readNameOf(one) == readNameOf(other) || (!declared && one.name == other.name);
    }
    return common;
  }

  const Skeleton &source_, &target_;
  JointTree sourceTree_, targetTree_;
  std::vector<Vec3> from_, to_;  // #J, in rest pose
  std::vector<Index> sourceShapes_, targetShapes_;
  double scale_ = 1, short_ = 0;
};

}  // namespace

std::optional<Twins> matchTwins(const Skeleton& source, const Skeleton& target) {
  return TwinMatcher(source, target).match();
}

Pose turnedAlone(const Skeleton& skeleton, Pose pose) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) pose.locals[j].translation = skeleton.joints[j].rest.translation;
  return pose;
}

Pose poseAsTwin(const Skeleton& source, const Pose& sourcePose, const Skeleton& target, const Twins& twins) {
  const JointTree tree(target);
  const std::vector<Vec3> from = posePositions(source, turnedAlone(source, sourcePose)), to = restPositions(target);
  std::vector<Quat> turns(target.jointCount());        // of each joint with what hangs on it, in the target's space
  std::vector<bool> lies(target.jointCount(), false);  // all below is where it has to be
  std::vector<Vec3> wanted, is;
  for (const Index joint : tree.order()) {
    const std::optional<Index>& parent = tree.parent(joint);
    turns[joint] = parent ? turns[*parent] : Quat(Quat::Identity());
    lies[joint] = parent && lies[*parent];
    if (lies[joint]) continue;
    const auto collect = [&](std::span<const Index> joints) {
      wanted.clear();
      is.clear();
      for (const Index j : joints) {
        if (j == joint) continue;
        wanted.push_back(twins.scale * (twins.turn * (from[twins.sourceOf[j]] - from[twins.sourceOf[joint]])));
        is.push_back(to[j] - to[joint]);
      }
    };
    const auto fits = [&](const Quat& turn) {
      double off = 0, reach = 0;
      for (std::size_t i = 0; i < is.size(); ++i) {
        off = std::max(off, (turn * is[i] - wanted[i]).norm());
        reach = std::max(reach, wanted[i].norm());
      }
      return off <= kTwinTolerances.rigid * reach;
    };
    collect(tree.subtree(joint));
    lies[joint] = fits(turns[joint]);
    if (lies[joint]) continue;
    // Starts from its parent's rotation, so that what no position determines stays as it is.
    const auto turnedOn = [&] {
      std::vector<Vec3> carried;
      for (const Vec3& position : is) carried.push_back(turns[joint] * position);
      return (rotationBetween(carried, wanted) * turns[joint]).normalized();
    };
    const Quat whole = turnedOn();
    lies[joint] = fits(whole);
    if (lies[joint]) {
      turns[joint] = whole;
      continue;
    }
    collect(tree.children(joint));
    if (fits(turns[joint])) continue;
    turns[joint] = turnedOn();
  }
  Pose pose = restPose(target);
  const std::vector<Affine> rest = restGlobals(target);
  std::vector<Quat> rotations(target.jointCount());
  for (const Index joint : tree.order()) {
    const std::optional<Index>& parent = tree.parent(joint);
    rotations[joint] = (turns[joint] * decompose(rest[joint]).rotation).normalized();
    // What turns with its parent is as it was, to the bit.
    if (turns[joint].coeffs() == (parent ? turns[*parent] : Quat(Quat::Identity())).coeffs()) continue;
    pose.locals[joint].rotation =
        parent ? (rotations[*parent].conjugate() * rotations[joint]).normalized() : rotations[joint];
  }
  return pose;
}

}  // namespace limber
