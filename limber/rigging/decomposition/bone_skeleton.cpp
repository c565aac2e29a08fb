#include "limber/rigging/decomposition/bone_skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "limber/core/disjoint_sets.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

// Against mean squared differences of rotations, which are pure numbers: below about two degrees the pull decides.
constexpr double kPull = 1e-3;
constexpr std::size_t kGapPoints = 256;  // of a bone, among which the nearest are looked for
constexpr double kOneShared = 0.25;      // what a vertex bound evenly to two bones adds to `shared`

// The points that a bone moves most, and their weighted middle.
struct BoneRegion {
  std::vector<Vec3> points;  // at most kGapPoints, evenly chosen
  Vec3 middle = Vec3::Zero();
  double weight = 0;
};

struct BonePair {
  Index a = 0, b = 0;
  double shared = 0;  // sum of products of weights
  Vec3 sharedAt = Vec3::Zero();
  Vec3 joint = Vec3::Zero();
  double cost = 0;
};

std::vector<BoneRegion> regionsOf(std::span<const Vec3f> rest, const SkinWeights& weights, Index bones) {
  std::vector<BoneRegion> regions(bones);
  std::vector<std::vector<Index>> strongest(bones);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    strongest[weights.jointsOf(v)[0]].push_back(v);
    for (Index i = 0; i < weights.slots; ++i) {
      const double w = weights.weightsOf(v)[i];
      regions[weights.jointsOf(v)[i]].weight += w;
      regions[weights.jointsOf(v)[i]].middle += w * rest[v].cast<double>();
    }
  }
  for (Index b = 0; b < bones; ++b) {
    regions[b].middle /= regions[b].weight;
    const std::size_t step = (strongest[b].size() + kGapPoints - 1) / kGapPoints;
    for (std::size_t i = 0; i < strongest[b].size(); i += step) {
      regions[b].points.push_back(rest[strongest[b][i]].cast<double>());
    }
    if (regions[b].points.empty()) regions[b].points.push_back(regions[b].middle);
  }
  return regions;
}

std::size_t pairIndex(Index a, Index b) {  // a < b
  return std::size_t{b} * (b - 1) / 2 + a;
}

std::vector<BonePair> pairsOf(std::span<const Vec3f> rest, const SkinWeights& weights, Index bones) {
  std::vector<BonePair> pairs;
  for (Index b = 1; b < bones; ++b) {
    for (Index a = 0; a < b; ++a) pairs.push_back({a, b});
  }
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    for (Index i = 0; i < weights.slots; ++i) {
      for (Index j = 0; j < weights.slots; ++j) {
        const Index a = weights.jointsOf(v)[i], b = weights.jointsOf(v)[j];
        const double both = double{weights.weightsOf(v)[i]} * weights.weightsOf(v)[j];
        if (a >= b || both <= 0) continue;
        BonePair& pair = pairs[pairIndex(a, b)];
        pair.shared += both;
        pair.sharedAt += both * rest[v].cast<double>();
      }
    }
  }
  return pairs;
}

struct Gap {
  double distance = std::numeric_limits<double>::infinity();
  Vec3 middle = Vec3::Zero();
};

Gap gapBetween(const BoneRegion& a, const BoneRegion& b) {
  Gap gap;
  for (const Vec3& p : a.points) {
    for (const Vec3& q : b.points) {
      const double distance = (p - q).squaredNorm();
      if (distance >= gap.distance) continue;
      gap.distance = distance;
      gap.middle = 0.5 * (p + q);
    }
  }
  gap.distance = std::sqrt(gap.distance);
  return gap;
}

// The point nearest to staying common to two motions, near `anchor`; and the root mean square of how far apart its
// images are.
double fitJoint(const BoneMotions& motions, const Vec3& anchor, const Box& box, BonePair& pair) {
  Mat3 turns = Mat3::Zero();
  Vec3 shifts = Vec3::Zero();
  const RigidMotion *a = motions.of(pair.a), *b = motions.of(pair.b);
  for (Index f = 0; f < motions.frameCount; ++f) {
    const RigidMotion difference = a[f] - b[f];
    const Mat3 turn = difference.leftCols<3>();
    turns += turn.transpose() * turn;
    shifts += turn.transpose() * (difference.leftCols<3>() * anchor + difference.col(3));
  }
  // About the anchor, so that the pull needs no units.
  turns += kPull * motions.frameCount * Mat3::Identity();
  pair.joint = anchor - turns.inverse() * shifts;
  const bool isInside = (pair.joint.array() >= box.min.array()).all() && (pair.joint.array() <= box.max.array()).all();
  if (!isInside) pair.joint = anchor;
  double sum = 0;
  for (Index f = 0; f < motions.frameCount; ++f) sum += ((a[f] - b[f]) * pair.joint.homogeneous()).squaredNorm();
  return std::sqrt(sum / motions.frameCount);
}

// Joints and costs of all pairs.
void fitJoints(std::span<const Vec3f> rest, const BoneMotions& motions, const std::vector<BoneRegion>& regions,
               std::vector<BonePair>& pairs) {
  Box box;
  for (const Vec3f& p : rest) box.add(p.cast<double>());
  std::vector<double> maxShared(motions.boneCount(), 0);
  for (const BonePair& pair : pairs) {
    maxShared[pair.a] = std::max(maxShared[pair.a], pair.shared);
    maxShared[pair.b] = std::max(maxShared[pair.b], pair.shared);
  }
  parallelFor(pairs.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      BonePair& pair = pairs[i];
      const Gap gap = gapBetween(regions[pair.a], regions[pair.b]);
      const Vec3 anchor = (pair.sharedAt + kOneShared * gap.middle) / (pair.shared + kOneShared);
      const double apart = fitJoint(motions, anchor, box, pair);
      const double most = std::min(maxShared[pair.a], maxShared[pair.b]);
      const double affinity = most > 0 ? std::min(1.0, pair.shared / most) : 0;
      pair.cost = (apart + gap.distance) * (2 - affinity);
    }
  });
}

// For each bone its neighbours in the spanning tree of least cost (Kruskal).
std::vector<std::vector<Index>> spanningTree(const std::vector<BonePair>& pairs, Index bones) {
  std::vector<Index> order(pairs.size());
  for (Index i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](Index x, Index y) { return pairs[x].cost < pairs[y].cost; });
  DisjointSets sets(bones);
  std::vector<std::vector<Index>> neighbours(bones);
  for (const Index i : order) {
    if (!sets.unite(pairs[i].a, pairs[i].b)) continue;
    neighbours[pairs[i].a].push_back(pairs[i].b);
    neighbours[pairs[i].b].push_back(pairs[i].a);
  }
  return neighbours;
}

Index rootOf(std::span<const Vec3f> rest, const std::vector<BoneRegion>& regions) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3f& p : rest) middle += p.cast<double>();
  middle /= static_cast<double>(rest.size());
  Index root = 0;
  for (Index b = 1; b < regions.size(); ++b) {
    if ((regions[b].middle - middle).norm() < (regions[root].middle - middle).norm()) root = b;
  }
  return root;
}

std::string boneName(Index joint, Index count) {
  return fmt::format("bone_{:0{}}", joint + 1, std::max<std::size_t>(2, fmt::to_string(count).size()));
}

// From the root outwards, parents first.
void addJoints(const std::vector<BonePair>& pairs, std::vector<std::vector<Index>> neighbours, Index root,
               const Vec3& rootPosition, BoneSkeleton& result) {
  const auto count = static_cast<Index>(neighbours.size());
  std::vector<std::optional<Index>> jointOf(count);
  std::vector<Vec3> positions;
  const auto add = [&](Index bone, std::optional<Index> parent, const Vec3& position) {
    Joint joint;
    jointOf[bone] = result.skeleton.jointCount();
    joint.name = boneName(*jointOf[bone], count);
    joint.parent = parent;
    joint.rest.translation = parent ? Vec3(position - positions[*parent]) : position;
    positions.push_back(position);
    result.boneOf.push_back(bone);
    result.skeleton.joints.push_back(std::move(joint));
  };
  add(root, std::nullopt, rootPosition);
  for (Index next = 0; next < result.boneOf.size(); ++next) {
    const Index bone = result.boneOf[next];
    std::sort(neighbours[bone].begin(), neighbours[bone].end());
    for (const Index other : neighbours[bone]) {
      if (jointOf[other]) continue;
      add(other, next, pairs[pairIndex(std::min(bone, other), std::max(bone, other))].joint);
    }
  }
}

template <typename Value>
Track<Value> emptyTrack(Index joint, Index count, double framesPerSecond) {
  Track<Value> track;
  track.joint = joint;
  for (Index f = 0; f < count; ++f) track.times.push_back(static_cast<float>(f / framesPerSecond));
  return track;
}

}  // namespace

BoneSkeleton skeletonOfBones(std::span<const Vec3f> rest, const Decomposition& decomposition) {
  const Index bones = decomposition.motions.boneCount();
  const std::vector<BoneRegion> regions = regionsOf(rest, decomposition.weights, bones);
  std::vector<BonePair> pairs = pairsOf(rest, decomposition.weights, bones);
  fitJoints(rest, decomposition.motions, regions, pairs);
  const Index root = rootOf(rest, regions);

  BoneSkeleton result;
  addJoints(pairs, spanningTree(pairs, bones), root, regions[root].middle, result);
  std::vector<Index> jointOf(bones);
  for (Index j = 0; j < bones; ++j) jointOf[result.boneOf[j]] = j;
  result.weights = decomposition.weights;
  for (std::size_t i = 0; i < result.weights.joints.size(); ++i) {
    Index& joint = result.weights.joints[i];
    joint = result.weights.weights[i] > 0 ? jointOf[joint] : 0;
  }
  return result;
}

Clip clipOfBones(const BoneSkeleton& bones, const BoneMotions& motions, const FrameSpan& span) {
  const Skeleton& skeleton = bones.skeleton;
  const std::vector<Affine> rest = restGlobals(skeleton);
  const auto globalOf = [&](Index joint, Index frame) {
    Affine global = Affine::Identity();
    global.matrix().topRows<3>() = motions.of(bones.boneOf[joint])[frame];
    return global * rest[joint];
  };
  Clip clip;
  clip.name = span.name;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Track<Vec3f> translation = emptyTrack<Vec3f>(j, span.count, span.framesPerSecond);
    Track<Eigen::Quaternionf> rotation = emptyTrack<Eigen::Quaternionf>(j, span.count, span.framesPerSecond);
    const std::optional<Index> parent = skeleton.joints[j].parent;
    for (Index f = span.first; f < span.first + span.count; ++f) {
      const Affine global = globalOf(j, f);
      const Affine local = parent ? globalOf(*parent, f).inverse(Eigen::Isometry) * global : global;
      translation.values.push_back(local.translation().cast<float>());
      Eigen::Quaternionf turned(Quat(local.linear()).normalized().cast<float>());
      if (!rotation.values.empty() && turned.dot(rotation.values.back()) < 0) turned.coeffs() = -turned.coeffs();
      rotation.values.push_back(turned);
    }
    clip.translations.push_back(std::move(translation));
    clip.rotations.push_back(std::move(rotation));
  }
  return clip;
}

}  // namespace limber
