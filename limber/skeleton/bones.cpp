// Where the bones of a skeleton run, of which a file says only where they start.
#include <algorithm>
#include <array>
#include <cmath>

#include "limber/skeleton/chain.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

namespace {

constexpr double kAlong = 0.99;       // cosine from which a child counts as lying along an axis
constexpr double kAgreement = 0.6;    // part of the joints with one child that make an axis the skeleton's
constexpr double kLongestFree = 2.5;  // medians: the longest bone whose end no joint marks

// The skeleton's joints in the space of its globals, and what they have in common.
class BoneDrawer {
 public:
  explicit BoneDrawer(const Skeleton& skeleton)
      : skeleton_(skeleton), globals_(restGlobals(skeleton)), children_(childrenOf(skeleton)) {
    findAxis();
    findMedianLength();
  }

  void draw(Index joint, std::vector<Bone>& bones) const {
    const std::vector<Index>& children = children_[joint];
    if (children.empty()) {
      bones.push_back({joint, position(joint), leafTail(joint), 0});
    } else if (children.size() == 1 || !axis_) {
      for (const Index child : children) addBoneTo(joint, position(child), bones);
    } else if (const std::optional<Index> child = childAlongAxis(joint)) {
      addBoneTo(joint, position(*child), bones);
    } else {
      addBoneTo(joint, position(joint) + freeLength(meanChildDistance(joint)) * axisOf(joint), bones);
    }
  }

 private:
  Vec3 position(Index joint) const { return globals_[joint].translation(); }
  double distance(Index a, Index b) const { return (position(a) - position(b)).norm(); }
  double freeLength(double length) const { return std::min(length, kLongestFree * medianLength_); }

  // x, y, z, -x, -y, -z as 0 to 5.
  static Vec3 localAxis(int axis) { return (axis < 3 ? 1.0 : -1.0) * Vec3::Unit(axis % 3); }
  Vec3 axisOf(Index joint) const { return (globals_[joint].linear() * localAxis(*axis_)).normalized(); }

  void addBoneTo(Index joint, const Vec3& end, std::vector<Bone>& bones) const {
    if (end != position(joint)) bones.push_back({joint, position(joint), end, 0});
  }

  // Joints that all stand alike, as those of a handle rig, do not point along their bones.
  bool allStandAlike() const {
    return std::all_of(globals_.begin(), globals_.end(),
                       [&](const Affine& global) { return global.linear().isApprox(globals_[0].linear(), 1e-6); });
  }

  void findAxis() {
    if (allStandAlike()) return;
    std::array<Index, 6> votes = {};
    Index voters = 0;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (children_[j].size() != 1) continue;
      const Vec3 arm = position(children_[j][0]) - position(j);
      if (!(arm.norm() > 0)) continue;
      ++voters;
      for (int axis = 0; axis < 6; ++axis) {
        const Vec3 direction = globals_[j].linear() * localAxis(axis);
        if (direction.dot(arm) > kAlong * direction.norm() * arm.norm()) ++votes[axis];
      }
    }
    const auto most = std::max_element(votes.begin(), votes.end());
    if (voters > 0 && *most >= kAgreement * voters) axis_ = static_cast<int>(most - votes.begin());
  }

  void findMedianLength() {
    std::vector<double> lengths;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (children_[j].size() != 1) continue;
      const double length = distance(j, children_[j][0]);
      if (length > 0) lengths.push_back(length);
    }
    if (lengths.empty()) return;
    std::sort(lengths.begin(), lengths.end());
    medianLength_ = lengths[lengths.size() / 2];
  }

  std::optional<Index> childAlongAxis(Index joint) const {
    std::optional<Index> best;
    double most = kAlong;
    for (const Index child : children_[joint]) {
      const double cosine = axisOf(joint).dot((position(child) - position(joint)).normalized());
      if (!(cosine > most)) continue;
      most = cosine;
      best = child;
    }
    return best;
  }

  double meanChildDistance(Index joint) const {
    double sum = 0;
    for (const Index child : children_[joint]) sum += distance(joint, child);
    return sum / static_cast<double>(children_[joint].size());
  }

  Vec3 leafTail(Index leaf) const {
    const std::optional<Index> parent = skeleton_.joints[leaf].parent;
    const double length = parent ? freeLength(distance(leaf, *parent)) : medianLength_;
    if (axis_) return position(leaf) + length * axisOf(leaf);
    if (!parent || !(length > 0)) return position(leaf);
    return position(leaf) + length * (position(leaf) - position(*parent)).normalized();
  }

  const Skeleton& skeleton_;
  std::vector<Affine> globals_;
  std::vector<std::vector<Index>> children_;
  std::optional<int> axis_;
  double medianLength_ = 0;
};

std::vector<Bone> spheres(const Skeleton& skeleton) {
  std::vector<Bone> bones;
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    bones.push_back({j, globals[j].translation(), globals[j].translation(), skeleton.joints[j].radius});
  }
  return bones;
}

std::vector<Bone> segments(const Skeleton& skeleton) {
  const BoneDrawer drawer(skeleton);
  std::vector<Bone> bones;
  for (Index j = 0; j < skeleton.jointCount(); ++j) drawer.draw(j, bones);
  return bones;
}

}  // namespace

std::vector<Bone> bonesOf(const Skeleton& skeleton, const std::vector<bool>& moves) {
  std::vector<Bone> bones = skeleton.boneShape == BoneShape::kSphere ? spheres(skeleton) : segments(skeleton);
  if (!moves.empty()) {
    bones.erase(std::remove_if(bones.begin(), bones.end(), [&](const Bone& bone) { return !moves[bone.joint]; }),
                bones.end());
  }
  std::vector<bool> hasBone(skeleton.jointCount(), false);
  for (const Bone& bone : bones) hasBone[bone.joint] = true;
  for (Bone& bone : bones) {
    bone.parent = skeleton.joints[bone.joint].parent;
    while (bone.parent && !hasBone[*bone.parent]) bone.parent = skeleton.joints[*bone.parent].parent;
  }
  return bones;
}

}  // namespace limber
